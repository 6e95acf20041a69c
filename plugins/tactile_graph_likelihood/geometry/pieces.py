"""Pieces of what is touched: elements that hang together."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from tactile_graph.compiled import compiled_as_is

Places = NDArray[np.int64]


@compiled_as_is
def components(on: NDArray[np.bool_] | NDArray[np.uint8], reach: int) -> Places:
    """Return a label for each set of elements no more than some rows and columns apart.

    Parameters
    ----------
    on : ndarray of bool or uint8, shape (rows, columns)
        Which elements count.
    reach : int
        Rows or columns that neighbours of a set are apart, at most.

    Returns
    -------
    ndarray of int64, the same shape
        From 1, in the order of their first elements; 0 where none counts.
    """
    rows, cols = on.shape
    labels = np.zeros((rows, cols), np.int64)
    todo = np.empty((rows * cols, 2), np.int64)
    count = 0
    for i in range(rows):
        for j in range(cols):
            if not on[i, j] or labels[i, j] > 0:
                continue
            count += 1
            labels[i, j] = count
            todo[0, 0], todo[0, 1] = i, j
            left = 1
            while left > 0:
                left -= 1
                r, c = todo[left, 0], todo[left, 1]
                for y in range(max(r - reach, 0), min(r + reach + 1, rows)):
                    for x in range(max(c - reach, 0), min(c + reach + 1, cols)):
                        if on[y, x] and labels[y, x] == 0:
                            labels[y, x] = count
                            todo[left, 0], todo[left, 1] = y, x
                            left += 1
    return labels
