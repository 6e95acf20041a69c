"""The readings of a frame in ascending order, of a large pad a part of them."""

from __future__ import annotations

import math
from functools import lru_cache

import numpy as np
from numpy.typing import NDArray

MOST = 4096
"""Readings that are looked at, at the least, of a pad that has as many."""

GOLDEN = 0.5 * (math.sqrt(5.0) - 1.0)


def in_order(readings: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return readings in ascending order; of more than 4096 a part that is as good.

    Parameters
    ----------
    readings : ndarray, shape (N,)
        Row by row. One of every few is taken, each time at another place among them: dead columns
        are then in the part as often as on the pad.
    """
    every = len(readings) // MOST
    values = readings.copy() if every < 2 else readings[_places(len(readings), every)]
    values.sort()
    return values


@lru_cache(maxsize=8)
def _places(n: int, every: int) -> NDArray[np.intp]:
    """Return one place of every so many, by multiples of the golden ratio, which fit no period."""
    blocks = np.arange(n // every)
    within = (np.modf(blocks * GOLDEN)[0] * every).astype(np.intp)
    places: NDArray[np.intp] = blocks * every + within
    return places
