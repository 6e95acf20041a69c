"""Plans give what the meaning says, run nothing that is not needed, and nothing twice."""

from __future__ import annotations

import random
from collections import Counter
from pathlib import Path
from typing import Any

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from helpers_graphs import CALLS, NAIVE, STEPS, cases, frame, registry, shown
from helpers_naive import Naive, Outcome
from tactile_graph import Frame, Pipeline, loads
from tactile_graph.engine.deadlines.options import Option, Options
from tactile_graph.engine.outcomes.outcome import Failed, Skipped, gaps
from tactile_graph.live import Recorded

UNHEALTHY = [HealthCheck.too_slow, HealthCheck.data_too_large]
Case = tuple[dict[str, Any], dict[str, Any]]
"""A pipeline and the library it may use."""
FRAMES = [(0, 0.0), (3, 0.5), (4, 0.6), (5, 2.0), (1, 2.25), (2, 4.0)]


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return tmp_path_factory.mktemp("library")


def seen(outcome: Any) -> Outcome:
    if isinstance(outcome, Skipped):
        return Outcome("skipped", origin=outcome.origin)
    if isinstance(outcome, Failed):
        return Outcome("failed", origin=outcome.origin)
    if isinstance(outcome, tuple) and gaps(outcome):
        items = [seen(item) for item in outcome]
        return Outcome("value", tuple(i.value if i.has_value else i for i in items))
    return Outcome("value", outcome)


class Whim:
    """Decides at random, with a seed."""

    def __init__(self, seed: int) -> None:
        self.rng = random.Random(seed)

    def prepare(self, options: Options) -> None: ...

    def begin(self, frame: Frame) -> None: ...

    def allows(self, option: Option, state: list[Any]) -> bool:
        return option.spared or self.rng.random() < 0.6

    def ended(self, option: Option, state: list[Any]) -> None: ...

    def end(self) -> None: ...


def loaded(case: Case, folder: Path) -> Pipeline:
    document, library = case
    files = {name: folder / f"{name}.yaml" for name in library}
    for name, path in files.items():
        path.write_text(shown(library[name]))
    return loads(shown(document), "random.yaml", registry(STEPS, files))


def exactly_as_the_naive_evaluator(case: Case, pipeline: Pipeline) -> None:
    """Look at a plan, and at one that could leave something undone where nothing is."""
    document, library = case
    naive = Naive(document, library, NAIVE)
    runners = [pipeline.runner(), pipeline.runner(decider=Recorded())]
    asked = document["outputs"]
    for index, (number, time_s) in enumerate(FRAMES):
        one = frame(number, index, time_s)
        CALLS.clear()
        expected = naive.run(one, asked)
        for runner in runners:
            CALLS.clear()
            result = runner(one)
            assert not result.reused
            got = {name: seen(result.outcome(name)) for name in asked}
            assert got == expected
            assert Counter(CALLS) == naive.ran


def what_was_decided_comes_to_the_same_again(pipeline: Pipeline, seed: int) -> int:
    """Decide at random, and once more as was decided; return how often."""
    n_decisions = 0
    recorded = Recorded()
    runner, again = pipeline.runner(decider=Whim(seed)), pipeline.runner(decider=recorded)
    for index, (number, time_s) in enumerate(FRAMES):
        one = frame(number, index, time_s)
        CALLS.clear()
        result, calls = runner(one), CALLS.copy()
        recorded.skipped = result.decisions
        n_decisions += len(result.decisions)
        CALLS.clear()
        assert repr(again(one).outcomes) == repr(result.outcomes)
        assert calls == CALLS
    return n_decisions


@pytest.mark.parametrize("n_cases", [60, pytest.param(400, marks=pytest.mark.slow)])
def test_plans_equal_a_naive_evaluator_run_only_what_is_needed_and_decide_the_same_again(
    n_cases: int, folder: Path
) -> None:
    """All of one test, as to draw a pipeline and to load it takes longer than to run it."""
    n_decisions = 0

    @settings(
        max_examples=n_cases,
        deadline=None,
        derandomize=True,
        suppress_health_check=UNHEALTHY,
    )
    @given(case=cases(), seed=st.integers(0, 2**32))
    def equal(case: Case, seed: int) -> None:
        nonlocal n_decisions
        pipeline = loaded(case, folder)
        exactly_as_the_naive_evaluator(case, pipeline)
        n_decisions += what_was_decided_comes_to_the_same_again(pipeline, seed)

    equal()
    assert n_decisions > 3 * n_cases


LISTS = {
    "number": {"step": "read", "in": "frame"},
    "sure": {"step": "add1", "in": "number"},
    "items": {"step": "many", "in": "sure"},
    "some": {"step": "picky", "in": "items", "each": True},
    "others": {"step": "shy", "in": "items", "each": True},
    "both": {"step": "add2", "in": ["some", "others"], "each": True},
    "sum_of_some": {"step": "total", "in": "some"},
    "sum_of_others": {"step": "total", "in": "others"},
    "sum_of_both": {"step": "total", "in": "both"},
}


def test_lists_of_which_items_fail_or_are_skipped_equal_a_naive_evaluator(folder: Path) -> None:
    nodes = {n: {**body, "with": {"tag": n}} for n, body in LISTS.items()}
    document = {"pipeline": "p", "conditions": {}, "nodes": nodes, "outputs": [*LISTS]}
    exactly_as_the_naive_evaluator((document, {}), loaded((document, {}), folder))


@pytest.mark.slow
def test_the_generator_covers_what_it_should(folder: Path) -> None:
    """Every kind of node, guard and outcome comes up in the graphs the property is tested on."""
    kinds: Counter[str] = Counter()

    @settings(
        max_examples=150,
        deadline=None,
        derandomize=True,
        database=None,
        suppress_health_check=list(HealthCheck),
    )
    @given(case=cases())
    def look(case: tuple[dict[str, Any], dict[str, Any]]) -> None:
        document, library = case
        naive = Naive(document, library, NAIVE)
        for index, (number, time_s) in enumerate(FRAMES[:3]):
            outcomes = naive.run(frame(number, index, time_s), document["outputs"])
            kinds.update(o.state for o in outcomes.values())
        kinds.update(b.get("step") or next(iter(b)) for b in document["nodes"].values())
        kinds.update(k for b in document["nodes"].values() for k in ("when", "each") if k in b)
        kinds["nested use"] += sum(
            "use" in b for d in library.values() for b in d["nodes"].values()
        )
        kinds["named condition"] += len(document["conditions"])

    look()
    wanted = {
        *STEPS,
        "first_of",
        "use",
        "when",
        "each",
        "value",
        "skipped",
        "failed",
        "nested use",
        "named condition",
    }
    assert {k for k in wanted if kinds[k] < 3} == set()
