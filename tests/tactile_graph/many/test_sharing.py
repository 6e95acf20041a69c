"""Work shared among workers: what one process would have given, in order, errors in their place."""

from __future__ import annotations

from collections.abc import Callable, Iterator

import numpy as np
import pytest

from helpers_many import place
from tactile_graph import Frame
from tactile_graph.many import Portion, Sharing

N = 40


def frames(fails_at: int | None = None) -> Iterator[Frame]:
    for k in range(N):
        if k == fails_at:
            raise ValueError("the cable is out")
        yield Frame.of(np.zeros((2, 2)), index=k)


def numbers(error_at: int | None) -> Callable[[Portion], list[int]]:
    """Return what gives the numbers of a portion's frames; of one frame it makes an error."""

    def work(portion: Portion) -> list[int]:
        found = [f.index for f in portion.frames()[1]]
        if error_at in found:
            raise ArithmeticError(f"frame {error_at}")
        return found

    return work


def gather(came: list[int], error_at: int | None, given: Iterator[Frame]) -> None:
    """Enter the numbers of frames as they come back."""
    with Sharing(place(), numbers, error_at) as workers:
        for part in workers.over_frames(given):
            came += part


def before(n: int) -> Callable[[Portion], list[tuple[int, ...]]]:
    """Return what gives the numbers of the frames that came along ahead of a portion's own."""

    def work(portion: Portion) -> list[tuple[int, ...]]:
        ahead, own = portion.frames()
        assert own[0].index == portion.low
        return [tuple(f.index - portion.low for f in ahead)]

    return work


def tasks(_: None) -> Callable[[Portion], int | None]:
    """Return what does a task."""
    return lambda portion: None if portion.low in portion.without else portion.low**2


def test_frames_come_back_in_order_and_whole() -> None:
    with Sharing(place(chance=[3, 17]), numbers, None) as workers:
        assert [k for part in workers.over_frames(frames()) for k in part] == [*range(N)]
    assert workers.left_out == []


def test_frames_ahead_of_a_portion_come_along_if_there_are_any() -> None:
    with Sharing(place(), before, 2) as workers:
        came = [k for part in workers.over_frames(frames(), n_before=2) for k in part]
    assert came[0] == ()
    assert set(came[1:]) == {(-2, -1)}


def test_an_error_of_the_frames_is_raised_when_all_before_it_came() -> None:
    came: list[int] = []
    with pytest.raises(ValueError, match="the cable is out"):
        gather(came, None, frames(fails_at=37))
    assert came == [*range(37)]


def test_an_error_of_the_work_is_raised_in_its_turn() -> None:
    came: list[int] = []
    with pytest.raises(ArithmeticError, match="frame 33"):
        gather(came, 33, frames())
    assert came == [*range(32)]  # portions of 16 to begin with


def test_a_deadly_frame_is_left_out_and_told() -> None:
    with Sharing(place({21}), numbers, None) as workers:
        came = [k for part in workers.over_frames(frames()) for k in part]
    assert came == [k for k in range(N) if k != 21]
    assert workers.left_out == [21]


def test_tasks_are_done_in_order_and_a_deadly_one_comes_to_nothing() -> None:
    with Sharing(place({2}), tasks, None, ahead=5) as workers:
        assert [*workers.over_tasks(5)] == [0, 1, None, 9, 16]
    assert workers.left_out == [2]
