"""What lies in memory that its step goes on writing into is copied; nothing else is."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np
import pytest

from helpers_graphs import frame, registry
from tactile_graph import Frame, Image, Mask, Points, Polygon, load, loads
from tactile_graph.engine.operations.freeze import freeze
from tactile_graph.engine.operations.memory import own_array
from tactile_graph.engine.written import AFTER_FRAMES
from tactile_graph.wires.image import packed_mask


@dataclass(frozen=True)
class Record:
    values: Any


def fresh() -> Any:
    whole = np.arange(12.0)
    return whole.reshape(3, 4)[1:]


@pytest.mark.parametrize(
    "made",
    [
        lambda: np.arange(4.0),
        fresh,
        lambda: np.frombuffer(bytes(16)),
        lambda: np.broadcast_to(np.float64(1.0), (2, 2)),
        lambda: np.lib.stride_tricks.sliding_window_view(np.arange(9.0), 3),
    ],
    ids=["its own", "fresh", "bytes", "broadcast", "windows"],
)
def test_what_nobody_else_holds_is_not_copied(made: Callable[[], Any]) -> None:
    array = made()
    assert own_array(array) is array


def test_what_cannot_be_written_into_is_not_copied() -> None:
    whole = np.arange(6.0)
    whole.setflags(write=False)
    view = whole[1:]
    assert own_array(view) is view


@pytest.mark.parametrize(
    "view",
    [
        lambda whole: whole[1:],
        lambda whole: whole[::-1].reshape(2, 3),
        lambda whole: np.lib.stride_tricks.as_strided(whole, (2,), (8,)),
        lambda whole: np.frombuffer(whole.data),
    ],
)
def test_a_view_of_what_somebody_holds_is_copied(view: Callable[[Any], Any]) -> None:
    whole = np.arange(6.0)
    own = own_array(view(whole))
    expected = own.copy()
    whole[:] = -1.0
    np.testing.assert_array_equal(own, expected)
    assert not own.flags.writeable


@pytest.mark.parametrize(
    ("wrap", "of"),
    [
        (lambda a: Image(a[:2]), lambda got: got.values),
        (lambda a: Image(np.ones((3, 2)), valid=a.view(np.bool_)[:3, :2]), lambda got: got.valid),
        (lambda a: Mask(a.view(np.bool_)[:2, ::8]), lambda got: got.values),
        (lambda a: packed_mask(a.view(np.uint64)[0], 2, (1, 1), (0, 0), 1), lambda got: got.words),
        (lambda a: Points(a[:2]), lambda got: got.xy_cm),
        (lambda a: Polygon(a[:2]), lambda got: got.xy_cm),
        (lambda a: a[:2], lambda got: got),
        (lambda a: (1, [a[:2]]), lambda got: got[1][0]),
        (lambda a: Record(a[:2]), lambda got: got.values),
        (lambda a: Record(Image(a[:2])), lambda got: got.values.values),
    ],
    ids=range(10),
)
def test_a_part_of_a_buffer_is_the_results_own_wherever_it_is(wrap: Any, of: Any) -> None:
    buffer = np.zeros((3, 2))
    got = of(freeze(wrap(buffer)))
    before = got.copy()
    buffer.view(np.uint8)[:] = 1
    np.testing.assert_array_equal(got, before)


class Rolling:
    """Gives a part of an array that it fills anew in each frame."""

    def __init__(self) -> None:
        self.rows = np.zeros((3, 4))

    def __call__(self, image: Image) -> Image:
        self.rows[:] = image.peak
        return image.with_values(self.rows[1:])


BUFFER = np.zeros((3, 4))


def rolled(image: Image) -> Image:
    """Give the same, as a function."""
    BUFFER[:] = image.peak
    return image.with_values(BUFFER[1:])


def each(step: Any, n: int) -> list[Any]:
    text = "pipeline: p\nnodes:\n  a: {step: s, in: frame}\noutputs: [a]\n"
    runner = loads(text, "p.yaml", registry({"s": step})).runner()
    return [runner(frame(i + 1)).outcome("a") for i in range(n)]


@pytest.mark.parametrize("step", [Rolling, rolled])
@pytest.mark.parametrize(
    "n",
    [
        pytest.param(3, id="called"),
        pytest.param(AFTER_FRAMES + 3, id="written", marks=pytest.mark.slow),
    ],
)
def test_a_step_that_fills_its_array_anew_changes_no_earlier_result(step: Any, n: int) -> None:
    assert [got.peak for got in each(step, n)] == [i + 1.0 for i in range(n)]


def same(image: Image) -> Image:
    return image


def test_what_a_step_hands_on_stays_the_very_same() -> None:
    whole = np.ones((3, 4))
    given = Frame(Image(whole[1:]), 0, 0.0)
    text = "pipeline: p\nnodes:\n  a: {step: s, in: frame}\noutputs: [a]\n"
    pipeline = loads(text, "p.yaml", registry({"s": same}))
    assert pipeline.runner()(given)["a"] is given.image


def test_the_projects_own_steps_are_known_and_no_others() -> None:
    nodes = load("circle-1").nodes.values()
    assert all(n.signature.is_own for n in nodes if n.signature is not None)
    assert not registry({"s": same}).step("s").is_own
