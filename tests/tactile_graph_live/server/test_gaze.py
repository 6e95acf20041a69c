"""Which frame is looked at: the newest, one held still, one of the last minute, or the next."""

from __future__ import annotations

import asyncio
from collections.abc import Coroutine
from typing import Any

import pytest

pytest.importorskip("starlette", reason="the live extra is not installed")

import numpy as np

from tactile_graph import Frame
from tactile_graph_live.bench import wire
from tactile_graph_live.server import messages
from tactile_graph_live.server.gaze import Gaze
from tactile_graph_live.server.viewers import Picture, Viewer


def shown_frame(index: int, version: int = 1) -> messages.Frame:
    return messages.Frame(index, None, version, {"low": 0, "high": 1}, [], {}, {}, [], {}, [], None)


def kept(ticket: int, index: int, newer: bool = False) -> wire.Kept:
    frame = Frame.of(np.zeros((2, 2)), (1.0, 1.0), (0.0, 0.0), "volt", index=index)
    return wire.Kept(ticket, (frame,), 0.5, newer, None)


class Room:
    """Stands for viewers, bench and what runs frames again."""

    shown = frozenset({"circle"})
    lead = 30
    version = 1

    def __init__(self, holds: bool) -> None:
        self.told: list[wire.ToBench] = []
        self.seen: list[int] = []
        self._work: list[Coroutine[Any, Any, None]] = []
        self.gaze = Gaze(self.told.append, self, lambda: self, self._work.append, holds)  # type: ignore[arg-type]

    def show(self, picture: Picture) -> None:
        self.seen.append(picture.frame.index)

    def frame(self, kept: wire.Kept, shown: Any, pad: Any) -> messages.Frame:
        assert shown == self.shown
        return shown_frame(kept.frames[-1].index)

    def came(self, *indices: int) -> None:
        for index in indices:
            self.gaze.came(Picture(shown_frame(index)))

    def found(self, *found: wire.Kept) -> None:
        """Have the bench answer, and what follows from that done."""
        for one in found:
            self.gaze.found(one)

        async def done() -> None:
            for work in self._work:
                await work

        asyncio.run(done())
        self._work.clear()

    def fetched(self) -> wire.Fetch:
        (*_, last) = [t for t in self.told if isinstance(t, wire.Fetch)]
        return last


@pytest.fixture(params=[False, True], ids=["pad", "recording"])
def room(request: pytest.FixtureRequest) -> Room:
    return Room(request.param)


def test_the_newest_is_shown_until_it_is_held(room: Room) -> None:
    room.came(1, 2)
    room.gaze.pause()
    room.came(3)
    assert room.seen == [1, 2]
    room.gaze.live()
    assert room.seen == [1, 2, 3]


def test_a_frame_waits_until_its_graph_is_told_of(room: Room) -> None:
    """A page that drew it would draw nodes it does not know."""
    room.came(1)
    room.gaze.came(Picture(shown_frame(2, version=2)))
    room.gaze.live()
    assert room.seen == [1, 1]
    room.version = 2
    room.gaze.told()
    assert room.seen == [1, 1, 2]
    room.gaze.told()
    room.came(3)  # one of the old graph that was under way
    assert room.seen == [1, 1, 2, 3]


def test_the_next_frame_is_shown_once_its_graph_is_told_of(room: Room) -> None:
    room.gaze.step()
    room.gaze.came(Picture(shown_frame(1, version=2)))
    assert room.seen == []
    room.version = 2
    room.gaze.told()
    room.came(2)
    assert room.seen == [1]


def test_a_hold_ends_when_the_last_who_holds_has_left(room: Room) -> None:
    first, second, other = (Viewer(_Nowhere()) for _ in range(3))
    room.came(1)
    room.gaze.pause()
    for viewer in (first, second):
        room.gaze.held_by(viewer)
    assert not room.gaze.left(other)
    assert not room.gaze.left(first)
    room.came(2)
    assert room.gaze.paused
    assert room.gaze.left(second)
    assert not room.gaze.paused
    assert room.seen == [1, 2]
    assert room.gaze.held is False


