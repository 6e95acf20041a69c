"""Merged variants give exactly what each of them alone gives, names and reasons included."""

from __future__ import annotations

import copy
from collections import Counter
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import HealthCheck, Phase, given, settings
from hypothesis import strategies as st

from helpers_graphs import CALLS, STEPS, cases, documents, frame, registry, shown
from tactile_graph import Pipeline, load, loads
from tactile_graph.engine.outcomes.outcome import Failed, Skipped
from tactile_graph.engine.tables.rows import as_data
from tactile_graph.plugins.registry import installed
from tactile_graph_compare.records.graph import STATES, state_of
from tactile_graph_compare.run.session import balanced_orders
from tactile_graph_compare.variants.merge import Merged, merge

FRAMES = [(0, 0.0), (3, 0.5), (4, 0.6), (4, 0.7), (5, 2.0), (1, 2.25), (2, 4.0)]


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return tmp_path_factory.mktemp("library")


def told(outcome: Any) -> tuple[Any, ...]:
    """Return all of an outcome that somebody could see."""
    if isinstance(outcome, Skipped):
        return ("skipped", outcome.origin, outcome.reason)
    if isinstance(outcome, Failed):
        return ("failed", outcome.origin, outcome.reason, outcome.inputs, outcome.step)
    return ("value", as_data(outcome))


@st.composite
def families(draw: Callable[..., Any]) -> tuple[list[dict[str, Any]], dict[str, Any]]:
    """Return a pipeline, changed copies of it, perhaps a stranger, and the library they use."""
    first, library = draw(cases())
    plain = draw(st.booleans())
    family = [first, *(draw(changed(first)) for _ in range(draw(st.integers(1, 2))))]
    if library and draw(st.booleans()):
        family.append(copy.deepcopy(library[draw(st.sampled_from(sorted(library)))]))
    if draw(st.integers(0, 3)) == 0:
        family.append(draw(documents("stranger", library=library, most=6)))
    if plain:  # without tags, equal nodes of one pipeline are equal too
        for document in [*family, *library.values()]:
            for body in document["nodes"].values():
                body.get("with", {}).pop("tag", None)
    return family, library


@st.composite
def changed(draw: Callable[..., Any], document: dict[str, Any]) -> dict[str, Any]:
    copied = copy.deepcopy(document)
    for body in copied["nodes"].values():
        what = draw(st.integers(0, 7))
        if what == 0:
            body.pop("when", None)
        elif what == 1:
            body["when"] = draw(st.sampled_from(["frame.index > 1", "frame.index % 2 == 0"]))
        elif what == 2 and body.get("step") in ("add1", "picky"):
            key = "k" if body["step"] == "add1" else "bad"
            body.setdefault("with", {})[key] = draw(st.integers(1, 4))
    for name in copied["conditions"]:
        if draw(st.integers(0, 2)) == 0:
            copied["conditions"][name] = "frame.index > 2"
    names = [n for n, b in copied["nodes"].items() if "use" not in b] or copied["outputs"]
    some = draw(st.lists(st.sampled_from(names), max_size=2))
    copied["outputs"] = list(dict.fromkeys([*copied["outputs"], *some]))
    return copied


@pytest.mark.slow
@settings(
    max_examples=80,
    deadline=None,
    derandomize=True,
    phases=[Phase.explicit, Phase.generate],  # shrinking two graphs at once takes minutes
    suppress_health_check=[HealthCheck.too_slow, HealthCheck.data_too_large],
)
@given(family=families())
def test_random_variants_come_to_what_each_alone_would(
    family: tuple[list[dict[str, Any]], dict[str, Any]], folder: Path
) -> None:
    texts, library = family
    files = {name: folder / f"{name}.yaml" for name in library}
    for name, path in files.items():
        path.write_text(shown(library[name]))
    found = registry(STEPS, files)
    pipelines = [loads(shown(text), f"v{i}.yaml", found) for i, text in enumerate(texts)]
    check(pipelines, [frame(n, i, t) for i, (n, t) in enumerate(FRAMES)])


