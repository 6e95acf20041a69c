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
    if image.valid is not None:
        above[~image.valid] = 0.0
    return replace(frame, image=image.with_values(above))


class Taring:
    """Makes the baseline: the median of each cell over the frames that come next."""

    def __init__(self) -> None:
        self._readings: list[NDArray[Any]] = []
        self._since = time.monotonic()

    def add(self, frame: Frame) -> NDArray[np.float64] | None:
        """Take one more frame; return the baseline once there are enough."""
        readings = frame.image.filled(0.0)
        if self._readings and self._readings[0].shape != readings.shape:
            self._readings.clear()
        self._readings.append(readings)
        n = len(self._readings)
        late = time.monotonic() - self._since > LONGEST_S and n >= FEWEST
        if n < N_FRAMES and not late:
            return None
        return np.asarray(np.median(np.stack(self._readings), axis=0), dtype=np.float64)

    @property
    def n_frames(self) -> int:
        """How many frames were taken."""
        return len(self._readings)
