"""Damped Newton in log conductance: the inverse of a circuit that has no closed one."""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
MOST_ITERATIONS = 40
MOST_HALVINGS = 10
LONGEST_STEP = 3.0
"""In natural logarithms: farther away the linear model says nothing."""
GOOD_ENOUGH = 1e-13


class Solution(NamedTuple):
    """Where Newton's iteration ended."""

    log_siemens: Array
    residual: float
    iterations: int


def solve_log(
    log_target: Array,
    log_model: Callable[[Array], Array],
    jacobian: Callable[[Array], Array],
    log_start: Array,
) -> Solution:
    """Return log conductances whose model meets the target, with the misfit that remains.

    Parameters
    ----------
    log_target : ndarray of float64, shape (n,)
        Logarithms of the data.
    log_model : callable
        Logarithms of what given log conductances measure as.
    jacobian : callable
        Derivatives of ``log_model``, shape (n, n).
    log_start : ndarray of float64, shape (n,)

    Notes
    -----
    Minimises the sum of squares of the log misfit along each Newton direction by halving the
    step; ends when the misfit is at rounding, when no step lowers it, or after
    `MOST_ITERATIONS`. The residual is the largest relative misfit.
    """
    x = log_start
    misfit = log_target - log_model(x)
    n = 0
    while n < MOST_ITERATIONS and _largest(misfit) > GOOD_ENOUGH:
        step = _step(jacobian(x), misfit)
        better = _lower(x, step, misfit, log_target, log_model)
        if better is None:
            break
        x, misfit = better
        n += 1
    return Solution(x, float(np.abs(np.expm1(misfit)).max(initial=0.0)), n)


def _step(matrix: Array, misfit: Array) -> Array:
    try:
        step = np.linalg.solve(matrix, misfit)
    except np.linalg.LinAlgError:
        step = np.linalg.lstsq(matrix, misfit, rcond=None)[0]
    return np.asarray(step * min(1.0, LONGEST_STEP / max(float(np.abs(step).max()), 1e-300)))


def _largest(values: Array) -> float:
    return float(np.abs(values).max(initial=0.0))


def _lower(
    x: Array,
    step: Array,
    misfit: Array,
    log_target: Array,
    log_model: Callable[[Array], Array],
) -> tuple[Array, Array] | None:
    before = float(misfit @ misfit)
    for halvings in range(MOST_HALVINGS):
        trial = x + step * 0.5**halvings
        after = log_target - log_model(trial)
        if float(after @ after) < before:
            return trial, after
    return None
