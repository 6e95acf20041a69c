"""Portions done by workers: in order, no more at a time than there is use for, none lost."""

from __future__ import annotations

from collections.abc import Iterator
from concurrent.futures import BrokenExecutor, Executor, Future, ThreadPoolExecutor
from threading import Event
from time import sleep
from typing import Any

import pytest

from helpers_many import Here, place
from tactile_graph.errors import DataError
from tactile_graph.many import in_order
from tactile_graph.many.executor_kind import ExecutorKind, Opened, Place
from tactile_graph.many.in_order import AHEAD, InOrder
from tactile_graph.many.portion import Portion

SIZE = 10


def frames(given: bytes, portion: Portion) -> list[int]:
    """Return which frames came: what a worker does here."""
    return [k for k in range(portion.low, portion.high) if k not in portion.without]


def portions(n: int) -> Iterator[Portion]:
    return (Portion(k, k + SIZE) for k in range(0, n * SIZE, SIZE))


def done(where: Place, n: int = 6) -> tuple[list[int], list[int]]:
    """Return the frames that came back, and those that were left out."""
    left_out: list[int] = []
    with InOrder(where, frames, b"", left_out.append) as workers:
        came = [k for _, got in workers.results(portions(n)) for k in got]
    return came, left_out


def test_what_portions_come_to_comes_in_order_and_whole() -> None:
    assert done(place()) == (list(range(60)), [])


def test_a_worker_that_is_killed_loses_nothing() -> None:
    assert done(place(chance=[3, 17, 17, 58])) == (list(range(60)), [])


@pytest.mark.parametrize("deadly", [{0}, {59}, {25}, {20, 29}, {3, 4, 5, 33}])
def test_deadly_frames_are_found_told_and_left_out(deadly: set[int]) -> None:
    came, left_out = done(place(deadly))
    assert came == [k for k in range(60) if k not in deadly]
    assert left_out == sorted(deadly)


def test_frames_that_kill_one_after_the_other_end_it_and_what_was_done_is_kept() -> None:
    left_out: list[int] = []
    told = "frames 14 to 21: each ended its worker, the last time .*; no more are tried"
    with InOrder(place({*range(14, 60)}), frames, b"", left_out.append) as workers:
        results = workers.results(portions(6))
        came = [k for _ in range(2) for k in next(results)[1]]
        with pytest.raises(DataError, match=told):
            next(results)
    assert came == [*range(14)]
    assert left_out == [*range(14, 22)]


def test_chance_deaths_beside_a_deadly_frame_blame_no_other() -> None:
    came, left_out = done(place({12}, chance=[11, 13, 14, 40]))
    assert (came, left_out) == ([k for k in range(60) if k != 12], [12])


class Gone(Here):
    """Cancels all that it is given, as a client does whose scheduler has died."""

    def submit(self, function: Any, /, *args: Any, **kwargs: Any) -> Future[Any]:
        future: Future[Any] = Future()
        future.cancel()
        future.set_running_or_notify_cancel()
        return future


def test_an_executor_that_cancels_what_it_has_is_opened_anew() -> None:
    executors = [Here(set(), []), Gone(set(), [])]

    def opened(address: str, n_workers: int | None) -> Opened:
        return Opened(executors.pop(), 2, lambda: None)

    assert done(Place(ExecutorKind("a cluster", opened), "", 2)) == (list(range(60)), [])


