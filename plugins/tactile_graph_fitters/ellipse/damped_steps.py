"""Levenberg and Marquardt's step for five unknowns: small symmetric equations, solved in place."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from tactile_graph.compiled import compiled_later

Values = NDArray[np.float64]


@compiled_later
def damped_step(normal: Values, slope: Values, damping: float, step: Values) -> bool:
    """Write the solution of (N + damping * diag N) step = -slope; return False if there is none.

    ``normal``, shape (n, n), is left as it is; a Cholesky factorisation of a copy does it.
    """
    n = slope.shape[0]
    factor = np.empty((n, n))
    for i in range(n):
        for k in range(i + 1):
            total = normal[i, k] * (1.0 + damping) if i == k else normal[i, k]
            for m in range(k):
                total -= factor[i, m] * factor[k, m]
            if i == k:
                if not total > 1e-14 * normal[i, i]:
                    return False
                factor[i, i] = math.sqrt(total)
            else:
                factor[i, k] = total / factor[k, k]
    for i in range(n):
        total = -slope[i]
        for m in range(i):
            total -= factor[i, m] * step[m]
        step[i] = total / factor[i, i]
    for i in range(n - 1, -1, -1):
        total = step[i]
        for m in range(i + 1, n):
            total -= factor[m, i] * step[m]
        step[i] = total / factor[i, i]
    return True
