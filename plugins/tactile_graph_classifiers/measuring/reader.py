"""The readings that a pipeline makes of frames, in this process or in a worker."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable
from dataclasses import dataclass, field
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from tactile_graph import Image, Pipeline
from tactile_graph.compiled import warm_up
from tactile_graph.errors import DataError
from tactile_graph.inspect import Failed, Skipped
from tactile_graph.many import Portion
from tactile_graph.wires.frame import Frame
from tactile_graph_classifiers.database.instrument import Instrument
from tactile_graph_classifiers.database.relief_rows import Press
from tactile_graph_classifiers.measuring.measurements import Measurements
from tactile_graph_classifiers.measuring.shapes import true_shape

SQUARE = 0.02
"""By how much a cell's sides may differ where reliefs are learned, which are turned on the grid."""


class Given(NamedTuple):
    """What reads: a pipeline, its output that gives measurements, and the seed.

    With ``image``, the reference of what is measured, that is kept too.
    """

    pipeline: Pipeline
    output: str
    seed: int
    image: Any = None


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
        Frames in which a step failed, or of which workers died.
    presses : list of Press
        The images they were measured of, if they are to be kept.
    instruments : list of Instrument
        What the frames were recorded with, each once.
    by_law : bool
        Whether readings of volts, of what nobody knows, were made another quantity.
    """

    rows: list[Measurements] = field(default_factory=list)
    sources: list[str] = field(default_factory=list)
    shapes: set[str] = field(default_factory=set)
    left_out: Counter[str] = field(default_factory=Counter)
    n_failed: int = 0
    presses: list[Press] = field(default_factory=list)
    instruments: list[Instrument] = field(default_factory=list)
    by_law: bool = False

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
        self.presses += later.presses
        self.by_law |= later.by_law
        self.instruments = list(dict.fromkeys(self.instruments + later.instruments))


class Reader:
    """Makes readings of frames.

    Parameters
    ----------
    given : Given
    """

    def __init__(self, given: Given) -> None:
        warm_up()  # the same code for each frame, whoever reads it
        self._pipeline, self._output, self._image = given.pipeline, given.output, given.image
        self._runner = given.pipeline.runner([given.output], given.seed)

    def __call__(self, portion: Portion) -> Readings:
        """Return the readings of a portion: what a worker does."""
        return self.readings(portion.frames()[1])

    def readings(self, frames: Iterable[Frame]) -> Readings:
        """Return the readings of frames."""
        found = Readings()
        for frame in frames:
            result = self._runner(frame)
            outcome: Any = result.outcome(self._output)
            if isinstance(outcome, Failed | Skipped):
                found.left_out[_why(outcome.reason)] += 1
                found.n_failed += isinstance(outcome, Failed)
                continue
            if self._image is not None:
                found.presses.append(_press(result.outcome_at(self._image)))
            found.rows.append(getattr(outcome, "measurements", outcome))
            found.sources.append(_source(self._pipeline, frame))
            found.shapes.add(true_shape(frame))
            found.by_law |= is_by_law(frame, found.rows[-1].quantity)
            if (instrument := instrument_of(frame)) not in found.instruments:
                found.instruments.append(instrument)
        return found


def instrument_of(frame: Frame) -> Instrument:
    """Return what a frame was recorded with."""
    return Instrument.of(*frame.image.shape, *frame.image.pitch_cm)


def is_by_law(frame: Frame, quantity: str) -> bool:
    """Return whether a law made a frame's volts another quantity, of which nobody can be sure.

    Where the truth is known, the frame was simulated, or its pad is known too.
    """
    return frame.image.quantity == "volt" != quantity and bool(quantity) and frame.truth is None


def _press(image: Any) -> Press:
    """Return an image as a press to be kept.

    Raises
    ------
    DataError
        If it is no image, or its cells are not square.
    """
    if not isinstance(image, Image):
        raise DataError("presses", "what is measured is no image")
    along, down = image.pitch_cm
    if abs(along / down - 1.0) > SQUARE:
        raise DataError(
            "presses",
            f"reliefs are learned on square cells, and these are {along:g} x {down:g} cm",
        )
    return Press(pressed(image), along)


def pressed(image: Image) -> NDArray[np.float64]:
    """Return the values of an image, NaN where a cell is broken."""
    values = np.array(image.values, dtype=np.float64)
    if image.valid is not None:
        values[~image.valid] = np.nan
    return values


def _why(reason: str) -> str:
    """Return a reason without what was read in this one frame, so that like ones are counted."""
    condition, is_false, _ = reason.partition(" is false (")
    return condition + " is false" if is_false else reason


def _source(pipeline: Pipeline, frame: Frame) -> str:
    source = pipeline.source
    path = source.settings.get("path", source.name) if source is not None else ""
    where = ", ".join(map(str, path)) if isinstance(path, list) else str(path)
    return " ".join(t for t in (where, frame.label, f"frame {frame.index}") if t)