def check(pipelines: list[Pipeline], frames: list[Any], seed: int = 0) -> Merged:
    """Hold the merged outcomes, and what was needed, against each pipeline run alone."""
    merged = merge(pipelines, [list(p.outputs) for p in pipelines])
    turns = [merged.pipeline.runner(seed=seed)]
    if not turns[0].stateful:
        turns += [
            merged.in_order(turn).runner(seed=seed) for turn in balanced_orders(len(pipelines), 8)
        ]
    alone = [p.runner(seed=seed) for p in pipelines]
    called: tuple[Counter[str], Counter[str]] = (Counter(), Counter())
    for i, one in enumerate(frames):
        CALLS.clear()
        result = turns[i % len(turns)](one)
        called[0].update(CALLS)
        CALLS.clear()
        for member, pipeline, runner in zip(merged.members, pipelines, alone, strict=True):
            own, expected = member.alone(result), runner(one)
            for name in pipeline.outputs:
                assert told(own.outcome(name)) == told(expected.outcome(name)), name
            assert own.row() == expected.row()
            for item in expected.plan.nodes:
                if item.constant:  # kept from whatever frame first needed it
                    continue
                outcome = told(expected.outcome(item.name))
                assert told(own.outcome(item.name)) == outcome, item.name
            failures = [[told(f) for f in r.failures] for r in (own, expected)]
            assert sorted(failures[0]) == sorted(failures[1])
        called[1].update(CALLS)
        # No step runs that none of them alone has needed so far, and none is left out.
        assert set(called[0]) == set(called[1])
    return merged


def of(*texts: str) -> list[Pipeline]:
    found = registry(STEPS)
    return [loads(text, f"v{i}.yaml", found) for i, text in enumerate(texts)]


NUMBERS = [frame(n, i, t) for i, (n, t) in enumerate(FRAMES)]
COUNT = "  count: {step: count, in: number}\n"
HEAD = "pipeline: p\nnodes:\n  number: {step: read, in: frame}\n"


def test_a_state_is_shared_by_those_who_see_every_frame() -> None:
    merged = check(of(HEAD + COUNT + "outputs: [count]", HEAD + COUNT + "outputs: [count, number]"),
                   NUMBERS)  # fmt: skip
    assert list(merged.pipeline.nodes) == ["number", "count"]


def test_a_state_is_not_shared_with_one_that_a_guard_further_on_keeps_from_frames() -> None:
    """The counting nodes are equal, guard and all; what asks for them is not."""
    guarded = HEAD + COUNT + "  last: {step: add1, in: count, when: frame.index > 2}\n"
    merged = check(of(HEAD + COUNT + "outputs: [count]", guarded + "outputs: [last]"), NUMBERS)
    assert list(merged.pipeline.nodes) == ["number", "count", "count@2", "last"]


def test_a_state_behind_a_guard_of_its_own_is_not_shared_with_one_without() -> None:
    own = HEAD + "  count: {step: count, in: number, when: number > 1}\noutputs: [count]"
    assert len(check(of(HEAD + COUNT + "outputs: [count]", own), NUMBERS).pipeline.nodes) == 3


def test_conditions_of_one_name_but_another_meaning_keep_nodes_apart() -> None:
    text = (
        "  one: {step: add1, in: number, when: big}\nconditions: {big: number > %d}\noutputs: [one]"
    )
    first, second = of(HEAD + text % 3, HEAD + text % 4)
    merged = check([first, second], NUMBERS)
    assert list(merged.pipeline.nodes) == ["number", "one", "one@2"]
    assert first.nodes["one"].key != second.nodes["one"].key
    assert first.key != second.key


def test_a_process_or_time_limit_of_its_own_keeps_a_node_apart() -> None:
    text = HEAD + "  one: {step: add1, in: number%s}\noutputs: [one]"
    kinds = ("", ", isolated: true", ", time_limit_s: 1", ", time_limit_s: 2", ", time_limit_s: 1")
    pipelines = of(*(text % kind for kind in kinds))
    merged = merge(pipelines, [["one"]] * len(pipelines))
    assert list(merged.pipeline.nodes) == ["number", "one", "one@2", "one@3", "one@4"]


def test_one_guard_in_two_wordings_is_one_and_each_variant_is_told_its_own() -> None:
    named = (
        "  one: {step: add1, in: number, when: big}\nconditions: {big: number > 3}\noutputs: [one]"
    )
    spelled = "  uno: {step: add1, in: number, when: number > 3}\noutputs: [uno]"
    merged = check(of(HEAD + named, HEAD + spelled), NUMBERS)
    assert len(merged.pipeline.nodes) == 2
    result = merged.pipeline.run(frame(1))
    first, second = (member.alone(result) for member in merged.members)
    assert first.outcome("one").reason == "when big is false (number = 1)"
    assert (second.outcome("uno").origin, second.outcome("uno").reason) == (
        "uno", "when number > 3 is false (number = 1)")  # fmt: skip


