"""Blocks of frames come to what the same frames come to one after the other."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated, Any

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings

from helpers_blocks import assert_blocks_are_frames
from helpers_graphs import STEPS, add1, cases, frame, picky, read, registry, shown
from tactile_graph import Image, loads
from tactile_graph.errors import RuleError
from tactile_graph.steps import Quantity
from tactile_graph.wires.frame_stack import FrameStack, in_stacks
from tactile_graph.wires.stacks import Answered, Column, ImageStack, Listed

NUMBERS = [0, 3, 4, 5, 1, 2, 2, 2, 7, 3, 0, 0, 6, 9, 12, 2, 4, 1, 8, 3]


def read_stacked(image: ImageStack, *, tag: str = "") -> Column:
    return Column(image.values[:, 0, 0].astype(np.int64))


def add1_stacked(a: Column, *, k: int = 1, tag: str = "") -> Column:
    return Column(a.values + k)


def picky_stacked(a: Column, *, bad: int = 2, tag: str = "") -> Answered:
    return Answered(Column(a.values.copy()), a.values % bad != 0)


@pytest.fixture(autouse=True)
def stacked_forms(monkeypatch: pytest.MonkeyPatch) -> None:
    for step, form in ((read, read_stacked), (add1, add1_stacked), (picky, picky_stacked)):
        monkeypatch.setattr(step, "stacked", form, raising=False)


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return tmp_path_factory.mktemp("library")


def exactly_as_frame_by_frame(case: tuple[dict[str, Any], dict[str, Any]], folder: Path) -> None:
    document, library = case
    files = {name: folder / f"{name}.yaml" for name in library}
    for name, path in files.items():
        path.write_text(shown(library[name]))
    pipeline = loads(shown(document), "random.yaml", registry(STEPS, files))
    frames = [frame(number, i, 0.5 * i) for i, number in enumerate(NUMBERS)]
    assert_blocks_are_frames(pipeline, frames, size=13)


@pytest.mark.slow
def test_random_graphs_come_to_the_same_in_blocks(folder: Path) -> None:
    check = given(cases())(exactly_as_frame_by_frame_in(folder))
    settings(
        max_examples=400,
        suppress_health_check=[HealthCheck.function_scoped_fixture, HealthCheck.too_slow],
    )(check)()


def exactly_as_frame_by_frame_in(folder: Path) -> Any:
    def run(case: tuple[dict[str, Any], dict[str, Any]]) -> None:
        exactly_as_frame_by_frame(case, folder)

    return run


LADDER = """
pipeline: ladder
nodes:
  number: {step: read, in: frame}
  more: {step: add1, in: number, when: number > 2}
  good: {step: picky, in: more, with: {bad: 2}}
  either: {first_of: [good, number]}
outputs: [either, good]
"""


def ladder(text: str = LADDER) -> Any:
    return loads(text, "ladder.yaml", registry())


def test_a_guard_parts_a_block_and_a_declined_frame_goes_on_alone() -> None:
    frames = [frame(n, i) for i, n in enumerate(NUMBERS)]
    results = assert_blocks_are_frames(ladder(), frames)
    assert {type(r.outcome("good")).__name__ for r in results} == {"int", "Skipped", "Failed"}
    block = ladder().runner().block(FrameStack.of(frames))
    assert [len(group.rows) > 3 for group in block.groups] == [True] * len(block.groups)
    assert len(block.groups) == 2
    assert 0 < len(block.alone) < len(frames) // 2


def levels() -> list[int]:
    return [1, 2, 3]


OF_ITEMS = """
pipeline: of_items
nodes:
  number: {step: read, in: frame}
  known: {step: levels}
  few: {step: many, in: number, when: number > 5}
  some: {first_of: [few, known]}
  a: {step: add1, in: number, when: all(known >= 1)}
  b: {step: add1, in: number, when: all(some < 9)}
  c: {step: add1, in: number, when: count(known >= 2) > 1 and number > 2}
