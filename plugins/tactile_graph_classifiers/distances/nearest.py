"""The kernels that find the two nearest of all known objects."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from tactile_graph.compiled import compiled_later

Array = NDArray[np.float64]
Two = tuple[int, int, float, float]


@compiled_later
def nearest(reading: Any, means: Any, precisions: Any) -> Any:
    """Return the two objects of least squared distance, and these distances.

    Parameters
    ----------
    reading : ndarray, shape (F,)
    means : ndarray, shape (K, F)
    precisions : ndarray, shape (K, F, F)
    """
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


@compiled_later
def nearest_normalised(reading: Any, means: Any, scales: Any, weights: Any) -> Any:
    """Return the two objects of least normalised squared distance, and these distances.

    Each feature's share of a distance is taken over its largest one.

    Parameters
    ----------
    reading : ndarray, shape (F,)
    means, scales : ndarray, shape (K, F)
        A feature's share is that of ((reading - mean) / scale)^2.
    weights : ndarray, shape (F,)
    """
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
