"""The kernels that find the two nearest of all known objects."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from tactile_graph.compiled import compiled_twin_of

Array = NDArray[np.float64]
Two = tuple[int, int, float, float]


def two_smallest(squares: Array) -> Two:
    """Return where the two smallest values stand (-1 for a missing second), and these.

    Parameters
    ----------
    squares : ndarray, shape (K,)
        Of equal ones the first counts as smaller.
    """
    best = int(squares.argmin())
    if squares.size == 1:
        return best, -1, float(squares[best]), np.inf
    others = squares.copy()
    others[best] = np.inf
    second = int(others.argmin())
    if second == best:  # all others are infinite too
        second = 0 if best else 1
    return best, second, float(squares[best]), float(squares[second])


def quadratic_distances(reading: Array, means: Array, precisions: Array) -> Array:
    """Return the squared distance to each object, shape (K,).

    Parameters
    ----------
    reading : ndarray, shape (F,)
    means : ndarray, shape (K, F)
    precisions : ndarray, shape (K, F, F)
    """
    off = reading - means
    return np.asarray(np.einsum("ki,kij,kj->k", off, precisions, off))


def _nearest_plain(reading: Array, means: Array, precisions: Array) -> Two:
    return two_smallest(quadratic_distances(reading, means, precisions))


@compiled_twin_of(_nearest_plain)
def nearest(reading: Any, means: Any, precisions: Any) -> Any:
    """Return the two objects of least squared distance, and these distances."""
    n_objects, n_features = means.shape
    best = second = -1
    least = next_least = np.inf
    for k in range(n_objects):
        square = 0.0
        for i in range(n_features):
            row = 0.0
            for j in range(n_features):
                row += precisions[k, i, j] * (reading[j] - means[k, j])
            square += row * (reading[i] - means[k, i])
        if best < 0 or square < least:
            second, next_least = best, least
            best, least = k, square
        elif second < 0 or square < next_least:
            second, next_least = k, square
    return best, second, least, next_least


def normalised_distances(reading: Array, means: Array, scales: Array, weights: Array) -> Array:
    """Return the squared distance to each object, each feature's share over its largest one.

    Parameters
    ----------
    reading : ndarray, shape (F,)
    means, scales : ndarray, shape (K, F)
        A feature's share is that of ((reading - mean) / scale)^2.
    weights : ndarray, shape (F,)

    Returns
    -------
    ndarray, shape (K,)
    """
    parts = ((reading - means) / scales) ** 2
    largest = parts.max(axis=0)
    largest[largest == 0.0] = 1.0  # every object has just this value: no share at all
    return np.asarray((parts / largest) @ weights)


def _nearest_normalised_plain(reading: Array, means: Array, scales: Array, weights: Array) -> Two:
    return two_smallest(normalised_distances(reading, means, scales, weights))


@compiled_twin_of(_nearest_normalised_plain)
def nearest_normalised(reading: Any, means: Any, scales: Any, weights: Any) -> Any:
    """Return the two objects of least normalised squared distance, and these distances."""
    n_objects, n_features = means.shape
    factors = np.empty(n_features)
    for i in range(n_features):
        largest = 0.0
        for k in range(n_objects):
            off = (reading[i] - means[k, i]) / scales[k, i]
            largest = max(largest, off * off)
        factors[i] = weights[i] / largest if largest > 0.0 else weights[i]
    best = second = -1
    least = next_least = np.inf
    for k in range(n_objects):
        square = 0.0
        for i in range(n_features):
            off = (reading[i] - means[k, i]) / scales[k, i]
            square += off * off * factors[i]
        if best < 0 or square < least:
            second, next_least = best, least
            best, least = k, square
        elif second < 0 or square < next_least:
            second, next_least = k, square
    return best, second, least, next_least