def test_a_hold_that_another_ended_is_over_for_whoever_leaves(room: Room) -> None:
    first, second = Viewer(_Nowhere()), Viewer(_Nowhere())
    room.gaze.pause()
    room.gaze.held_by(first)
    room.gaze.live()
    room.gaze.pause()
    room.gaze.held_by(second)
    assert not room.gaze.left(first)
    assert room.gaze.paused


class _Nowhere:
    async def send_text(self, data: str) -> None:
        """Send nothing."""


def test_only_what_is_played_is_held_as_well() -> None:
    for holds, told in ((True, [wire.Hold(True), wire.Hold(False)]), (False, [])):
        room = Room(holds)
        room.gaze.pause()
        room.gaze.live()
        assert room.told == told


def test_a_frame_of_the_last_minute_is_asked_for_with_those_that_lead_to_it(room: Room) -> None:
    room.came(9)
    room.gaze.scrub(0.5)
    asked = room.fetched()
    assert (asked.after, asked.back_s, asked.lead) == (None, 0.5, 30)
    room.found(kept(asked.ticket, 4))
    assert room.seen == [9, 4]


def test_an_answer_to_an_older_question_is_not_shown(room: Room) -> None:
    room.came(9)
    room.gaze.scrub(0.5)
    older = room.fetched()
    room.gaze.scrub(0.2)
    room.found(kept(older.ticket, 4), kept(room.fetched().ticket, 7))
    assert room.seen == [9, 7]
    room.gaze.live()
    room.found(kept(room.fetched().ticket, 5))
    assert room.seen[-1] == 9


def test_what_changes_while_a_frame_is_run_again_is_not_overtaken(room: Room) -> None:
    room.came(9)
    room.gaze.scrub(0.5)
    room.gaze.found(kept(room.fetched().ticket, 4))
    room.gaze.live()
    room.found()
    assert room.seen == [9, 9]


def test_a_step_shows_the_frame_behind_the_one_that_is_held(room: Room) -> None:
    room.came(9)
    room.gaze.step()
    assert room.gaze.paused
    assert room.fetched().after == 9
    room.found(kept(room.fetched().ticket, 10))
    assert room.seen == [9, 10]


def test_a_step_at_the_end_has_what_is_played_give_one_more() -> None:
    room = Room(holds=True)
    room.came(9)
    room.gaze.step()
    room.found(kept(room.fetched().ticket, 9))
    assert room.told[-1] == wire.OneMore()
    room.came(10, 11)
    assert room.seen == [9, 10]


def test_a_pad_gives_no_frame_for_a_step_but_the_first_that_comes_is_shown() -> None:
    room = Room(holds=False)
    room.gaze.step()
    assert room.told == []
    room.came(1, 2)
    assert room.seen == [1]
    room.gaze.step()
    room.found(kept(room.fetched().ticket, 1))
    assert not any(isinstance(t, wire.OneMore) for t in room.told)


def test_a_change_runs_the_held_frame_again_and_no_other(room: Room) -> None:
    room.came(9)
    room.gaze.again()
    assert not any(isinstance(t, wire.Fetch) for t in room.told)
    room.gaze.pause()
    room.gaze.again()
    assert room.fetched().after == 8


def test_a_frame_that_is_not_kept_any_more_shows_nothing(room: Room) -> None:
    room.came(9)
    room.gaze.scrub(70.0)
    room.found(wire.Kept(room.fetched().ticket, (), 0.0, False, None))
    assert room.seen == [9]


def test_what_a_dead_bench_kept_is_not_asked_of_the_next(room: Room) -> None:
    """The next one numbers its frames anew, and would never have one behind the 900th."""
    room.came(900)
    room.gaze.pause()
    room.gaze.bench_died()
    assert room.gaze.held == (wire.Hold(True) in room.told)
    room.gaze.again()
    room.gaze.step()
    assert not any(isinstance(t, wire.Fetch) for t in room.told)
    room.came(0)
    assert room.seen == [900, 0]
    room.gaze.step()
    assert room.fetched().after == 0
