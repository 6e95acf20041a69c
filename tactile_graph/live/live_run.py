"""``LiveRun``: a source read by a thread of its own, each frame answered as soon as may be.

The reader does nothing but take frames and stamp them, so that a frame's arrival is known however
long the one before it takes. Frames wait in a queue of bounded length; when one too many comes the
oldest is shed, and counted. The loop stands in the caller's thread.
"""

from __future__ import annotations

import time
from collections.abc import Callable, Generator, Iterable, Iterator, Sequence
from threading import Lock, Thread
from typing import TYPE_CHECKING, Any, Generic, NamedTuple, Protocol, TypeVar

from tactile_graph.engine.calls.isolated import ProcessState
from tactile_graph.engine.deadlines.deadline import Deadline
from tactile_graph.engine.deadlines.options import Decider
from tactile_graph.engine.outcomes.outcomes import Outcomes
from tactile_graph.engine.runner import Runner
from tactile_graph.live.asked import check_pipeline, checked_deadline, checked_room
from tactile_graph.live.beside import Beside
from tactile_graph.live.live_result import LiveResult
from tactile_graph.live.waiting import Arrival, Waiting
from tactile_graph.steps.injected import Report
from tactile_graph.wires.frame import Frame
from tactile_graph.wires.given import as_frame, check_frames

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    from tactile_graph.wires.image import Image

ResultT = TypeVar("ResultT", bound=Outcomes)
Clock = Callable[[], int]
CAPACITY = 64
"""Frames that may wait: at 1 kHz a stall of 64 ms costs none."""


class Runnable(Protocol[ResultT]):
    """What a live run needs of a pipeline."""

    def runner(
        self,
        only: Sequence[str] | None = ...,
        seed: int = ...,
        verify: bool = ...,
        decider: Decider | None = ...,
        after: Runner[ResultT] | None = ...,
    ) -> Runner[ResultT]:
        """Return a callable of frames that keeps state, or goes on with that of another."""

    def frames(self, seed: int = ..., report: Report | None = ...) -> Iterator[Frame]:
        """Return the frames of the pipeline's own source."""

    @property
    def deadline_us(self) -> float | None:
        """The file's own."""


class Ready(NamedTuple, Generic[ResultT]):
    """A runner, and what keeps its frames on time."""

    runner: Runner[ResultT]
    deadline: Deadline | None
    deadline_us: float | None


