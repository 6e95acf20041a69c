"""``PadReading``: how a pad reads what presses on it, as learned from presses."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from tactile_graph_classifiers.reliefs.kernels import POINTS
from tactile_graph_classifiers.reliefs.presses import Presses

Array = NDArray[np.float64]
VARIANCES = (0.0015**2, 0.1**2, 0.02**2)
"""To begin with."""
LEAN_VARIANCE = 0.06**2


class Law(NamedTuple):
    """What a pad reads of a load of full scale 1.

    Parameters
    ----------
    blur_cells : float
        Deviation of the bell over which a load spreads.
    power : float
        Readings go with the load to this power.
    threshold : float
        Load below which nothing is read.
    """

    blur_cells: float = 0.5
    power: float = 1.0
    threshold: float = 0.008


LEAST, MOST = Law(0.15, 0.4, 0.0005), Law(1.6, 1.6, 0.1)
"""Bounds of what is looked for."""


@dataclass(frozen=True, eq=False)
class PadReading:
    """How a pad reads.

    Parameters
    ----------
    law : Law
    gains : ndarray, shape (rows, columns)
        Of the elements.
    doubts : ndarray, shape (rows, columns)
        Variance of the logarithm of what a reading should be for what is not known of its gain.
    top : float
        Reading from which on it may have been more.
    variances : ndarray, shape (3,)
        Of a still reading, and what is added by its square and by the square of its slope.
    lean_variance : float
        Of the lean of presses, along each axis.
    """

    law: Law
    gains: Array
    doubts: Array
    top: float
    variances: Array
    lean_variance: float = LEAN_VARIANCE

    @property
    def taps(self) -> Array:
        """How a cell takes the points along an axis: their mean, blurred."""
        blur = self.law.blur_cells * POINTS
        reach = math.ceil(3.0 * blur)
        bell = np.exp(-0.5 * (np.arange(-reach, reach + 1) / blur) ** 2)
        return np.convolve(bell / bell.sum(), np.full(POINTS, 1.0 / POINTS))

    def numbers(self, soft: float) -> Array:
        """Return what the kernels take, ``soft`` the depth over which touching begins."""
        return np.array([soft, self.law.power, self.law.threshold, self.top, self.lean_variance])

    def parts(self, values: Array) -> Array:
        """Return what each of the variances is multiplied by, shape (3, n, rows, columns)."""
        down, along = np.zeros_like(values), np.zeros_like(values)
        down[:, 1:-1] = (values[:, 2:] - values[:, :-2]) / 2.0
        along[:, :, 1:-1] = (values[:, :, 2:] - values[:, :, :-2]) / 2.0
        return np.array([np.ones_like(values), np.maximum(values, 0.0) ** 2, down**2 + along**2])

    def weights(self, presses: Presses) -> Array:
        """Return one over the variance of each reading, 0 where there is none."""
        parts = self.parts(presses.values)
        variances = np.tensordot(self.variances, parts, 1) + self.doubts * parts[1]
        return np.where(presses.good, 1.0 / variances, 0.0)
