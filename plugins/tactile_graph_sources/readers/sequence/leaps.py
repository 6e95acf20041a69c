"""Times that leap ahead, go back or stand still, as joined or interrupted recordings have: told."""

from __future__ import annotations

from collections import deque
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field, replace
from itertools import chain
from statistics import median

from tactile_graph.steps import Report
from tactile_graph.wires import Frame
from tactile_graph.wires.frame_stack import FrameStack

LEAP = 20.0
"""Times the usual step from frame to frame, from which on a step is a leap."""
FEWEST_STEPS, RECENT = 3, 31
TIMELESS = "frames without a time, among others that have one"


def is_leap(step_s: float, usual_s: float) -> bool:
    """Return whether a step from one frame's time to the next's is none that is usual."""
    return step_s < 0.0 or step_s > LEAP * usual_s > 0.0


def usual_step(steps_s: Sequence[float]) -> float:
    """Return the median of the steps that go on; 0 where too few do to call any usual."""
    onward = [s for s in steps_s if s > 0.0]
    return median(onward) if len(onward) >= FEWEST_STEPS else 0.0


@dataclass(slots=True)
class _Clock:
    """The last time of one sensor, its latest steps, and its frames before any time."""

    last_s: float | None = None
    n_before: int = 0
    steps_s: deque[float] = field(default_factory=lambda: deque(maxlen=RECENT))


def stacks_with_leaps_told(
    frames: Iterator[Frame | FrameStack], report: Report, where: str
) -> Iterator[Frame | FrameStack]:
    """Yield what `with_leaps_told` does, as stacks up to the first whose times may leap."""
    clock = _Clock()
    for some in frames:
        if not isinstance(some, FrameStack) or not _goes_on(clock, some):
            rest = chain([some], frames)
            flat = (f for s in rest for f in (s if isinstance(s, FrameStack) else (s,)))
            yield from with_leaps_told(flat, report, where, clock)
            return
        yield some


def _goes_on(clock: _Clock, stack: FrameStack) -> bool:
    """Return whether no time of a stack can be a leap or repeat; if so, take its steps in."""
    if stack.time_s is None:
        return True
    times = stack.time_s.tolist()
    lasts = [times[0] if clock.last_s is None else clock.last_s, *times[:-1]]
    steps = [time_s - last_s for time_s, last_s in zip(times, lasts, strict=True)]
    every = [*clock.steps_s, *steps]
    least = min((step for step in every if step > 0.0), default=0.0)
    known = steps[clock.last_s is None :]  # a first frame has none
    if min(known, default=1.0) <= 0.0 or max(every) > LEAP * least:
        return False
    clock.last_s = times[-1]
    clock.steps_s.extend(steps)
    return True


def with_leaps_told(
    frames: Iterator[Frame], report: Report, where: str, begun: _Clock | None = None
) -> Iterator[Frame]:
    """Yield the frames; leaps in time and times that repeat are counted.

    A frame whose time goes back is told, and marked as following a gap: recordings were joined or
    sorted. Time that leaps ahead is what devices that pause give, and no frame need be missing.
    Where frames share a time, as by a clock coarser than they come, speeds are too high. Frames
    without a time are counted where others have one.

    Parameters
    ----------
    frames : iterator of Frame
        Those of several sensors, told apart by their labels, may take turns.
    report : Report
    where : str
        The file, for the report.
    begun : _Clock, optional
        That of frames without a label, where some came before.
    """
    clocks: dict[str, _Clock] = {} if begun is None else {"": begun}
    for frame in frames:
        time_s = frame.time_s
        clock = clocks.setdefault(frame.label, _Clock())
        if time_s is None:
            if clock.last_s is None:  # none of its frames may have one
                clock.n_before += 1
            else:
                report.count(TIMELESS)
            yield frame
            continue
        if clock.n_before:
            report.count(TIMELESS, clock.n_before)
            clock.n_before = 0
        last_s, clock.last_s = clock.last_s, time_s
        step_s = 0.0 if last_s is None else time_s - last_s
        if step_s < 0.0:
            report.count("frames whose time goes back")
            told = f"its time goes back from {last_s:.6g} to {time_s:.6g} s; it follows a gap"
            report.trouble(f"{where}: frame {frame.index}", told)
            yield replace(frame, gap=True)
            continue
        if step_s == 0.0 and last_s is not None:
            report.count("frames at the very time of the one before")
        if not frame.gap and is_leap(step_s, usual_step(clock.steps_s)):
            report.count("leaps in time of more than 20 usual steps")
        clock.steps_s.append(step_s)
        yield frame
