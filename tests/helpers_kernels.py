"""Small kernels to compile, in a file of their own so that machine code can be kept on disk."""

from __future__ import annotations

from typing import NamedTuple

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


class Inner(NamedTuple):
    """A number and an array."""

    number: float
    values: NDArray[np.float64]


class Outer(NamedTuple):
    """Two of them, and a count."""

    left: Inner
    right: Inner
    n: int


@compiled_as_is
def nested(x: float) -> Outer:
    """Return named tuples in one, with arrays."""
    return Outer(Inner(x, np.full(2, x)), Inner(2.0 * x, np.full((1, 3), 2.0 * x)), 3)


@compiled_as_is
def row_sum(row: NDArray[np.float64]) -> float:
    """Return a row's sum."""
    total = 0.0
    for value in row.flat:
        total += value
    return total


@compiled_as_is
def firsts(table: NDArray[np.float64], n: int) -> NDArray[np.float64]:
    """Return a copy of the first rows."""
    made = np.empty((n, len(table[0])))
    for i in range(n):
        made[i] = table[i]
    return made


@compiled_as_is
def of_rows(table: NDArray[np.float64], n: int) -> tuple[NDArray[np.float64], float]:
    """Return a copy of the first rows, and their sum."""
    total = 0.0
    for i in range(n):
        total += row_sum(table[i])
    return firsts(table, n), total
