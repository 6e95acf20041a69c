"""How a load is spread, as numbers that no move and no turn changes."""

from __future__ import annotations

import math
from functools import lru_cache

import numpy as np
from numpy.typing import NDArray
from scipy import fft

from tactile_graph_classifiers.measuring.outline import MOMENTS, bordered, moments, quantiles

Array = NDArray[np.float64]
QUANTILES = (5, 10, 25, 50, 75, 90, 95)
REACHES = (10, 25, 50, 75, 90, 97)
LAGS = (2, 3, 4, 6, 8, 10)
BEYOND = LAGS[-1] + 1
"""One bin for all larger ones: cells far from square would ask for endless ones."""
NAMES = (
    *(f"load_quantile_{q}" for q in QUANTILES), "peak_over_mean", "bearing_cm2",
    "load_gyration_cm", *(f"load_reach_{q}" for q in REACHES),
    *(f"load_{name}" for name in MOMENTS), "steepness_cm", "roughness",
    *(f"correlation_{lag}" for lag in LAGS),
)  # fmt: skip


def spread_numbers(
    load: Array, on: NDArray[np.bool_], pitch_cm: tuple[float, float]
) -> list[float]:
    """Return the numbers of ``NAMES`` for a load on a footprint.

    Parameters
    ----------
    load : ndarray, shape (rows, columns)
        At least 0, and 0 beside the footprint; of a sum above 0.
    on : ndarray of bool, shape (rows, columns)
        The footprint.
    pitch_cm : (float, float)
        Along x and along y.

    Returns
    -------
    list of float
        Quantiles and peak over the mean reading; the area that would bear the load evenly, (sum
        of readings)^2 over sum of squares; radius of gyration; radii within which a share of the
        load lies and magnitudes of complex moments, over powers of that radius; sum of changes
        from cell to cell over the sum, and the same of squares; correlation of the load with
        itself moved by so many cells in any direction.
    """
    px, py = pitch_cm
    y, x = np.nonzero(on)
    readings = load[on]
    total, mean = float(readings.sum()), float(readings.mean())
    shares = readings / total
    z = x * px + 1j * (y * py)
    z -= (shares * z).sum()
    far = np.abs(z)
    gyration = math.sqrt(float(shares @ (far * far)) + (px * px + py * py) / 12.0)
    levels = quantiles(readings, [0.01 * q for q in QUANTILES]) / mean
    order = np.argsort(far, kind="stable")
    within = np.cumsum(shares[order])
    reaches = np.interp([0.01 * q for q in REACHES], within, far[order]) / gyration
    squares = float(readings @ readings)
    padded = bordered(load)
    along_x, along_y = np.diff(padded, axis=1), np.diff(padded, axis=0)
    changes = float(np.abs(along_x).sum()) * py + float(np.abs(along_y).sum()) * px
    squared = float((along_x**2).sum() + (along_y**2).sum())
    return [
        *levels.tolist(), float(readings.max()) / mean, total * total / squares * px * py,
        gyration, *reaches.tolist(), *moments(z / gyration, shares),
        changes / total, squared / squares, *_correlations(load, px, py),
    ]  # fmt: skip


def _correlations(load: Array, px: float, py: float) -> list[float]:
    """Return the autocorrelation at each lag of ``LAGS``, of all directions; 0 where none is."""
    shape = tuple(fft.next_fast_len(2 * n, real=True) for n in load.shape)
    power = np.abs(fft.rfft2(load, shape)) ** 2
    correlation = fft.irfft2(power, shape)
    rings, n = _rings(shape, px, py)
    sums = np.bincount(rings, correlation.ravel(), minlength=BEYOND)
    return [float(sums[lag] / max(n[lag], 1) / sums[0]) for lag in LAGS]


@lru_cache(maxsize=16)
def _rings(shape: tuple[int, ...], px: float, py: float) -> tuple[NDArray[np.intp], list[int]]:
    """Return by how many cells each correlation's images are moved, and how many so far."""
    far_y, far_x = (np.minimum(np.arange(n), n - np.arange(n)) for n in shape)
    cell = min(px, py)
    far = np.hypot(far_y[:, None] * (py / cell), far_x * (px / cell))
    rings = np.minimum(far, BEYOND).astype(np.intp).ravel()
    return rings, np.bincount(rings, minlength=BEYOND).tolist()
