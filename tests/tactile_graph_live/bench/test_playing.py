"""Frames of any source as a running pad gives them."""

from __future__ import annotations

import threading
from collections.abc import Iterator
from itertools import islice

import numpy as np
import pytest

import tactile_graph as tg
from tactile_graph import Frame, Image
from tactile_graph_live.bench.playing import Pace, Player, is_device, keeps_pace


def frames(n: int, every_s: float | None = None) -> Iterator[Frame]:
    for i in range(n):
        yield Frame(Image(np.zeros((2, 2))), i, None if every_s is None else i * every_s)


def test_a_source_that_ends_starts_over_and_the_numbers_go_on() -> None:
    got = list(islice(Player(lambda r: frames(3), pace=None, once=False), 7))
    assert [f.index for f in got] == list(range(7))
    assert not any(f.gap for f in got)  # none was lost


def test_each_round_is_told_its_number_so_that_what_is_random_differs() -> None:
    rounds: list[int] = []
    list(islice(Player(lambda r: rounds.append(r) or frames(2), pace=None, once=False), 5))
    assert rounds == [0, 1, 2]


def test_once_ends_with_the_source() -> None:
    assert len(list(Player(lambda r: frames(3), pace=None, once=True, first=9))) == 3


def test_a_source_without_frames_does_not_start_over_for_ever() -> None:
    assert list(Player(lambda r: frames(0), pace=None, once=False)) == []


def test_frames_are_due_by_their_own_times() -> None:
    pace = Pace(None)
    first, second, third = frames(3, every_s=0.1)
    assert pace.wait_s(first, 100.0) == 0.0
    assert pace.wait_s(second, 100.02) == pytest.approx(0.08)
    assert pace.wait_s(third, 100.1) == pytest.approx(0.1)


def test_a_rate_goes_before_their_times() -> None:
    pace = Pace(50.0)
    first, second = frames(2, every_s=3.0)
    pace.wait_s(first, 0.0)
    assert pace.wait_s(second, 0.0) == pytest.approx(0.02)


def test_long_pauses_are_cut_and_a_clock_set_back_stops_nothing() -> None:
    pace = Pace(None)
    image = Image(np.zeros((1, 1)))
    pace.wait_s(Frame(image, 0, 10.0), 100.0)
    assert pace.wait_s(Frame(image, 1, 99.0), 100.0) == 0.5
    assert 0.0 < pace.wait_s(Frame(image, 2, 5.0), 100.5) < 0.1


def test_what_is_late_is_not_caught_up_with() -> None:
    pace = Pace(10.0)
    first, second, third = frames(3)
    pace.wait_s(first, 0.0)
    assert pace.wait_s(second, 5.0) == 0.0
    assert pace.wait_s(third, 5.0) == pytest.approx(0.1)


def test_held_frames_come_one_at_a_time_when_asked_for() -> None:
    player = Player(lambda r: frames(10), pace=Pace(1e6), once=True)
    player.hold(True)
    got: list[int] = []
    came = threading.Semaphore(0)

    def take() -> None:
        for frame in player:
            got.append(frame.index)
            came.release()

    thread = threading.Thread(target=take)
    thread.start()
    try:
        assert not came.acquire(timeout=0.05)
        player.one_more()
        assert came.acquire(timeout=5)
        assert not came.acquire(timeout=0.05)
        assert got == [0]
        player.hold(False)
        for _ in range(9):
            assert came.acquire(timeout=5)
    finally:
        player.end()
        thread.join(5)
    assert got == list(range(10))


def test_the_end_is_heard_while_held() -> None:
    player = Player(lambda r: frames(10), pace=Pace(None), once=True)
    player.hold(True)
    player.end()
    assert list(player) == []


@pytest.mark.slow
def test_a_device_and_a_source_with_a_speed_keep_their_own_pace() -> None:
    simulated = tg.load("circle-1").with_source("simulate")
    port = tg.load("circle-1").with_source("serial", port="/dev/null", preset="fsrray")
    assert not is_device(simulated)
    assert not keeps_pace(simulated)
    assert is_device(port)
    assert keeps_pace(port)
