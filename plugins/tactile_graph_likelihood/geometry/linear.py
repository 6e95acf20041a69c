"""Small dense matrices for the kernels; no library call, so no warm-up and the same bits always."""

from __future__ import annotations

import math

import numpy as np

from tactile_graph.compiled import compiled_as_is
from tactile_graph_likelihood.geometry.outlines import Values


@compiled_as_is
def cholesky(matrix: Values, lower: Values) -> bool:
    """Write the lower triangular root of a positive matrix; return whether it is positive."""
    n = matrix.shape[0]
    for i in range(n):
        for j in range(i + 1):
            total = matrix[i, j]
            for k in range(j):
                total -= lower[i, k] * lower[j, k]
            if i == j:
                if not total > 1e-14 * abs(matrix[i, i]):
                    return False
                lower[i, i] = math.sqrt(total)
            else:
                lower[i, j] = total / lower[j, j]
                lower[j, i] = 0.0
    return True


@compiled_as_is
def solved(lower: Values, right: Values, out: Values) -> None:
    """Write the solution x of ``L L^T x = right``."""
    n = lower.shape[0]
    for i in range(n):
        total = right[i]
        for k in range(i):
            total -= lower[i, k] * out[k]
        out[i] = total / lower[i, i]
    for i in range(n - 1, -1, -1):
        total = out[i]
        for k in range(i + 1, n):
            total -= lower[k, i] * out[k]
        out[i] = total / lower[i, i]


@compiled_as_is
def inverse_root(lower: Values) -> Values:
    """Return the inverse of ``L``, lower triangular too."""
    n = lower.shape[0]
    out = np.zeros((n, n))
    for j in range(n):
        out[j, j] = 1.0 / lower[j, j]
        for i in range(j + 1, n):
            total = 0.0
            for k in range(j, i):
                total -= lower[i, k] * out[k, j]
            out[i, j] = total / lower[i, i]
    return out


@compiled_as_is
def inverted(lower: Values) -> Values:
    """Return the inverse of ``L L^T``."""
    n = lower.shape[0]
    out, unit, column = np.empty((n, n)), np.zeros(n), np.empty(n)
    for j in range(n):
        unit[j] = 1.0
        solved(lower, unit, column)
        unit[j] = 0.0
        for i in range(n):
            out[i, j] = column[i]
    return out


@compiled_as_is
def squared_length(lower: Values, off: Values, work: Values) -> float:
    """Return the squared length of ``L^-1 off``; ``work`` is scratch space."""
    n = lower.shape[0]
    length = 0.0
    for i in range(n):
        total = off[i]
        for k in range(i):
            total -= lower[i, k] * work[k]
        work[i] = total / lower[i, i]
        length += work[i] * work[i]
    return length
