"""Plans give what the meaning says, run nothing that is not needed, and nothing twice."""

from __future__ import annotations

from collections import Counter
from pathlib import Path
from typing import Any

import pytest
from hypothesis import HealthCheck, given, settings

from helpers_graphs import CALLS, NAIVE, STEPS, cases, frame, registry, shown
from helpers_naive import Naive, Outcome
from tactile_graph import loads
from tactile_graph.engine.outcome import Failed, Skipped, gaps

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


def exactly_as_the_naive_evaluator(
    case: tuple[dict[str, Any], dict[str, Any]], folder: Path
) -> None:
    document, library = case
    files = {name: folder / f"{name}.yaml" for name in library}
    for name, path in files.items():
        path.write_text(shown(library[name]))
    pipeline = loads(shown(document), "random.yaml", registry(STEPS, files))
    naive = Naive(document, library, NAIVE)
    runner = pipeline.runner()
    asked = document["outputs"]
    for index, (number, time_s) in enumerate(FRAMES):
        one = frame(number, index, time_s)
        CALLS.clear()
        expected = naive.run(one, asked)
        result = runner(one)
        assert not result.reused
        got = {name: seen(result.outcome(name)) for name in asked}
        assert got == expected
        assert Counter(CALLS) == naive.ran


@pytest.mark.parametrize("n_cases", [120, pytest.param(400, marks=pytest.mark.slow)])
def test_plans_equal_a_naive_evaluator_and_run_only_what_is_needed(
    n_cases: int, folder: Path
) -> None:
    @settings(
        max_examples=n_cases,
        deadline=None,
        derandomize=True,
        suppress_health_check=[HealthCheck.too_slow, HealthCheck.data_too_large],
    )
    @given(case=cases())
    def equal(case: tuple[dict[str, Any], dict[str, Any]]) -> None:
        exactly_as_the_naive_evaluator(case, folder)

    equal()


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
    exactly_as_the_naive_evaluator((document, {}), folder)


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