class LiveRun(Generic[ResultT]):
    """Iterate over it: the result of each frame, as it comes, with its times.

    All of its methods may be called from other threads than the one that iterates. It can be
    iterated over once.

    Parameters
    ----------
    pipeline : Pipeline
    source : iterable of Frame, Image or ndarray, optional
        The pipeline's own source if not given. Read as fast as it gives frames: a recording wants
        `paced`.
    only : sequence of str, optional
        Nodes or ``node.field`` to ask for instead of the pipeline's outputs.
    seed : int
        Seed of the steps that take randomness, and of the source.
    deadline_us : float, optional
        Microseconds from a frame's arrival within which its result is wanted: what would not be
        done in time is skipped. The pipeline's own ``deadline_us`` if not given.
    capacity : int
        How many frames may wait; at least 1.
    report : Report, optional
        Receives what the pipeline's own source has to say. Its ``wanted`` is false once the run is
        stopped: a source that waits for something looks there now and then, and ends; it is closed
        no sooner than at its next frame.
    clock : callable
        Nanoseconds now.

    Raises
    ------
    UsageError
        If the pipeline, the source or a number is none.
    """

    def __init__(
        self,
        pipeline: Runnable[ResultT],
        source: Iterable[Frame | Image | NDArray[np.generic]] | None = None,
        *,
        only: Sequence[str] | None = None,
        seed: int = 0,
        deadline_us: float | None = None,
        capacity: int = CAPACITY,
        report: Report | None = None,
        clock: Clock = time.perf_counter_ns,
    ) -> None:
        self.report = report or Report()
        self.report.wanted = True
        self._asked_us = checked_deadline(deadline_us)
        self._only, self._seed, self._clock = only, seed, clock
        self._pipeline = pipeline
        self._ready = self._made_ready(pipeline)
        if source is not None:
            check_frames(source)
        self._source: Iterable[Frame | Image | NDArray[np.generic]] = (
            pipeline.frames(seed, self.report) if source is None else source
        )
        self._waiting = Waiting(checked_room("capacity", capacity))
        self._error: BaseException | None = None
        self._stopped = False
        self._paused = False
        self._steps = 0
        self._asking = Lock()
        self.n_lost = 0
        self.beside: Beside | None = None
        """A variant that is given the newest frames, in what time is left."""

    # -- what others may ask of it -------------------------------------------------------------

    @property
    def n_shed(self) -> int:
        """How many frames were shed since the run began."""
        return self._waiting.n_shed

    @property
    def n_waiting(self) -> int:
        """How many frames wait now."""
        return len(self._waiting)

    @property
    def processes(self) -> dict[str, ProcessState]:
        """How the processes fare of the nodes that run in one of their own."""
        return self._ready.runner.processes

    @property
    def paused(self) -> bool:
        """Whether frames are let pass without a result."""
        return self._paused

    @property
    def deadline_us(self) -> float | None:
        """Microseconds from a frame's arrival within which its result is wanted; None for none.

        Set to None it is the pipeline's own, if that has one.
        """
        return self._ready.deadline_us

    @deadline_us.setter
    def deadline_us(self, deadline_us: float | None) -> None:
        self._asked_us = checked_deadline(deadline_us)
        now_us = self._asked_us or self._pipeline.deadline_us
        if (now_us is None) == (self._ready.deadline is None):
            self._ready = self._ready._replace(deadline_us=now_us)
        else:
            self.swap(self._pipeline)

    def swap(self, pipeline: Runnable[ResultT], tried_on: Iterable[Frame] = ()) -> tuple[str, ...]:
        """Run another pipeline from the next frame on, over the same source.

        It is made ready in the caller's thread, so that no frame waits for that. A node that keeps
        something goes on with it where the pipeline before has an equal one: of the same step,
        settings and guard, that reads the same, with the same code and the same in the files that
        settings name. So it does with what is known of its times.

        Parameters
        ----------
        pipeline : Pipeline
        tried_on : iterable of Frame, optional
            Frames that it is run on before, with a state of their own: kernels are then compiled
            when the first frame comes. Not for pipelines that write.

        Returns
        -------
        tuple of str
            Nodes that keep something and begin anew.
        """
        if frames := list(tried_on):
            trial = pipeline.runner(self._only, self._seed)
            for frame in frames:
                trial(frame)
        ready = self._made_ready(pipeline, self._ready)
        self._pipeline = pipeline
        self._ready = ready
        return ready.runner.anew

    def _made_ready(
        self, pipeline: Runnable[ResultT], after: Ready[ResultT] | None = None
    ) -> Ready[ResultT]:
        check_pipeline(pipeline)
        before, timed = (None, None) if after is None else (after.runner, after.deadline)
        deadline_us = self._asked_us or pipeline.deadline_us
        deadline = None if deadline_us is None else Deadline(self._clock, timed)
        runner = pipeline.runner(self._only, self._seed, decider=deadline, after=before)
        return Ready(runner, deadline, deadline_us)

    def pause(self) -> None:
        """Let frames pass without a result until `resume` or `step`; they do not count as shed."""
        self._paused = True
        self._waiting.clear()

    def resume(self) -> None:
        """Go on with the next frame that comes."""
        with self._asking:
            self._paused, self._steps = False, 0

    def step(self) -> None:
        """While paused: answer one more frame, the next that comes; else nothing happens."""
        with self._asking:
            self._steps += self._paused

    def stop(self) -> None:
        """End the run after the frame that is under way."""
        self._stopped = True
        self.report.wanted = False
        self._waiting.end()

    # -- the loop ------------------------------------------------------------------------------

    def run(self, publish: Callable[[LiveResult[ResultT]], Any]) -> None:
        """Hand each result to a callable, until the source ends or `stop`."""
        for live in self:
            publish(live)

    def __iter__(self) -> Iterator[LiveResult[ResultT]]:
        """Yield results as frames come.

        Raises
        ------
        Exception
            What the source raised, or a `FrameError` where it gave none, after the frames before.
        """
        reader = Thread(target=self._read, name="tactile-graph reader", daemon=True)
        reader.start()
        try:
            while not self._stopped and not self._waiting.over:
                arrival = self._waiting.take()
                if arrival is not None and not self._stopped:
                    yield self._answered(arrival)
        finally:
            self.stop()
        if self._error is not None:
            raise self._error

    def _answered(self, arrival: Arrival) -> LiveResult[ResultT]:
        frame, arrived_ns = arrival
        self.n_lost += frame.gap
        runner, deadline, deadline_us = self._ready
        if deadline is not None and deadline_us is not None:
            deadline.arrived_ns = arrived_ns
            deadline.due_ns = arrived_ns + int(1e3 * deadline_us)
        begun_ns = self._clock()
        result = runner(frame)
        done_ns = self._clock()
        if self.beside is not None:
            self.beside.offer(result, (done_ns - begun_ns) / 1e3)
        decisions = () if deadline is None else result.decisions
        return LiveResult(
            result, arrived_ns, begun_ns, done_ns, self.n_shed, self.n_lost, decisions
        )

    # -- the reader ----------------------------------------------------------------------------

    def _read(self) -> None:
        try:
            for index, given in enumerate(self._source):
                frame = given if isinstance(given, Frame) else as_frame(given, index)
                arrival = Arrival(frame, self._clock())
                if self._stopped:
                    break
                if not self._paused or self._one_more():
                    self._waiting.put(arrival)
        except BaseException as error:  # a source may raise anything; it is raised where it is read
            self._error = error
        finally:
            self._waiting.end()
            if isinstance(self._source, Generator):
                self._source.close()  # a port is free again, a file closed
            self.report.wanted = True  # of who reads a source with this report next

    def _one_more(self) -> bool:
        with self._asking:
            asked = self._steps > 0
            self._steps -= asked
            return asked
