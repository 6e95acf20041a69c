"""What the empty pad reads, and frames less that."""

from __future__ import annotations

import time
from dataclasses import replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from tactile_graph import Frame

N_FRAMES = 30
FEWEST = 3
LONGEST_S = 1.0
"""A slow pad's baseline is made of what comes in so long, of `FEWEST` frames at least."""


def less(frame: Frame, baseline: NDArray[np.float64] | None) -> Frame:
    """Return a frame less the baseline; itself where there is none of its shape."""
    image = frame.image
    if baseline is None or baseline.shape != image.shape:
        return frame
    above = image.values - baseline
    known = ~np.isnan(baseline)
    valid = image.valid
    if not known.all():
        valid = known if valid is None else known & valid
    if valid is not None:
        above[~valid] = 0.0
    return replace(frame, image=image.with_values(above, valid=valid))


class Taring:
    """Makes the baseline: the median of each cell's valid readings over the frames to come.

    It is NaN where a cell has none.
    """

    def __init__(self) -> None:
        self._readings: list[NDArray[Any]] = []
        self._since = 0.0

    def add(self, frame: Frame) -> NDArray[np.float64] | None:
        """Take one more frame; return the baseline once there are enough."""
        readings = frame.image.filled(np.nan)
        if self._readings and self._readings[0].shape != readings.shape:
            self._readings.clear()
        if not self._readings:  # it may have been asked for long before a frame comes
            self._since = time.perf_counter()
        self._readings.append(readings)
        n = len(self._readings)
        late = time.perf_counter() - self._since > LONGEST_S and n >= FEWEST
        if n < N_FRAMES and not late:
            return None
        frames = np.stack(self._readings)
        known = ~np.isnan(frames).all(axis=0)
        baseline = np.nanmedian(np.where(known, frames, 0.0), axis=0)
        return np.where(known, baseline, np.nan)

    @property
    def n_frames(self) -> int:
        """How many frames were taken."""
        return len(self._readings)