def test_nothing_is_cancelled_in_an_executor_that_may_break(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """A process pool of Python 3.11 never says what became of the rest if it does."""

    def refused(future: Future[Any]) -> bool:
        raise AssertionError("cancelled")

    monkeypatch.setattr(Future, "cancel", refused)
    came, left_out = done(place({25}))
    assert (came, left_out) == ([k for k in range(60) if k != 25], [25])
    with InOrder(place(), frames, b"", [].append) as workers:
        next(workers.results(portions(6)))
        workers.drop()
        assert [k for _, found in workers.results(portions(6)) for k in found] == [*range(60)]


def test_workers_that_die_without_any_frame_end_it_and_blame_none() -> None:
    class Down(Executor):
        def submit(self, function: Any, /, *args: Any, **kwargs: Any) -> Future[Any]:
            raise EOFError("no process to be had")

    down = Place(ExecutorKind("down", lambda a, n: Opened(Down(), 2, lambda: None)), "", 2)
    with pytest.raises(DataError, match="die before their first frame, no process to be had"):
        done(down)


class Counting(Here):
    """Breaks at the third frame that it is given, whichever that is."""

    n = 0

    def submit(self, function: Any, /, *args: Any, **kwargs: Any) -> Future[Any]:
        portion = args[1]
        self.n += len({*range(portion.low, portion.high)} - portion.without)
        self.deadly = {*range(60)} if self.n > 2 else set()
        return super().submit(function, *args, **kwargs)


def test_workers_that_die_of_any_frame_end_it_and_none_is_blamed_for_ever() -> None:
    kind = ExecutorKind("counting", lambda a, n: Opened(Counting(set(), []), 2, lambda: None))
    left_out: list[int] = []
    with (
        InOrder(Place(kind, "", 2), frames, b"", left_out.append) as workers,
        pytest.raises(DataError, match="they die after some frames, whichever these are"),
    ):
        next(workers.results(portions(6)))
    assert len(left_out) == len(set(left_out)) < 8


class Forgetful(Executor):
    """Forgets the portions it has from the nth on; of anything else it says that it is broken."""

    def __init__(self, n: int) -> None:
        self.n = n
        self.asked = 0

    def submit(self, function: Any, /, *args: Any, **kwargs: Any) -> Future[Any]:
        future: Future[Any] = Future()
        if function is int:
            self.asked += 1
            if self.asked > 1:
                raise BrokenExecutor("a process ended abruptly")
            future.set_result(0)
            return future
        self.n -= 1
        if self.n >= 0:
            future.set_result(function(*args, **kwargs))
        return future


@pytest.mark.parametrize("died", [(BrokenExecutor,), (ConnectionError,)])
def test_portions_that_a_broken_executor_forgets_are_done_again(
    monkeypatch: pytest.MonkeyPatch, died: tuple[type[BaseException], ...]
) -> None:
    monkeypatch.setattr(in_order, "PATIENCE_S", 0.01)
    pools = [Forgetful(2), Forgetful(99)]
    opened = iter(pools)
    kind = ExecutorKind("pools", lambda a, n: Opened(next(opened), 2, lambda: None, died))
    assert done(Place(kind, "", 2)) == (list(range(60)), [])
    assert [pool.asked for pool in pools] == [2, 0]


def test_who_waits_long_asks_again_and_waits_on(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(in_order, "PATIENCE_S", 0.01)
    pool = ThreadPoolExecutor(2)
    kind = ExecutorKind("threads", lambda a, n: Opened(pool, 2, pool.shutdown))
    times_out = TimeoutError("the work's own")

    def slow(given: bytes, portion: Portion) -> list[int]:
        sleep(0.05)
        if portion.low == 30:
            raise times_out
        return frames(given, portion)

    with InOrder(Place(kind, "", 2), slow, b"", [].append) as workers:
        results = workers.results(portions(6))
        came = [k for _ in range(3) for k in next(results)[1]]
        with pytest.raises(TimeoutError) as raised:
            next(results)
    assert came == list(range(30))
    assert raised.value is times_out


def test_who_waits_for_workers_that_are_not_there_is_told_once_each_time(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr(in_order, "PATIENCE_S", 0.01)
    there = [0, 0, 1, 0, 2, 2, 2, 2]
    asked, go_on = list[int](), Event()

    def n_there() -> int:
        asked.append(there[len(asked)] if len(asked) < len(there) else 2)
        if len(asked) >= len(there):
            go_on.set()
        return asked[-1]

    def work(given: bytes, portion: Portion) -> list[int]:
        assert go_on.wait(60)
        return frames(given, portion)

    pool = ThreadPoolExecutor(2)
    kind = ExecutorKind("a farm", lambda a, n: Opened(pool, 2, pool.shutdown, n_there=n_there))
    with InOrder(Place(kind, "", 2), work, b"", [].append) as workers:
        assert [k for _, got in workers.results(portions(2)) for k in got] == list(range(20))
    assert capsys.readouterr().err == "a farm: there is no worker; waiting for one\n" * 2


def test_an_error_of_the_work_is_raised_in_its_turn() -> None:
    def broken(given: bytes, portion: Portion) -> list[int]:
        if portion.low == 30:
            raise ValueError("no such frame")
        return frames(given, portion)

    with InOrder(place(), broken, b"", [].append) as workers:
        results = workers.results(portions(6))
        came = [k for _ in range(3) for k in next(results)[1]]
        with pytest.raises(ValueError, match="no such frame"):
            next(results)
    assert came == list(range(30))


def test_no_more_portions_are_taken_than_workers_have_use_for() -> None:
    go_on = Event()
    taken = []

    def work(given: bytes, portion: Portion) -> list[int]:
        go_on.wait(10)
        return frames(given, portion)

    def watched() -> Iterator[Portion]:
        for portion in portions(50):
            taken.append(portion.low)
            yield portion

    pool = ThreadPoolExecutor(2)
    where = Place(ExecutorKind("threads", lambda a, n: Opened(pool, 2, pool.shutdown)), "", 2)
    most = 0
    with InOrder(where, work, b"", [].append) as workers:
        go_on.set()
        for portion, _ in workers.results(watched()):
            most = max(most, (taken[-1] - portion.low) // SIZE + 1)
    assert most <= AHEAD * 2 + 1
    assert len(taken) == 50
