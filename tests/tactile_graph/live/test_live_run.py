"""A live run answers frames as they come; too many shed the oldest, and it says so."""

from __future__ import annotations

import asyncio
import itertools
import time
from collections.abc import Callable, Iterator
from contextlib import suppress
from queue import Empty, Queue
from threading import Event
from typing import Any

import numpy as np
import pytest

from helpers_graphs import STEPS, frame, registry
from tactile_graph import Frame, Pipeline, loads
from tactile_graph.errors import FrameError, PipelineError, UsageError
from tactile_graph.live import LiveRun, paced
from tactile_graph.live.waiting import Arrival, Waiting
from tactile_graph.steps import Report

PLUS = """
pipeline: plus
nodes:
  number: {step: read, in: frame}
  more: {step: add1, in: number, with: {k: 1}}
outputs: [more]
"""
COUNTING = PLUS.replace("add1, in: number, with: {k: 1}", "count, in: number")


def pipeline(text: str = PLUS) -> Pipeline:
    return loads(text, "p.yaml", registry(STEPS))


def frames(n: int) -> list[Frame]:
    return [frame(i % 100, i, i * 0.01) for i in range(n)]


class Fed:
    """A source that gives a frame when it is told to, and says when it was asked for the next."""

    def __init__(self) -> None:
        self._given: list[Frame | None] = []
        self._more, self.asked = Event(), Event()

    def give(self, one: Frame | None) -> None:
        """Give a frame, or the end, and wait until the reader is back for more."""
        self.asked.clear()
        self._given.append(one)
        self._more.set()
        assert self.asked.wait(5) or one is None

    def __iter__(self) -> Iterator[Frame]:
        while True:
            self.asked.set()
            assert self._more.wait(5)
            self._more.clear()
            one = self._given.pop(0)
            if one is None:
                self.asked.set()
                return
            yield one


def test_every_frame_is_answered_in_order_with_its_times() -> None:
    ticks = iter(range(0, 10**9, 1000))
    run = LiveRun(pipeline(), frames(20), clock=lambda: next(ticks))
    results = list(run)
    assert [live.result["more"] for live in results] == list(range(1, 21))
    assert all(live.arrived_ns < live.begun_ns < live.done_ns for live in results)
    assert all(live.latency_us >= 2 for live in results)
    assert results[-1].shed == results[-1].lost == 0
    assert results[-1].decisions == ()


def test_when_too_many_wait_the_oldest_go_and_are_counted() -> None:
    fed = Fed()
    run = LiveRun(pipeline(), fed, capacity=3)
    results = iter(run)
    first: list[Any] = []
    fed._given.append(frame(0, 0))
    fed._more.set()
    first.append(next(results))  # begins to read
    for i in range(1, 9):
        fed.give(frame(i, i))
    fed.give(None)
    left = list(results)
    assert [live.result.frame.index for live in left] == [6, 7, 8]
    assert run.n_shed == 5
    assert {live.shed for live in left} == {5}


def test_frames_that_the_source_lost_are_told() -> None:
    given = [frame(0, 0), Frame(frame(1, 2).image, 2, gap=True), frame(1, 3)]
    assert [live.lost for live in LiveRun(pipeline(), given)] == [0, 1, 1]


def test_what_the_source_raises_comes_after_the_frames_it_gave() -> None:
    def broken() -> Iterator[Frame]:
        yield from frames(3)
        raise OSError("unplugged")

    got = []
    with pytest.raises(OSError, match="unplugged"):
        LiveRun(pipeline(), broken()).run(got.append)
    assert len(got) == 3


def test_another_pipeline_takes_over_between_two_frames() -> None:
    run = LiveRun(pipeline(), frames(4))
    values = []
    for live in run:
        values.append(live.result["more"])
        if len(values) == 2:
            run.swap(pipeline(PLUS.replace("k: 1", "k: 100")))
    assert values == [1, 2, 102, 103]


