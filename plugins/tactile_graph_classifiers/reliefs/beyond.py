"""How a relief goes on beyond what any press touched."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray
from scipy import sparse
from scipy.ndimage import distance_transform_edt
from scipy.sparse.linalg import spsolve

from tactile_graph_classifiers.reliefs.kernels import NODES
from tactile_graph_classifiers.reliefs.presses import Presses
from tactile_graph_classifiers.reliefs.relief import Relief

Array = NDArray[np.float64]
WITHIN = 8
"""So many nodes beside what was touched it goes on as it rises there; beyond it never touches."""
NEVER = 4.0
"""How much deeper than any press that is, in usual depths."""
ALONG = ((0, 1, 1.0), (1, 0, 1.0), (1, 1, 0.5), (1, -1, 0.5))
"""Directions in which it is to go on without a kink, and how much that counts."""


def deepest(relief: Relief, presses: Presses) -> Array:
    """Return how deep each node was ever pressed; minus infinity where none was looked at.

    Presses that fit badly count for nothing: they tell of places where they never were.
    """
    half = (len(relief.depth) - 1) / 2.0
    at = (np.arange(len(relief.depth)) - half) / NODES
    v, u = np.meshgrid(at, at, indexing="ij")
    out = np.full(u.shape, -np.inf)
    trusted = relief.trust(presses) == 1.0
    for press, box in zip(relief.presses[trusted], presses.boxes[trusted], strict=True):
        x0, y0, turn, deep, lean_u, lean_v = press
        x = x0 + u * math.cos(turn) - v * math.sin(turn)
        y = y0 + u * math.sin(turn) + v * math.cos(turn)
        on = (x > box[1]) & (x < box[1] + box[3]) & (y > box[0]) & (y < box[0] + box[2])
        out = np.where(on, np.maximum(out, deep - lean_u * u - lean_v * v), out)
    return out


def extend(relief: Relief, presses: Presses) -> None:
    """Let the relief go on beyond what was touched, as smoothly as it comes, never touching."""
    below, depth = deepest(relief, presses), relief.depth
    learned = depth < below - 0.02 * relief.usual
    if not learned.any():
        return
    free = ~learned & (distance_transform_edt(~learned) <= WITHIN)
    out = depth.copy()
    if free.any():
        smooth = _going_on(depth, learned, free)
        known = np.isfinite(below[free])
        out[free] = np.maximum(smooth, np.where(known, below[free], smooth))
    rest = ~learned & ~free
    out[rest] = np.maximum(depth[rest], below.max() + NEVER * relief.usual)
    relief.depth = out


def _going_on(depth: Array, learned: NDArray[np.bool_], free: NDArray[np.bool_]) -> Array:
    """Return the depths of free nodes with the least kinks beside the learned ones."""
    number = np.where(free, np.cumsum(free.ravel()).reshape(free.shape) - 1, -1)
    n = len(depth)
    rows, columns, factors, right = [], [], [], []
    n_rows = 0
    for i, j, factor in ALONG:
        three = [(slice(1 - s * i, n - 1 - s * i), slice(1 - s * j, n - 1 - s * j))
                 for s in (1, 0, -1)]  # fmt: skip
        used = np.logical_and.reduce([(free | learned)[at] for at in three])
        used &= np.logical_or.reduce([free[at] for at in three])
        row, off = n_rows + np.arange(used.sum()), np.zeros(int(used.sum()))
        for at, times in zip(three, (factor, -2.0 * factor, factor), strict=True):
            which = number[at][used]
            rows.append(row[which >= 0])
            columns.append(which[which >= 0])
            factors.append(np.full(int((which >= 0).sum()), times))
            off -= np.where(which < 0, times * depth[at][used], 0.0)
        right.append(off)
        n_rows += len(row)
    cells = (np.concatenate(factors), (np.concatenate(rows), np.concatenate(columns)))
    M = sparse.csr_matrix(cells, shape=(n_rows, int(free.sum())))
    A = (M.T @ M + 1e-6 * sparse.identity(M.shape[1])).tocsc()
    return np.asarray(spsolve(A, M.T @ np.concatenate(right) + 1e-6 * depth[free]))
