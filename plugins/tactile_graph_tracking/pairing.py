"""Who belongs to whom: the pairing of least total cost, within a gate."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
from numpy.typing import NDArray

FEW_PAIRS = 4096
"""Pairs that are all looked at."""


def paired(cost: NDArray[np.float64], limit: float) -> list[tuple[int, int]]:
    """Return the pairs (row, column) of the cheapest pairing in which staying alone costs too.

    Parameters
    ----------
    cost : ndarray of float64, shape (rows, columns)
        What each pair costs, >= 0; infinite where the two cannot be a pair.
    limit : float
        What a row without a partner costs; dearer pairs are never made.

    Returns
    -------
    list of (int, int)
        In the order of the rows.

    Notes
    -----
    Exact. Where the rows' cheapest partners all differ they are the answer; the rest is left to
    ``scipy.optimize.linear_sum_assignment`` (Crouse 2016, 10.1109/TAES.2016.140952).
    """
    rows, columns = cost.shape
    if rows == 0 or columns == 0:
        return []
    nearest = cost.argmin(axis=1)
    within = cost[np.arange(rows), nearest] <= limit
    chosen = nearest[within]
    if len(set(chosen.tolist())) == chosen.size:
        return list(zip(np.flatnonzero(within).tolist(), chosen.tolist(), strict=True))
    from scipy.optimize import linear_sum_assignment

    # Each row has a place of its own beside the columns, where it may stay alone.
    alone = np.where(np.eye(rows, dtype=np.bool_), limit, np.inf)
    wide = np.concatenate([np.where(cost <= limit, cost, np.inf), alone], axis=1)
    found = zip(*(part.tolist() for part in linear_sum_assignment(wide)), strict=True)
    return [(row, column) for row, column in found if column < columns]


def paired_places(
    first: NDArray[np.float64], second: NDArray[np.float64], gate: float, limit: float
) -> list[tuple[int, int, float]]:
    """Return the pairs (of the first, of the second, distance) of the cheapest pairing of places.

    Parameters
    ----------
    first, second : ndarray of float64, shapes (n, 2) and (m, 2)
    gate : float
        Places farther apart are no pair.
    limit : float
        What one of the first costs that stays alone; a pair costs its distance.

    Returns
    -------
    list of (int, int, float)
        In the order of the first.

    Notes
    -----
    What is within the gate of nothing in common is paired by itself: `paired` is then asked of
    many small pairings and not of one, whose time grows with the cube of the places.
    """
    if first.shape[0] * second.shape[0] <= FEW_PAIRS:
        off = np.hypot(*(first[:, None] - second[None]).transpose(2, 0, 1))
        pairs = paired(np.where(off <= gate, off, np.inf), limit)
        return [(i, j, float(off[i, j])) for i, j in pairs]
    found: list[tuple[int, int, float]] = []
    for these, those in _neighbourhoods(first, second, gate):
        off = np.hypot(*(first[these][:, None] - second[those][None]).transpose(2, 0, 1))
        pairs = paired(np.where(off <= gate, off, np.inf), limit)
        found += [(int(these[i]), int(those[j]), float(off[i, j])) for i, j in pairs]
    return sorted(found)


def _neighbourhoods(
    first: NDArray[np.float64], second: NDArray[np.float64], gate: float
) -> Iterator[tuple[NDArray[np.int64], NDArray[np.int64]]]:
    """Yield the numbers of places that a chain of distances within the gate holds together."""
    from scipy.sparse import coo_array
    from scipy.sparse.csgraph import connected_components
    from scipy.spatial import KDTree

    wide = gate * (1.0 + 1e-9)  # what rounding takes away is found again by `paired`
    near: list[list[int]] = list(KDTree(second).query_ball_point(first, wide))  # type: ignore[arg-type]
    rows = np.repeat(np.arange(len(first)), [len(n) for n in near])
    columns = np.concatenate([np.array(n, dtype=np.int64) for n in near])
    size = len(first) + len(second)
    links = coo_array((np.ones(len(rows)), (rows, len(first) + columns)), shape=(size, size))
    of = connected_components(links, directed=False)[1]
    order = np.argsort(of, kind="stable")
    for members in np.split(order, np.flatnonzero(np.diff(of[order])) + 1):
        these, those = members[members < len(first)], members[members >= len(first)] - len(first)
        if these.size and those.size:
            yield these, those
