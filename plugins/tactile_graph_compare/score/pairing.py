"""Pair what was found with what was there: as many pairs as can be, then the nearest."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

Reals = NDArray[np.float64]


def paired(off_cm: Reals, gate_cm: float) -> list[tuple[int, int]]:
    """Return the pairs (true, found) within the gate: most in number, least in sum of distances.

    Parameters
    ----------
    off_cm : ndarray of float64, shape (n_true, n_found)
        Distances.
    gate_cm : float
        Farther apart is no pair.

    Returns
    -------
    list of (int, int)
        In the order of the true ones.
    """
    n_true, n_found = off_cm.shape
    if n_true == 0 or n_found == 0:
        return []
    near = off_cm <= gate_cm
    # Every true object has a place of its own beside the found ones where it may stay alone, at a
    # cost that makes a pair more worth any detour; what is no pair at all costs more than that.
    alone = gate_cm * (2.0 + n_true)
    never = alone * (2.0 + n_true)
    cost = np.full((n_true, n_found + n_true), never)
    cost[:, :n_found][near] = off_cm[near]
    cost[np.arange(n_true), n_found + np.arange(n_true)] = alone
    chosen = assignment(cost)
    return [(i, j) for i, j in enumerate(chosen) if j < n_found and near[i, j]]


def assignment(cost: Reals) -> list[int]:
    """Return the column of each row, all different, with the least sum of costs.

    Parameters
    ----------
    cost : ndarray of float64, shape (rows, columns)
        Finite; no more rows than columns.

    Notes
    -----
    Rows enter one after another, each along the cheapest augmenting path under dual prices
    (Kuhn 1955, 10.1002/nav.3800020109; Edmonds and Karp 1972, 10.1145/321694.321699).
    """
    rows, columns = cost.shape
    row_price, column_price = np.zeros(rows), np.zeros(columns)
    owner = np.full(columns, -1)
    for row in range(rows):
        way, end = _cheapest_path(row, cost, row_price, column_price, owner)
        while end >= 0:
            before = int(way[end])
            if before < 0:
                owner[end] = row
                break
            owner[end] = owner[before]
            end = before
    chosen = np.empty(rows, dtype=np.int64)
    taken = owner >= 0
    chosen[owner[taken]] = np.flatnonzero(taken)
    return [int(c) for c in chosen]


def _cheapest_path(
    row: int, cost: Reals, row_price: Reals, column_price: Reals, owner: NDArray[np.int64]
) -> tuple[NDArray[np.int64], int]:
    """Return for each column the one before it on the path, and the free column it ends in.

    Prices are raised on the way, so that no pair costs less than its prices.
    """
    columns = cost.shape[1]
    least = np.full(columns, np.inf)
    way = np.full(columns, -1)
    closed = np.zeros(columns, dtype=np.bool_)
    here, column = row, -1
    reached: list[tuple[int, int]] = []
    while True:
        off = cost[here] - row_price[here] - column_price
        better = ~closed & (off < least)
        least[better], way[better] = off[better], column
        step_to = int(np.where(closed, np.inf, least).argmin())
        step = least[step_to]
        row_price[row] += step
        for other, its_column in reached:
            row_price[other] += step
            column_price[its_column] -= step
        least[~closed] -= step
        closed[step_to] = True
        if owner[step_to] < 0:
            return way, step_to
        here, column = int(owner[step_to]), step_to
        reached.append((here, step_to))
