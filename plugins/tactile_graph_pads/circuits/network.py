"""Resistor networks solved without a subtraction, so that no digit is lost at any resistance.

A pad's rows and columns are the two sides of a bipartite network. Elimination in the form of
Grassmann, Taksar and Heyman (1985, 10.1287/opre.33.5.1107) keeps each node's conductance as a
sum of positive parts, so even networks that mix 1 Ohm and 1 TOhm come out to full precision.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from tactile_graph.compiled import compiled_twin_of

Array = NDArray[np.float64]


def _factors(weights: Array) -> tuple[Array, Array]:
    """Return the inverse factor X and pivots D of a grounded network, ``Z = X^T D^-1 X``.

    Parameters
    ----------
    weights : ndarray of float64, shape (n + 1, n + 1)
        Symmetric conductances between n nodes and, last, ground. Zero on the diagonal. Changed
        in place: each node in turn is replaced by the mesh that equals its star.

    Returns
    -------
    inverse_factor : ndarray, shape (n, n)
        Unit lower triangular and nowhere negative.
    pivots : ndarray, shape (n,)
        0 for the last node of a part without a way to ground.
    """
    n = weights.shape[0] - 1
    pivots = np.zeros(n)
    factor = np.eye(n)
    for k in range(n):
        row = weights[k, k + 1 :].copy()
        pivots[k] = row.sum()
        if pivots[k] > 0.0:
            share = row / pivots[k]
            weights[k + 1 :, k + 1 :] += np.outer(row, share)
            factor[k + 1 :, : k + 1] += np.outer(share[:-1], factor[k, : k + 1])
    return factor, pivots


@compiled_twin_of(_factors)
def factors(weights: Array) -> tuple[Array, Array]:  # noqa: D103
    n = weights.shape[0] - 1
    pivots = np.zeros(n)
    factor = np.zeros((n, n))
    for k in range(n):
        factor[k, k] = 1.0
    for k in range(n):
        total = 0.0
        for i in range(k + 1, n + 1):
            total += weights[k, i]
        pivots[k] = total
        if total <= 0.0:
            continue
        for i in range(k + 1, n + 1):
            share = weights[k, i] / total
            if share == 0.0:
                continue
            for j in range(k + 1, n + 1):
                weights[i, j] += share * weights[k, j]
            if i < n:
                for j in range(k + 1):
                    factor[i, j] += share * factor[k, j]
    return factor, pivots


def bipartite(siemens: Array, rows_to_ground: float = 0.0) -> Array:
    """Return the conductances between all nodes: rows, then columns, then ground.

    Parameters
    ----------
    siemens : ndarray of float64, shape (rows, columns)
    rows_to_ground : float
        Conductance of each row's driver.
    """
    rows, columns = siemens.shape
    weights = np.zeros((rows + columns + 1, rows + columns + 1))
    weights[:rows, rows:-1] = siemens
    weights[rows:-1, :rows] = siemens.T
    weights[:rows, -1] = weights[-1, :rows] = rows_to_ground
    return weights


def transfer_resistances(weights: Array) -> Array:
    """Return the grounded network's resistance matrix Z in ohm, shape (n, n).

    Parameters
    ----------
    weights : ndarray of float64, shape (n + 1, n + 1)
        As `bipartite` makes them; every node needs a way to ground, or Z is infinite there.
    """
    factor, pivots = factors(weights.copy())
    with np.errstate(divide="ignore", invalid="ignore"):
        scaled = np.where(factor > 0.0, factor / pivots[:, None], 0.0)
    finite = np.isfinite(scaled)
    if finite.all():
        return np.asarray(factor.T @ scaled)
    z = factor.T @ np.where(finite, scaled, 0.0)
    reached = factor.T @ np.where(finite, 0.0, 1.0) > 0.0
    z[reached | reached.T] = np.inf
    return np.asarray(z)
