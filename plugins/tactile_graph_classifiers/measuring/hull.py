"""The kernel that finds the convex hull of a footprint's cells."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import ConvexHull

from tactile_graph.compiled import compiled_later, compiled_twin_of


def _corners_plain(on: NDArray[np.bool_]) -> NDArray[np.float64]:
    """Return the corners of the convex hull of all cells, in order.

    Parameters
    ----------
    on : ndarray of bool, shape (rows, columns)
        With at least one cell on.

    Returns
    -------
    ndarray, shape (n, 2)
        Column and row; a cell reaches half a cell beyond its own.
    """
    rows = np.flatnonzero(on.any(axis=1))
    first, last = on[rows].argmax(axis=1), on.shape[1] - 1 - on[rows, ::-1].argmax(axis=1)
    ends = np.concatenate([first - 0.5, last + 0.5] * 2)
    points = np.column_stack([ends, np.concatenate([rows - 0.5] * 2 + [rows + 0.5] * 2)])
    return np.asarray(points[ConvexHull(points).vertices])


@compiled_twin_of(_corners_plain)
def hull_corners(on):  # type: ignore[no-untyped-def]
    """Do the same by one chain down the right side and one down the left."""
    n_rows, n_columns = on.shape
    right, left = np.empty((2 * n_rows, 2)), np.empty((2 * n_rows, 2))
    n_right = n_left = 0
    for i in range(n_rows):
        first = last = -1
        for j in range(n_columns):
            if on[i, j]:
                first = j if first < 0 else first
                last = j
        if first < 0:
            continue
        for k in range(2):
            n_right = _longer(right, n_right, last + 0.5, i - 0.5 + k, 1.0)
            n_left = _longer(left, n_left, first - 0.5, i - 0.5 + k, -1.0)
    corners = np.empty((n_right + n_left, 2))
    corners[:n_right] = right[:n_right]
    for k in range(n_left):
        corners[n_right + k] = left[n_left - 1 - k]
    return corners


@compiled_later
def _longer(chain, n, x, y, side):  # type: ignore[no-untyped-def]
    """Add a corner to a chain of n, take out those it leaves inside, and return how many are in."""
    while n > 1:
        x0, y0 = chain[n - 2]
        x1, y1 = chain[n - 1]
        if side * ((x1 - x0) * (y - y0) - (y1 - y0) * (x - x0)) > 0.0:
            break
        n -= 1
    chain[n, 0], chain[n, 1] = x, y
    return n + 1
