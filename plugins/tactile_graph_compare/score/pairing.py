"""Pair what was found with what was there: as many pairs as can be, then the nearest."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray


def paired(off_cm: NDArray[np.float64], gate_cm: float) -> list[tuple[int, int]]:
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

    Notes
    -----
    An assignment of least cost by ``scipy.optimize.linear_sum_assignment`` (Crouse 2016,
    10.1109/TAES.2016.140952).
    """
    n_true, n_found = off_cm.shape
    if n_true == 0 or n_found == 0:
        return []
    from scipy.optimize import linear_sum_assignment

    # Every true object has a place of its own beside the found ones where it may stay alone, at a
    # cost that makes a pair more worth any detour.
    alone = np.where(np.eye(n_true, dtype=np.bool_), gate_cm * (2.0 + n_true), np.inf)
    cost = np.hstack([np.where(off_cm <= gate_cm, off_cm, np.inf), alone])
    rows, columns = linear_sum_assignment(cost)
    return [(i, j) for i, j in zip(rows.tolist(), columns.tolist(), strict=True) if j < n_found]
