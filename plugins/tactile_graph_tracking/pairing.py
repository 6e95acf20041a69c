"""Who belongs to whom: the pairing of least total cost, within a gate."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray


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
