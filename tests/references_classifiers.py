"""What kernels of tactile_graph_classifiers are held against: the same answers, vectorised."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from tactile_graph_classifiers.distances.nearest import Two

Array = NDArray[np.float64]


def two_smallest(squares: Array) -> Two:
    """Return where the two smallest values stand (-1 for a missing second), and these."""
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
    """Return the squared distance to each object, shape (K,)."""
    off = reading - means
    return np.asarray(np.einsum("ki,kij,kj->k", off, precisions, off))


def nearest(reading: Array, means: Array, precisions: Array) -> Two:
    return two_smallest(quadratic_distances(reading, means, precisions))


def normalised_distances(reading: Array, means: Array, scales: Array, weights: Array) -> Array:
    """Return the squared distance to each object, each feature's share over its largest one."""
    parts = ((reading - means) / scales) ** 2
    largest = parts.max(axis=0)
    largest[largest == 0.0] = 1.0  # every object has just this value: no share at all
    return np.asarray((parts / largest) @ weights)


def nearest_normalised(reading: Array, means: Array, scales: Array, weights: Array) -> Two:
    return two_smallest(normalised_distances(reading, means, scales, weights))
