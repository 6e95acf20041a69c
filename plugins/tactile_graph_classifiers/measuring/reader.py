"""The readings that a pipeline makes of frames, in this process or in a worker."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable
from dataclasses import dataclass, field
from typing import Any, NamedTuple

from tactile_graph import Pipeline
from tactile_graph.compiled import warm_up
from tactile_graph.inspect import Failed, Skipped
from tactile_graph.many import Portion
from tactile_graph.wires.frame import Frame
from tactile_graph_classifiers.measuring.measurements import Measurements
from tactile_graph_classifiers.measuring.shapes import true_shape


class Given(NamedTuple):
    """What reads: a pipeline, its output that gives measurements, and the seed."""

    pipeline: Pipeline
    output: str
    seed: int


@dataclass
class Readings:
    """What frames gave.

    Attributes
    ----------
    rows : list of Measurements
    sources : list of str
        Where each is of, in words.
    shapes : set of str
        What the truth says lay there, empty where it says nothing.
    left_out : Counter
        By reason, how many frames gave no reading.
    n_failed : int
        How many of these because a step failed.
    """

    rows: list[Measurements] = field(default_factory=list)
    sources: list[str] = field(default_factory=list)
    shapes: set[str] = field(default_factory=set)
    left_out: Counter[str] = field(default_factory=Counter)
    n_failed: int = 0

    @property
    def shape(self) -> str:
        """The shape that the truth tells of all; empty where it tells several or none."""
        return next(iter(self.shapes)) if len(self.shapes) == 1 else ""

    def join(self, later: Readings) -> None:
        """Take in what later frames gave."""
        self.rows += later.rows
        self.sources += later.sources
        self.shapes |= later.shapes
        self.left_out.update(later.left_out)
        self.n_failed += later.n_failed


class Reader:
    """Makes readings of frames.

    Parameters
    ----------
    given : Given
    """

    def __init__(self, given: Given) -> None:
        warm_up()  # the same code for each frame, whoever reads it
        self._pipeline, self._output = given.pipeline, given.output
        self._runner = given.pipeline.runner([given.output], given.seed)

    def __call__(self, portion: Portion) -> Readings:
        """Return the readings of a portion: what a worker does."""
        return self.readings(portion.frames()[1])

    def readings(self, frames: Iterable[Frame]) -> Readings:
        """Return the readings of frames."""
        found = Readings()
        for frame in frames:
            outcome: Any = self._runner(frame).outcome(self._output)
            if isinstance(outcome, Failed | Skipped):
                found.left_out[_why(outcome.reason)] += 1
                found.n_failed += isinstance(outcome, Failed)
                continue
            found.rows.append(getattr(outcome, "measurements", outcome))
            found.sources.append(_source(self._pipeline, frame))
            found.shapes.add(true_shape(frame))
        return found


def _why(reason: str) -> str:
    """Return a reason without what was read in this one frame, so that like ones are counted."""
    condition, is_false, _ = reason.partition(" is false (")
    return condition + " is false" if is_false else reason


def _source(pipeline: Pipeline, frame: Frame) -> str:
    source = pipeline.source
    path = source.settings.get("path", source.name) if source is not None else ""
    where = ", ".join(map(str, path)) if isinstance(path, list) else str(path)
    return " ".join(t for t in (where, frame.label, f"frame {frame.index}") if t)
