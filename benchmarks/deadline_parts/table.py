"""What each choice of a ladder takes, and answers, for each frame of a stream."""

from __future__ import annotations

import gc
import time
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from tactile_graph import Frame, Pipeline
from tactile_graph.compiled import warm_up
from tactile_graph.live import Recorded

ANSWER = "circle"
Array = NDArray[np.float64]


class Table(NamedTuple):
    """All that a schedule can come to.

    Attributes
    ----------
    choices : tuple of str
        Names, from the best to the cheapest.
    frames : list of Frame
    took_ns : ndarray, shape (choices, frames)
        Processor time where the frame begins with that choice; where it has no value (an empty
        pad), with those after it.
    error_cm : ndarray, shape (choices, frames)
        Of the centre; NaN on an empty pad.
    answers : list of list
        By choice and frame; None where it has no value.
    """

    choices: tuple[str, ...]
    frames: list[Frame]
    took_ns: Array
    error_cm: Array
    answers: list[list[Any]]

    def without(self, choice: str) -> Table:
        """Return the table of the ladder that has not this choice."""
        kept = [k for k, name in enumerate(self.choices) if name != choice]
        return self._replace(
            choices=tuple(self.choices[k] for k in kept),
            took_ns=self.took_ns[kept],
            error_cm=self.error_cm[kept],
            answers=[self.answers[k] for k in kept],
        )

    @property
    def loaded(self) -> NDArray[np.bool_]:
        """Which frames have something to find, shape (frames,)."""
        return np.array([bool(f.truth) for f in self.frames])


def choices_of(pipeline: Pipeline) -> tuple[str, ...]:
    """Return the names of a ladder's choices, from the best to the cheapest."""
    return tuple(ref.node for ref in pipeline.nodes[ANSWER].choices)


def measured(pipeline: Pipeline, frames: list[Frame], rounds: int = 2) -> Table:
    """Return what each choice takes, the least of some rounds: other programs then cost least."""
    choices = choices_of(pipeline)
    took = np.full((len(choices), len(frames)), np.inf)
    error = np.full((len(choices), len(frames)), np.nan)
    answers: list[list[Any]] = []
    for k in range(len(choices)):
        runner = pipeline.runner(decider=Recorded(choices[:k]))
        for frame in frames[:300]:
            runner(frame)
        warm_up()
        for _ in range(rounds):
            found = []
            gc.collect()
            gc.freeze()  # as a live run does: a collection that looks at everything takes 50 ms
            for i, frame in enumerate(frames):
                start = time.thread_time_ns()
                result = runner(frame)
                took[k, i] = min(took[k, i], time.thread_time_ns() - start)
                found.append(result.get(ANSWER))
        answers.append(found)
        error[k] = [_error(a, f) for a, f in zip(answers[k], frames, strict=True)]
    return Table(choices, frames, took, error, answers)


def _error(answer: Any, frame: Frame) -> float:
    if answer is None or not frame.truth:
        return float("nan")
    true: Any = frame.truth[0].shape
    return float(np.hypot(answer.x_cm - true.x_cm, answer.y_cm - true.y_cm))