def test_a_pipeline_that_is_to_take_over_may_be_tried_before_with_a_state_of_its_own() -> None:
    run = LiveRun(pipeline(), [frame(5, 0, 0.0), frame(5, 1, 0.01)])
    run.swap(pipeline(COUNTING), tried_on=frames(10))
    assert [live.result["more"] for live in run] == [5, 11]


def begun() -> tuple[Fed, LiveRun[Any], Iterator[Any]]:
    """Return a run that has answered its first frame, and what feeds it."""
    fed = Fed()
    run = LiveRun(pipeline(), fed)
    results = iter(run)
    fed._given.append(frame(0, 0))
    fed._more.set()
    assert next(results).result.frame.index == 0
    return fed, run, results


def test_a_paused_run_lets_frames_pass_and_answers_one_for_each_step() -> None:
    fed, run, results = begun()
    run.pause()
    fed.give(frame(1, 1))
    run.step()
    fed.give(frame(2, 2))
    fed.give(frame(3, 3))
    run.resume()
    fed.give(frame(4, 4))
    fed.give(None)
    assert [live.result.frame.index for live in results] == [2, 4]
    assert run.n_shed == 0


def test_steps_that_are_asked_for_while_it_runs_are_not_saved_up() -> None:
    fed, run, results = begun()
    run.step()
    run.pause()
    fed.give(frame(1, 1))
    run.step()
    run.resume()
    run.pause()
    fed.give(frame(2, 2))
    run.resume()
    fed.give(frame(3, 3))
    fed.give(None)
    assert [live.result.frame.index for live in results] == [3]


def test_a_source_is_closed_when_the_run_ends() -> None:
    closed = Event()

    def watched() -> Iterator[Frame]:
        try:
            yield from frames(1_000)
        finally:
            closed.set()

    run = LiveRun(pipeline(), watched())
    next(iter(run))
    run.stop()
    assert closed.wait(5)


def test_a_source_that_waits_is_told_that_no_frame_is_wanted() -> None:
    report = Report()
    report.wanted = False  # of a run before
    run = LiveRun(pipeline(), frames(5), report=report)
    assert report.wanted
    run.stop()
    assert not report.wanted


def test_a_report_serves_again_once_the_source_is_closed() -> None:
    report, closed = Report(), Event()

    def watched() -> Iterator[Frame]:
        try:
            while report.wanted:
                yield from frames(1)
        finally:
            closed.set()

    run = LiveRun(pipeline(), watched(), report=report)
    next(iter(run))
    run.stop()
    assert closed.wait(5)
    for _ in range(500):
        if report.wanted:
            break
        time.sleep(0.01)
    assert report.wanted


def test_it_ends_when_it_is_stopped() -> None:
    def endless() -> Iterator[Frame]:
        index = 0
        while True:
            yield frame(index % 50, index)
            index += 1

    run = LiveRun(pipeline(), endless())
    taken = []
    for live in run:
        taken.append(live)
        if len(taken) == 5:
            run.stop()
    assert len(taken) == 5


LADDER = """
pipeline: ladder
nodes:
  best: {step: read, in: frame}
  cheap: {step: read_frame, in: frame}
  answer: {first_of: [best, cheap]}
outputs: [answer]
"""


def each_ms() -> Callable[[], int]:
    """Return a clock that a millisecond goes by on whenever it is looked at."""
    ticks = itertools.count(1)
    return lambda: 1_000_000 * next(ticks)


def test_what_is_known_of_times_is_known_to_the_pipeline_that_takes_over() -> None:
    text = LADDER.replace("best", "finest")
    run = LiveRun(pipeline(LADDER), [frame(7, i) for i in range(4)], clock=each_ms(), deadline_us=1)
    decisions = []
    for live in run:
        decisions.append(live.decisions)
        if len(decisions) == 2:
            run.swap(pipeline(text))
    assert decisions == [(), ("best",), ("finest",), ("finest",)]  # tried once, and no more