def test_nodes_of_an_embedded_pipeline_are_those_of_the_pipeline_itself(folder: Path) -> None:
    inner = HEAD.replace(": p", ": inner") + "  one: {step: add1, in: number}\noutputs: [one]"
    (folder / "inner.yaml").write_text(inner)
    found = registry(STEPS, {"inner": folder / "inner.yaml"})
    outer = "pipeline: o\nnodes:\n  use_it: {use: inner}\n  two: {step: add1, in: use_it}\n"
    outer += "outputs: [two]"
    merged = check([loads(inner, "i.yaml", found), loads(outer, "o.yaml", found)], NUMBERS)
    assert list(merged.pipeline.nodes) == ["number", "one", "use_it", "two"]


def test_of_two_equal_choices_the_last_is_told_as_the_one_that_was_skipped() -> None:
    same = "{step: add1, in: number, when: number > 9}"
    text = HEAD + f"  a: {same}\n  b: {same}\n  f: {{first_of: [a, b]}}\noutputs: [f, a]"
    merged = check(of(text), NUMBERS)
    assert list(merged.pipeline.nodes) == ["number", "a", "f"]
    assert merged.members[0].alone(merged.pipeline.run(frame(1))).outcome("f").origin == "b"


def test_what_stands_behind_a_skipped_optional_port_was_needed_all_the_same() -> None:
    text = HEAD + (
        "  a: {step: add1, in: number, when: number > 9}\n"
        "  b: {step: add1, in: number, with: {k: 5}}\n"
        "  o: {step: options, in: {a: a, b: b}, when: number > 0}\noutputs: [o]"
    )
    merged = check(of(text), NUMBERS)
    own = merged.members[0].alone(merged.pipeline.run(frame(1)))
    states = {name: STATES[state_of(outcome)] for name, outcome in own.outcomes.items()}
    assert states == {"number": "ran", "a": "skipped", "b": "ran", "o": "ran"}


def noisy(a: int, *, rng: np.random.Generator) -> int:
    return a + int(rng.integers(1000))


class Wander:
    def __init__(self, *, rng: np.random.Generator) -> None:
        self.rng = rng

    def __call__(self, a: int) -> int:
        return a + int(self.rng.integers(1000))


@pytest.mark.parametrize("step", ["noisy", "wander"])
def test_a_step_that_draws_is_shared_only_by_those_who_draw_the_same(
    step: str, folder: Path
) -> None:
    """Inside an embedded pipeline a node is seeded otherwise than on its own."""
    inner = HEAD.replace(": p", ": dice") + f"  one: {{step: {step}, in: number}}\noutputs: [one]"
    (folder / "dice.yaml").write_text(inner)
    found = registry({**STEPS, "noisy": noisy, "wander": Wander}, {"dice": folder / "dice.yaml"})
    outer = "pipeline: o\nnodes: {in_it: {use: dice}}\noutputs: [in_it]"
    again = inner.replace(": dice", ": again").replace("[one]", "[one, number]")
    pipelines = [loads(text, "d.yaml", found) for text in (inner, outer, again)]
    merged = check(pipelines, NUMBERS, seed=3)
    assert list(merged.pipeline.nodes) == ["number", "one", "in_it/one", "in_it"]
    assert merged.members[2].names["one"] == "one"


@pytest.mark.slow
@pytest.mark.usefixtures("compiled_kernels")  # twins compiled half way differ in the last digit
def test_every_shipped_pipeline_comes_to_the_same_in_one_graph_of_all() -> None:
    """What two pipelines share does not depend on the others, so this is every pair of them.

    Among them are steps that draw at random, one that keeps state, lists and embedded pipelines.
    """
    pipelines = [load(name).with_source("simulate") for name in installed().names("pipelines")]
    scenes = [load("circle-3").with_source("simulate", scene=s) for s in ("empty", "discs")]
    frames = [next(p.frames(seed=3)).with_index(i) for i, p in enumerate(scenes)]
    merged = check(pipelines, frames, seed=5)
    nodes = merged.pipeline.nodes.values()
    assert any(n.stateful for n in nodes)
    assert any(n.signature is not None and n.signature.rng for n in nodes)
    owners = Counter(m for member in merged.members for m in set(member.names.values()))
    assert max(n for m, n in owners.items() if m.startswith("footprint")) > 5
