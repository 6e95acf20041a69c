"""Step ``tare``: readings above what the empty pad reads, followed as that drifts."""

from __future__ import annotations

import math
from typing import Annotated, Any

import numpy as np
from annotated_types import Ge, Gt, Le
from numpy.typing import NDArray

from tactile_graph.errors import DataError, Skip
from tactile_graph.steps.injected import TimeGap
from tactile_graph.steps.rules import Grid, Quantity
from tactile_graph.wires import Image
from tactile_graph_filters.morphology.elements import parse_element
from tactile_graph_filters.morphology.erosion import make_plan, sweep
from tactile_graph_filters.nan import finite, refuse_nan

NOISES = 25.0
"""From so many standard deviations of the empty pad's noise on a cell is touched."""
STEPS = 2.0
"""And no lower than from so many of the least steps that readings of the empty pad differ by."""
OF_ONE_FRAME = 25.0
"""From which reading on a cell is touched where a single frame, which shows no noise, was taken."""
TINY = float(np.finfo(np.float64).tiny)


class Tare:
    """Return the readings above the baseline that the empty pad showed.

    Parameters
    ----------
    n_frames : int
        From how many frames at the start, taken of the empty pad, the baseline is made: the
        median of each cell's valid readings. All of them but the last are skipped. A cell without
        one among them stays invalid.
    drift_s : float, optional
        Time in which the baseline of an untouched cell comes to 63 % of the way to its reading;
        without it the baseline stays.
    touched : float, optional
        From which reading above the baseline on, in the image's unit, a cell is touched. The
        baseline of touched cells and of their eight neighbours is frozen, so that a resting
        object is not eaten by it. If not given, 25 standard deviations of the noise in those
        first frames, and no less than two steps of readings that are whole numbers of a step;
        25 where ``n_frames`` is 1, which shows no noise.
    frame_s : float
        What a frame lasts where the source keeps no time.
    clip : bool
        Whether readings below the baseline are returned as 0.

    Notes
    -----
    State: the baseline. A skipped step keeps it, and drifts by the true time when it next runs.
    A step that wants the first frames itself, such as `find_bad`, stands before this one.
    """

    def __init__(
        self,
        *,
        n_frames: Annotated[int, Ge(1), Le(1000)] = 30,
        drift_s: Annotated[float, Gt(0)] | None = None,
        touched: Annotated[float, Gt(0)] | None = None,
        frame_s: Annotated[float, Gt(0)] = 0.05,
        clip: bool = False,
    ) -> None:
        self._n_frames, self._drift_s, self._frame_s = n_frames, drift_s, frame_s
        self._touched, self._clip = touched, clip
        self._known: NDArray[np.bool_] | None = None
        self._empty: list[NDArray[Any]] = []
        self._baseline: NDArray[np.float64] = np.zeros((0, 0))
        self._made = False
        self._around = make_plan(parse_element("square3"), dilate=True)

    def __call__(
        self, image: Image, *, gap: TimeGap = None
    ) -> Annotated[Image, Quantity.like("image"), Grid.like("image")]:
        """Return the image less the baseline.

        Raises
        ------
        Skip
            While the first frames come in.
        DataError
            If a valid cell holds NaN or infinity, or the shape changed since the first frame.
        """
        if not finite(image.values):
            refuse_nan(image, infinite=True)
        readings = image.filled(math.nan)
        known = self._empty[0] if self._empty else self._baseline
        if known.size and known.shape != image.shape:
            raise DataError(
                "image",
                f"must keep its shape while it is tared, got {image.shape} after {known.shape}",
            )
        if not self._made:
            self._learn(readings)
        elif self._drift_s is not None:
            self._drift(readings, gap)
        above = readings - self._baseline
        if self._clip:
            np.maximum(above, 0.0, out=above)
        valid = image.valid
        if self._known is not None:
            valid = self._known if valid is None else self._known & valid
        if valid is not None:
            above[~valid] = 0.0
        return image.with_values(above, valid=valid)

    def _learn(self, readings: NDArray[Any]) -> None:
        self._empty.append(readings)
        n = len(self._empty)
        if n < self._n_frames:
            raise Skip(f"warming up: frame {n} of {self._n_frames} of the empty pad")
        frames = np.stack(self._empty)
        known = ~np.isnan(frames).all(axis=0)
        self._known = None if known.all() else known
        frames = np.where(known, frames, 0.0)
        halves = 0.5 * frames  # the sum of two readings may overflow
        self._baseline = 2.0 * np.nanmedian(halves, axis=0)
        if self._drift_s is not None and self._touched is None:
            self._touched = _touched(frames[:, known])
        self._made, self._empty = True, []

    def _drift(self, readings: NDArray[np.float64], gap: float | None) -> None:
        assert self._drift_s is not None
        assert self._touched is not None
        above = readings - self._baseline
        above[np.isnan(above)] = 0.0  # what is missing tells of neither touch nor drift
        if self._known is not None:
            above[~self._known] = 0.0
        frozen = np.empty(above.shape, np.bool_)
        sweep(above >= self._touched, self._around, frozen)
        share = -math.expm1(-max(self._frame_s if gap is None else gap, 0.0) / self._drift_s)
        self._baseline = self._baseline + np.where(frozen, 0.0, share * above)


def _touched(frames: NDArray[Any]) -> float:
    """Return from which reading above the baseline on a cell is touched.

    Parameters
    ----------
    frames : ndarray, shape (n_frames, n_cells)
        The empty pad's readings, in any unit; NaN where there is none, in no cell everywhere.
    """
    if len(frames) == 1:
        return OF_ONE_FRAME
    with np.errstate(over="ignore"):  # of cells that change: many pads read 0 below some load
        noise = np.nanstd(frames, axis=0)[np.nanmin(frames, axis=0) < np.nanmax(frames, axis=0)]
        steps = np.diff(np.unique(frames[~np.isnan(frames)]))
    level = NOISES * float(np.median(noise)) if noise.size else 0.0
    return max(level, STEPS * float(steps.min(initial=math.inf)) if steps.size else 0.0, TINY)