def test_a_deadline_can_be_set_changed_and_taken_away_while_it_runs() -> None:
    given = [frame(7, i) for i in range(9)]
    run = LiveRun(pipeline(LADDER), given, clock=each_ms(), deadline_us=1e9)
    values = []
    for live in run:
        values.append((live.result["answer"], live.decisions))
        if len(values) == 3:
            run.deadline_us = 1.0
        if len(values) == 6:
            run.deadline_us = None
    assert values == [(7, ())] * 3 + [(i, ("best",)) for i in (3, 4, 5)] + [(7, ())] * 3


def test_the_files_own_deadline_counts_unless_another_is_given() -> None:
    own = pipeline(PLUS.replace("nodes:", "deadline_us: 2500\nnodes:"))
    run = LiveRun(own, [])
    assert run.deadline_us == 2500
    assert own.resolved()["deadline_us"] == 2500
    run.swap(pipeline())
    assert run.deadline_us is None
    run.deadline_us = 100
    run.swap(own)
    assert run.deadline_us == 100
    run.deadline_us = None
    assert run.deadline_us == 2500


@pytest.mark.parametrize("wrong", ["0", "soon", "-2", "true", ".inf", ".nan"])
def test_a_deadline_in_a_file_is_a_number_above_0(wrong: str) -> None:
    message = r"p.yaml:3:\d+: 'deadline_us' must be a number above 0, got"
    with pytest.raises(PipelineError, match=message):
        pipeline(PLUS.replace("nodes:", f"deadline_us: {wrong}\nnodes:"))


@pytest.mark.parametrize("wrong", [0, -1, float("nan"), float("inf"), "5ms", True])
def test_a_deadline_that_is_none_is_refused(wrong: Any) -> None:
    with pytest.raises(UsageError, match="a deadline is a number of microseconds above 0, got"):
        LiveRun(pipeline(), [], deadline_us=wrong)


@pytest.mark.parametrize("wrong", [0, -1, "8", True, 2.5])
def test_room_for_no_frame_or_result_is_refused(wrong: Any) -> None:
    with pytest.raises(UsageError, match="capacity: must be a whole number >= 1, got"):
        LiveRun(pipeline(), frames(1), capacity=wrong)
    with pytest.raises(UsageError, match="unread: must be a whole number >= 1, got"):
        pipeline().live(frames(1), unread=wrong)


def test_what_is_no_pipeline_is_neither_run_nor_swapped_to() -> None:
    message = r"a pipeline is needed, got 'circle-1'; load\('circle-1'\) makes one"
    with pytest.raises(UsageError, match=message):
        LiveRun("circle-1", frames(1))  # type: ignore[type-var]
    run = LiveRun(pipeline(), frames(1))
    with pytest.raises(UsageError, match=message):
        run.swap("circle-1")  # type: ignore[arg-type]
    assert len(list(run)) == 1


def test_a_pipelines_own_source_reports() -> None:
    own = loads(
        PLUS.replace("nodes:", "source: {step: few}\nnodes:"),
        "p.yaml",
        registry({**STEPS, "few": few}),
    )
    run = LiveRun(own)
    assert len(list(run)) == 3
    assert run.report.counts["frames"] == 3


def few() -> Iterator[Frame]:
    yield from frames(3)


# -- for async for -------------------------------------------------------------------------------


def test_results_come_by_async_for() -> None:
    async def answers() -> list[int]:
        return [live.result["more"] async for live in pipeline(COUNTING).live(frames(30))]

    assert asyncio.run(answers())[:4] == [0, 2, 4, 7]  # with the gaps of 10 ms


def test_a_stream_may_be_left_early() -> None:
    async def first() -> int:
        async with pipeline().live(frames(1000)) as stream:
            async for live in stream:
                value: int = live.result["more"]
                return value
        raise AssertionError

    assert asyncio.run(first()) >= 1


