"""The ladder on the real clock: frames come by a thread of their own, a thousand a second."""

from __future__ import annotations

import sys

import numpy as np

from deadline_parts.table import ANSWER, choices_of
from tactile_graph import Frame, Pipeline
from tactile_graph.live import LiveRun, Recorded, paced

SWITCH_S = 1e-4
"""How long Python lets the engine's thread keep the reader's waiting, between two steps."""


def real_run(pipeline: Pipeline, frames: list[Frame], period_ns: int, deadline_ns: int) -> None:
    """Print what came of a run, and whether its decisions give the same answers again."""
    choices = choices_of(pipeline)
    for k in range(len(choices)):  # what there is to compile is compiled
        runner = pipeline.runner(decider=Recorded(choices[:k]))
        for frame in frames[:300]:
            runner(frame)
    sys.setswitchinterval(SWITCH_S)
    run = LiveRun(pipeline, paced(frames, 1e9 / period_ns), deadline_us=deadline_ns / 1e3)
    lives = list(run)
    latency_us = np.array([live.latency_us for live in lives])
    late = np.mean(latency_us > deadline_ns / 1e3)
    shares = np.bincount([len(live.decisions) for live in lives], minlength=len(choices)) / len(
        lives
    )
    median, p99, p999, most = np.percentile(latency_us, [50, 99, 99.9, 100])
    print(
        f"deadline {deadline_ns / 1e6:g} ms, real clock: {100 * (1 - late):.2f} % of {len(lives)} "
        f"frames on time, {run.n_shed} shed; latency median {median:.0f} us, 99 % {p99:.0f}, "
        f"99.9 % {p999:.0f}, most {most:.0f}; {', '.join(choices)} "
        + ", ".join(f"{100 * share:.1f} %" for share in shares)
    )
    recorded = Recorded()
    again = pipeline.runner(decider=recorded)
    differ = 0
    for live in lives:
        recorded.skipped = live.decisions
        differ += repr(again(live.result.frame).outcomes) != repr(live.result.outcomes)
    print(f"  replayed: {differ} of {len(lives)} answers differ ({ANSWER} and every node)")
