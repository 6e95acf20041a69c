"""Small kernels to compile, in a file of their own so that machine code can be kept on disk."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from tactile_graph.compiled import compiled_as_is, compiled_twin_of

MOST = 100


def repeated(x: float, n: int) -> float:
    """Return x times n."""
    return x * n


@compiled_twin_of(repeated)
def total(x: float, n: int) -> float:
    result = 0.0
    for _ in range(n):
        result += x
    return result


@compiled_as_is
def doubled(values: NDArray[np.float64], i: int) -> float:
    """Return twice a value; the values may not be too many."""
    if i > MOST:
        raise ValueError("too many values")
    return 2.0 * values[i]


@compiled_as_is
def summed(values: NDArray[np.float64]) -> float:
    """Return the median and twice the sum."""
    result = np.median(values)
    for i in range(len(values)):
        result += doubled(values, i)
    return result


@compiled_as_is
def spread(values: NDArray[np.float64]) -> float:
    """Return what every second value differs by from all."""
    return summed(values) - summed(values[::2])


@compiled_as_is
def hashed(text: str) -> int:
    """Return the hash of a text, which is salted anew for each process."""
    return hash(text)
