"""What foam passes on to neighbours, and which loads have brought it about; windows of a pad.

Each element takes what falls on its cell. Nothing comes from beyond the window.
"""

from __future__ import annotations

import math

import numpy as np

from tactile_graph.compiled import compiled_as_is
from tactile_graph_likelihood.geometry.outlines import Values
from tactile_graph_likelihood.single.density.load_shares import foam_weights

FAINTEST = 1e-5
"""Share of a load that foam need not carry farther."""

FARTHEST = 1 << 20
"""Cells beyond which none is carried, whatever the foam."""

TINY = 1e-12


@compiled_as_is
def shares_of(width: float) -> Values:
    """Return `foam_weights` as far as more than the faintest share is carried on."""
    weights, n = foam_weights(width, FARTHEST), 0
    beyond = 0.5 * (1.0 - weights[0])
    while n + 1 < weights.shape[0] and beyond > FAINTEST:
        n += 1
        beyond -= weights[n]
    return weights[: n + 1]


@compiled_as_is
def spread(loads: Values, shares: Values) -> Values:
    """Return what loads bring to each element, shape (rows, columns)."""
    (rows, cols), reach = loads.shape, shares.shape[0] - 1
    line, across = np.zeros(cols + 2 * reach), np.zeros((rows + 2 * reach, cols))
    found = np.empty((rows, cols))
    for i in range(rows):
        for j in range(cols):
            line[reach + j] = loads[i, j]
        for j in range(cols):
            across[reach + i, j] = shares[0] * line[reach + j]
        for k in range(1, reach + 1):
            for j in range(cols):
                across[reach + i, j] += shares[k] * (line[reach + j - k] + line[reach + j + k])
    for i in range(rows):
        for j in range(cols):
            found[i, j] = shares[0] * across[reach + i, j]
        for k in range(1, reach + 1):
            for j in range(cols):
                found[i, j] += shares[k] * (across[reach + i - k, j] + across[reach + i + k, j])
    return found


@compiled_as_is
def unspread(values: Values, shares: Values) -> None:
    """Turn what loads bring to elements into the loads, in place."""
    _unspread_down(values, shares)
    turned = values.T.copy()
    _unspread_down(turned, shares)
    values[:, :] = turned.T


@compiled_as_is
def _unspread_down(values: Values, shares: Values) -> None:
    """Solve for the loads along the first axis, by the banded root of what they bring."""
    (rows, cols), band = values.shape, shares.shape[0]
    root = np.zeros((rows, band))  # its k-th diagonal below the main one
    for i in range(rows):
        for k in range(min(band - 1, i), -1, -1):
            j, total = i - k, shares[k]
            for m in range(max(0, i - band + 1, j - band + 1), j):
                total -= root[i, i - m] * root[j, j - m]
            root[i, k] = math.sqrt(max(total, TINY)) if k == 0 else total / root[j, 0]
    for i in range(rows):
        for m in range(max(0, i - band + 1), i):
            for c in range(cols):
                values[i, c] -= root[i, i - m] * values[m, c]
        for c in range(cols):
            values[i, c] /= root[i, 0]
    for i in range(rows - 1, -1, -1):
        for m in range(i + 1, min(rows, i + band)):
            for c in range(cols):
                values[i, c] -= root[m, m - i] * values[m, c]
        for c in range(cols):
            values[i, c] /= root[i, 0]