def test_what_the_source_raises_is_raised_by_async_for() -> None:
    def broken() -> Iterator[Frame]:
        yield from frames(2)
        raise OSError("unplugged")

    async def answers() -> None:
        stream = pipeline().live(broken())
        assert [(await anext(stream)).result["more"] for _ in range(2)] == [1, 2]
        with pytest.raises(OSError, match="unplugged"):
            await anext(stream)

    asyncio.run(answers())


def test_a_source_that_waits_for_a_queue_ends_when_its_stream_is_closed() -> None:
    given: Queue[Frame] = Queue()
    report, closed = Report(), Event()

    def source() -> Iterator[Frame]:
        try:
            while report.wanted:
                with suppress(Empty):
                    yield given.get(timeout=0.01)
        finally:
            closed.set()

    async def first() -> None:
        given.put(frame(1, 0))
        async with pipeline().live(source(), report=report) as stream:
            assert (await anext(stream)).result["more"] == 2

    asyncio.run(first())
    assert closed.wait(5)


def test_arrays_are_frames_and_what_makes_none_is_told_by_its_number() -> None:
    async def answers() -> None:
        given = [np.full((2, 2), 3.0), frame(4, 7), np.ones(3)]
        stream = pipeline().live(given)  # type: ignore[arg-type]
        taken = [await anext(stream) for _ in range(2)]
        assert [live.result["more"] for live in taken] == [4, 5]
        assert [live.result.frame.index for live in taken] == [0, 7]
        with pytest.raises(FrameError, match="frame 2: a frame takes values of shape"):
            await anext(stream)

    asyncio.run(answers())


def test_results_that_nobody_takes_go_and_are_counted() -> None:
    async def slow() -> tuple[int, int]:
        stream = pipeline().live(frames(60), capacity=1000, unread=8)
        taken = [await anext(stream)]
        assert stream._thread is not None
        await asyncio.to_thread(stream._thread.join)
        taken += [live async for live in stream]
        return len(taken), stream.n_unread

    n_taken, n_unread = asyncio.run(slow())
    assert n_taken + n_unread == 60
    assert n_taken <= 9


# -- the queue, and the pace ---------------------------------------------------------------------


def test_a_queue_that_is_ended_still_gives_what_waits() -> None:
    waiting = Waiting(2)
    waiting.put(Arrival(frame(0, 0), 1))
    waiting.end()
    assert not waiting.over
    taken = waiting.take()
    assert taken is not None
    assert taken.arrived_ns == 1
    assert waiting.take() is None
    assert waiting.over


class Slept:
    def __init__(self) -> None:
        self.now_s = 100.0

    def clock_s(self) -> float:
        return self.now_s

    def sleep(self, seconds: float) -> None:
        self.now_s += seconds


def test_a_recording_comes_at_its_own_pace_or_another() -> None:
    for rate_hz, expected in ((None, [0.0, 0.01, 0.02]), (50.0, [0.0, 0.02, 0.04])):
        slept = Slept()
        came = [
            slept.now_s - 100.0
            for _ in paced(frames(3), rate_hz, clock_s=slept.clock_s, sleep=slept.sleep)
        ]
        assert came == pytest.approx(expected)


def test_frames_without_times_want_a_rate() -> None:
    with pytest.raises(UsageError, match="frame 0 has no time: give a rate in frames a second"):
        next(paced([Frame(frame(0, 0).image)]))
    with pytest.raises(UsageError, match="a rate is above 0 frames a second, got 0"):
        next(paced(frames(1), 0))
    with pytest.raises(UsageError, match="a rate is above 0 frames a second, got '100'"):
        next(paced(frames(1), "100"))  # type: ignore[arg-type]
    with pytest.raises(UsageError, match="frame 1 has no time: give a rate in frames a second"):
        list(paced([frames(1)[0], np.zeros((2, 2))]))
    with pytest.raises(UsageError, match="frames are needed, got NoneType"):
        next(paced(None, 100))  # type: ignore[arg-type]


def test_bare_arrays_are_paced_too_and_numbered() -> None:
    assert [f.index for f in paced([np.zeros((2, 2))] * 3, float("inf"))] == [0, 1, 2]
