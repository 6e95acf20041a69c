"""Run the last few pipelines themselves, in turn, and time them as wholes."""

from __future__ import annotations

import time
from collections.abc import Iterator, Mapping, Sequence
from functools import partial

import numpy as np

from tactile_graph import Pipeline, Result
from tactile_graph.compiled import once_made, warm_up
from tactile_graph.inspect import Runner
from tactile_graph.wires.frame import Frame
from tactile_graph_tune.table.kinds import Reals
from tactile_graph_tune.table.losses import LossOf
from tactile_graph_tune.table.record import WARM_FRAMES, Judged

STRETCH = 20
"""Frames that a pipeline has to itself."""


def rerun(
    pipelines: Mapping[str, Pipeline],
    frames: Sequence[Frame],
    judged: Judged,
    rounds: int,
    seed: int,
) -> dict[str, tuple[Reals, Reals]]:
    """Return for each pipeline the time and the error of each frame, shapes (n_frames,).

    Parameters
    ----------
    pipelines : mapping of str to Pipeline
    frames : sequence of Frame
    judged : Judged
    rounds : int
        In each every pipeline has its turn with each stretch of `STRETCH` frames, so that a machine
        that grows slower does so for all of them; times are medians over them, processor
        time of whole frames: what lies between the steps counts too.
    seed : int
    """
    warm_up()  # where workers made the table, nothing has done so in this process
    runners = {k: p.runner(seed=seed) for k, p in pipelines.items()}
    losses = {
        k: LossOf(p, judged.answer, judged.quantity, judged.price) for k, p in pipelines.items()
    }
    found = {k: np.zeros(len(frames)) for k in pipelines}
    taken = {k: np.empty((rounds, len(frames))) for k in pipelines}
    for runner in runners.values():
        for frame in frames[:WARM_FRAMES]:
            runner(frame)
    for k, start, label in _turns(rounds, len(frames), list(pipelines)):
        runner = runners[label]
        repeatable = runner.plan.repeatable  # what draws at random must not draw more often
        for i in range(start, min(start + STRETCH, len(frames))):
            frame = frames[i]
            run = partial(_timed, runner, frame)
            result, taken[label][k, i] = once_made(run) if repeatable else run()
            if k == 0:
                found[label][i] = losses[label](frame, result.outcome_at)
    # What cannot be held against the truth of a frame is no answer to it.
    lost = {k: np.where(np.isnan(x), judged.price, x) for k, x in found.items()}
    return {k: (1e6 * np.median(taken[k], axis=0), lost[k]) for k in pipelines}


def _timed(runner: Runner[Result], frame: Frame) -> tuple[Result, float]:
    """Return a frame's result, and the processor time in seconds that it took."""
    runner.forget()
    begun = time.process_time()
    return runner(frame), time.process_time() - begun


def _turns(rounds: int, n: int, labels: list[str]) -> Iterator[tuple[int, int, str]]:
    """Yield the number of a round, the first frame of a stretch and whose turn it is."""
    for k in range(rounds):
        for turn, start in enumerate(range(0, n, STRETCH), k):
            first = turn % len(labels)
            yield from ((k, start, label) for label in labels[first:] + labels[:first])
