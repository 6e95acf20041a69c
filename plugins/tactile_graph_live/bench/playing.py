"""Frames of any source as a running pad gives them: at their pace, for ever, held when asked."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator
from dataclasses import replace
from threading import Condition, Event
from typing import TYPE_CHECKING

from tactile_graph import Frame, Pipeline
from tactile_graph.plugins.registry import installed
from tactile_graph.steps import Report

if TYPE_CHECKING:
    from tactile_graph_sources.devices.capture import CaptureDevice

LONGEST_PAUSE_S = 0.5
USUAL_RATE_HZ = 30.0
PACE = "speed"
"""The setting by which a source that keeps a pace of its own is known."""


def device_of(pipeline: Pipeline) -> CaptureDevice | None:
    """Return the device that a pipeline's frames come from, if they do: it waits for nobody."""
    if pipeline.source is None:
        return None
    registry = installed()
    devices: list[CaptureDevice] = [registry.load("devices", n) for n in registry.names("devices")]
    steps = {registry.spelled("steps", device.step): device for device in devices}
    return steps.get(pipeline.source.name)


def is_device(pipeline: Pipeline) -> bool:
    """Return whether a pipeline's frames come from a device that waits for nobody."""
    return device_of(pipeline) is not None


def keeps_pace(pipeline: Pipeline) -> bool:
    """Return whether the source itself gives each frame when its time has come."""
    source = pipeline.source
    return is_device(pipeline) or (source is not None and PACE in source.settings)


class Pace:
    """When frames are due: by their own times, or at a rate; pauses are cut short.

    Parameters
    ----------
    rate_hz : float, optional
        Instead of the frames' own times, and where these have none.
    """

    def __init__(self, rate_hz: float | None) -> None:
        self._rate_hz = rate_hz
        self._last_s: float | None = None
        self._due: float | None = None

    def wait_s(self, frame: Frame, now: float) -> float:
        """Return how long to wait before a frame is given; what is late is not caught up."""
        step = 1.0 / (self._rate_hz or USUAL_RATE_HZ)
        if self._rate_hz is None and frame.time_s is not None and self._last_s is not None:
            step = frame.time_s - self._last_s
            step = min(step, LONGEST_PAUSE_S) if step > 0 else 1.0 / USUAL_RATE_HZ
        self._last_s = frame.time_s
        if self._due is None or now - self._due > LONGEST_PAUSE_S:
            self._due = now
        else:
            self._due += step
        return max(0.0, self._due - now)


class Player:
    """Iterate over it: the frames of a pipeline's source, numbered through.

    Parameters
    ----------
    open_frames : callable
        Returns an iterator of the source's frames, given which time it is read, from 0.
    pace : Pace or None
        When each is due; as fast as they are taken if None.
    once : bool
        Whether it ends with the source, instead of starting over.
    first : int
        Number of the first frame.

    Attributes
    ----------
    closed : Event
        Set once it has ended and the source is closed.
    in_hand : bool
        Whether the source gave a frame that waits here, held or not due yet.
    """

    def __init__(
        self,
        open_frames: Callable[[int], Iterator[Frame]],
        *,
        pace: Pace | None,
        once: bool,
        first: int = 0,
    ) -> None:
        self._open, self._pace, self._once = open_frames, pace, once
        self.next_index = first
        self._changed = Condition()
        self._held = False
        self._more = 0
        self._ended = False
        self.closed = Event()
        self.in_hand = False

    def hold(self, on: bool) -> None:
        """Give no more frames, or go on; of a device they are taken all the same."""
        with self._changed:
            self._held, self._more = on, 0
            self._changed.notify_all()

    def one_more(self) -> None:
        """While held: give one frame."""
        with self._changed:
            self._more += 1
            self._changed.notify_all()

    def end(self) -> None:
        """Give no more frames."""
        with self._changed:
            self._ended = True
            self._changed.notify_all()

    def __iter__(self) -> Iterator[Frame]:
        """Yield the frames."""
        try:
            yield from self._frames()
        finally:
            self.closed.set()

    def _frames(self) -> Iterator[Frame]:
        round_ = 0
        while not self._ended:
            before = self.next_index
            frames = self._open(round_)
            try:
                for frame in frames:
                    if not self._wait(frame):
                        return
                    number, self.next_index = self.next_index, self.next_index + 1
                    yield replace(frame, index=number)
            finally:
                close = getattr(frames, "close", None)
                if close is not None:
                    close()
            if self._once or self.next_index == before:
                return
            round_ += 1

    def _wait(self, frame: Frame) -> bool:
        """Wait until a frame may go; return False when none is wanted any more."""
        if self._pace is None:
            return not self._ended
        due = time.perf_counter() + self._pace.wait_s(frame, time.perf_counter())
        with self._changed:
            while not self._ended:
                left = due - time.perf_counter()
                if self._more:
                    self._more -= 1
                    return True
                if not self._held and left <= 0:
                    return True
                self.in_hand = True
                self._changed.wait(None if self._held else left)
                self.in_hand = False
        return False


def player(
    pipeline: Pipeline,
    seed: int,
    report: Report,
    *,
    rate_hz: float | None = None,
    once: bool = False,
    unpaced: bool = False,
    first: int = 0,
) -> Player:
    """Return what plays a pipeline's source."""
    own = keeps_pace(pipeline) or unpaced
    return Player(
        lambda round_: pipeline.frames(seed + round_, report),
        pace=None if own else Pace(rate_hz),
        once=once or is_device(pipeline),
        first=first,
    )