outputs: [a, b, c]
"""


def test_a_guard_over_a_list_that_is_the_same_in_all_frames_is_told_in_blocks() -> None:
    pipeline = loads(OF_ITEMS, "p.yaml", registry({**STEPS, "levels": levels}))
    results = assert_blocks_are_frames(pipeline, [frame(n, i) for i, n in enumerate(NUMBERS)])
    assert [r["a"] for r in results] == [n + 1 for n in NUMBERS]


def test_a_step_that_keeps_a_state_sees_the_frames_in_their_order() -> None:
    text = LADDER.replace(
        "outputs: [either, good]",
        "  n: {step: count, in: either, when: number != 4}\noutputs: [n]",
    )
    frames = [frame(n, i, 0.25 * i) for i, n in enumerate(NUMBERS)]
    results = assert_blocks_are_frames(ladder(text), frames, size=7)
    assert results[-1]["n"] > 40


def test_a_frame_equal_to_the_last_one_reuses_its_result_across_blocks() -> None:
    frames = [frame(n, i) for i, n in enumerate([5, 5, 5, 5, 5, 5, 2, 2, 2, 3])]
    degenerate = ladder(LADDER.replace("bad: 2", "bad: 3"))
    results = assert_blocks_are_frames(degenerate, frames, size=4)
    assert [r.reused for r in results] == [0, 1, 1, 1, 1, 1, 0, 1, 1, 0]


def test_a_frame_equal_to_one_that_failed_by_an_error_is_tried_again() -> None:
    frames = [frame(n, i) for i, n in enumerate([5, 5, 5, 5, 5, 5, 2, 2, 2, 3])]
    results = assert_blocks_are_frames(ladder(), frames, size=4)
    assert [r.reused for r in results] == [0, 0, 0, 0, 0, 0, 0, 1, 1, 0]


def test_frames_of_several_shapes_grids_and_validities_make_blocks_of_their_own() -> None:
    holed = np.full((2, 2), 4.0)
    holed[1, 1] = np.nan
    frames = [
        *(frame(n, n) for n in range(6)),
        *(type(frame(0)).of(np.full((3, 2), 7.0 + n), index=6 + n) for n in range(5)),
        *(type(frame(0)).of(holed + n, index=11 + n) for n in range(5)),
    ]
    assert [len(s) for s in in_stacks(frames)] == [6, 5, 5]
    assert_blocks_are_frames(ladder(), frames, size=16)


def volts(image: Annotated[Image, Quantity("volt")]) -> int:
    return 1


def test_frames_that_break_a_rule_are_refused_as_each_is_alone() -> None:
    text = "pipeline: p\nnodes: {a: {step: volts, in: frame}}\noutputs: [a]"
    pipeline = loads(text, "p.yaml", registry({"volts": volts}))
    with pytest.raises(RuleError, match="volt"):
        pipeline.runner().block(FrameStack.of([frame(1), frame(2)]))


def test_a_form_that_raises_leaves_all_frames_to_the_step(monkeypatch: pytest.MonkeyPatch) -> None:
    def broken(a: Column, *, k: int = 1, tag: str = "") -> Column:
        raise ValueError("no")

    monkeypatch.setattr(add1, "stacked", broken)
    assert_blocks_are_frames(ladder(), [frame(n, i) for i, n in enumerate(NUMBERS)])


def test_a_form_that_gives_too_few_values_is_told(monkeypatch: pytest.MonkeyPatch) -> None:
    def short(image: ImageStack, *, tag: str = "") -> Listed:
        return Listed([1])

    monkeypatch.setattr(read, "stacked", short)
    block = ladder().runner().block(FrameStack.of([frame(n, n) for n in range(8)]))
    assert "must give a stack of 8 values, got 1 value" in block[0].outcome("number").reason


def test_times_of_a_group_are_shared_among_its_frames() -> None:
    block = ladder().runner().block(FrameStack.of([frame(n, n) for n in range(40)]))
    times = [r.times_us["number"] for r in block]
    assert 0.0 < times[0] < 1000.0
    assert times[0] == times[39] or len(block.groups) > 1
