"""The outline of a footprint as numbers that no move and no turn changes."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy import ndimage

from tactile_graph_classifiers.measuring.hull import hull_corners

Array = NDArray[np.float64]
DIRECTIONS = np.exp(1j * np.linspace(0.0, math.pi, 36, endpoint=False))
ORDERS = ((2, 0), (3, 0), (2, 1), (4, 0), (3, 1), (2, 2), (5, 0), (6, 0))
"""Powers of z and of its conjugate; their difference says which turns leave a shape as it is."""
_POWERS, _OF_CONJUGATE = np.array(ORDERS).T
ROUNDING = 1e-12
"""Of a moment that is 0: its logarithm must not pass for a measurement."""
MOMENTS = tuple(f"moment_{p}{q}" for p, q in ORDERS)
REACHES = (10, 50, 90)
NAMES = (
    "solidity", "hull_cm2", "length_cm", "breadth_cm", "parts", "largest_part", "filled_share",
    "inscribed_cm", "thickness_cm", "gyration_cm", *(f"reach_{q}" for q in REACHES), *MOMENTS,
)  # fmt: skip


def outline_numbers(on: NDArray[np.bool_], pitch_cm: tuple[float, float]) -> list[float]:
    """Return the numbers of ``NAMES`` for a footprint.

    Parameters
    ----------
    on : ndarray of bool, shape (rows, columns)
        With at least one cell on.
    pitch_cm : (float, float)
        Along x and along y.

    Returns
    -------
    list of float
        Share of its convex hull that the footprint fills, and the hull's area; largest and least
        extent; number of parts, joined by sides or corners, and the largest one's share of the
        area; share left of the area when holes are filled; largest and mean distance of its cells
        from its boundary; radius of gyration; quantiles of the distance from the centre, and
        magnitudes of complex moments, both over powers of that radius.
    """
    px, py = pitch_cm
    y, x = np.nonzero(on)
    z = x * px + 1j * (y * py)
    area, cell = z.size * px * py, (px * px + py * py) / 12.0
    wider = bordered(on)
    hull = np.asarray(hull_corners.call(wider) @ (px, 1j * py), np.complex128)
    extents = np.ptp((hull[:, None] * DIRECTIONS.conj()).real, axis=0)
    hull_cm2 = _area(hull)
    parts, n_parts = ndimage.label(on, np.ones((3, 3)))
    inside = ndimage.distance_transform_edt(wider, sampling=(py, px))[1:-1, 1:-1][on]
    z -= z.mean()
    far = np.abs(z)
    gyration = math.sqrt(float((far * far).mean()) + cell)
    filled = np.count_nonzero(ndimage.label(~wider)[0] != 1)  # the first is what lies outside
    reaches = quantiles(far, [0.01 * q for q in REACHES]) / gyration
    return [
        area / hull_cm2, hull_cm2, float(extents.max()), float(extents.min()),
        float(n_parts), float(np.bincount(parts[on]).max()) / z.size, z.size / filled,
        float(inside.max()), float(inside.mean()), gyration,
        *reaches.tolist(), *moments(z / gyration, np.full(z.size, 1.0 / z.size)),
    ]  # fmt: skip


def moments(z: NDArray[Any], shares: Array) -> list[float]:
    """Return the magnitudes of complex moments of points about 0, in the order of ``ORDERS``.

    Parameters
    ----------
    z : ndarray of complex, shape (n,)
    shares : ndarray, shape (n,)
        Weights of sum 1.

    Notes
    -----
    J. Flusser, On the independence of rotation moment invariants, 2000,
    doi:10.1016/S0031-3203(99)00127-2: a turn changes the phase alone.
    """
    weighted, conjugate = np.empty((7, z.size), z.dtype), np.ones((3, z.size), z.dtype)
    weighted[0] = shares
    for p in range(6):
        np.multiply(weighted[p], z, out=weighted[p + 1])
    conjugate[1] = z.conj()
    conjugate[2] = conjugate[1] * conjugate[1]
    sizes = np.abs((weighted[_POWERS] * conjugate[_OF_CONJUGATE]).sum(axis=1)).tolist()
    return [size if size > ROUNDING else 0.0 for size in sizes]


def quantiles(values: Array, shares: Sequence[float]) -> Array:
    """Return what `numpy.quantile` does, in a fraction of its time where values are few.

    Parameters
    ----------
    values : ndarray, shape (n,)
        Finite; at least one.
    shares : sequence of float
        From 0 to 1.
    """
    ordered, at = np.sort(values), np.multiply(shares, values.size - 1)
    before = at.astype(np.intp)
    low, high = ordered[before], ordered[np.minimum(before + 1, values.size - 1)]
    part, step = at - before, high - low
    return np.where(part < 0.5, low + step * part, high - step * (1.0 - part))


def bordered(values: NDArray[Any]) -> NDArray[Any]:
    """Return an image with a border of zeros, one cell wide."""
    out = np.zeros((values.shape[0] + 2, values.shape[1] + 2), values.dtype)
    out[1:-1, 1:-1] = values
    return out


def _area(corners: NDArray[np.complex128]) -> float:
    following = np.concatenate([corners[1:], corners[:1]])
    return 0.5 * abs(float((corners.conj() * following).imag.sum()))
