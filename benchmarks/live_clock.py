"""What ``live`` would answer in time with a processor of its own: frames on the processor's clock.

The frames of ``benchmarks/live.py`` through a pipeline, one each two milliseconds by a clock that
only this thread's processor time moves on, the engine's own scheduler deciding. Other programs on
the machine thus cost nothing; nor do they on a quiet one. Reading, keeping and showing a frame is
taken to cost ``--beside`` besides.

    python benchmarks/live_clock.py --deadline 8 --set object.quick=true
"""

from __future__ import annotations

import argparse
import time
from typing import Any, NamedTuple

import numpy as np
from live import pads

import tactile_graph as tg
from tactile_graph.compiled import warm_up
from tactile_graph.live import Deadline
from tactile_graph_live.bench.settled import Settled

MOST_WAITING = 64
PARTS = 6
"""Of the run, reported one by one: the scheduler learns."""


class Clock:
    """Nanoseconds of processor time since the first frame, and what was waited for."""

    def __init__(self) -> None:
        self.now_ns = 0
        self._seen_ns = time.thread_time_ns()

    def __call__(self) -> int:
        """Return the time."""
        seen_ns = time.thread_time_ns()
        self.now_ns += seen_ns - self._seen_ns
        self._seen_ns = seen_ns
        return self.now_ns


class Answered(NamedTuple):
    """What became of a frame: shed frames have no time, empty pads nothing to answer."""

    latency_ms: float
    touched: bool
    answered: bool


def answered(pipeline: tg.Pipeline, frames: list[tg.Frame], asked: Any) -> list[Answered]:
    """Return what becomes of frames that come one each period."""
    clock, settled, found = Clock(), Settled(), []
    deadline = Deadline(clock)
    runner = pipeline.runner(decider=deadline if asked.deadline else None)
    output, period_ns = next(iter(pipeline.outputs)), round(1e9 / asked.rate)
    settled()
    for number in range(asked.rounds * len(frames)):
        arrived_ns = number * period_ns
        clock.now_ns = max(clock(), arrived_ns)
        if clock.now_ns - arrived_ns > MOST_WAITING * period_ns:
            found.append(Answered(np.nan, False, False))
            continue
        clock.now_ns += int(1e6 * asked.beside)
        deadline.arrived_ns = arrived_ns
        deadline.due_ns = arrived_ns + int(1e6 * asked.deadline)
        result = runner(frames[number % len(frames)].with_index(number))
        latency_ms = (clock() - arrived_ns) / 1e6
        has_value = result.get(output) is not None
        found.append(Answered(latency_ms, has_value or bool(result.decisions), has_value))
        settled()
    return found


def line(part: list[Answered], deadline_ms: float) -> str:
    """Return a part of the run in words."""
    latency_ms, touched, has_value = np.array(part, float).T
    share = has_value.sum() / max(touched.sum(), 1)
    done = latency_ms[np.isfinite(latency_ms)]
    late = f"{100 * np.mean(done > deadline_ms):5.2f} % late, " if deadline_ms else ""
    of_all = np.percentile(done, (50, 99, 100))
    return (
        f"{len(part)} frames: {100 * share:5.1f} % of those with something on them answered, "
        f"{late}{len(part) - len(done)} shed; median {of_all[0]:.2f}, 99 % {of_all[1]:.2f}, "
        f"most {of_all[2]:.2f} ms"
    )


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0] if __doc__ else "")
    parser.add_argument("--pipeline", default="locate")
    parser.add_argument("--deadline", type=float, default=0.0, help="in ms; 0 for none")
    parser.add_argument("--rate", type=float, default=500.0, help="frames a second")
    parser.add_argument("--touch", type=float, default=0.5, help="share of time with something on")
    parser.add_argument("--rounds", type=int, default=12, help="of two seconds")
    parser.add_argument("--beside", type=float, default=0.1, help="ms that a frame costs besides")
    parser.add_argument("--set", nargs="*", default=[], metavar="NODE.SETTING=true|false")
    asked = parser.parse_args()
    settings = {name: value == "true" for name, _, value in (s.partition("=") for s in asked.set)}
    warm_up()
    pipeline = tg.load(asked.pipeline).with_settings(settings)
    cells = [np.frombuffer(c, "<u2").reshape(16, 16) for c in pads(asked.touch, asked.rate)]
    frames = [tg.Frame.of(c.astype(float), 1.3, quantity="counts") for c in cells]
    found = answered(pipeline, frames, asked)
    for part in np.array_split(np.arange(len(found)), PARTS):
        print(line([found[i] for i in part], asked.deadline))


if __name__ == "__main__":
    main()
