"""Levenberg's and Marquardt's least squares within bounds: the inverse behind noisy voltages."""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
MOST_ITERATIONS = 20
MOST_TRIALS = 8
"""Of one step, each with ten times the damping of the one before."""
FIRST_DAMPING, LEAST_DAMPING = 1e-3, 1e-9
MOST_NOISES = 2.0
"""Root mean square misfit, in the noise a pad states, up to which voltages are its circuit's."""
LITTLE = 1e-4
"""Part of the sum of squares: who gains less by a step has arrived."""


class Nearest(NamedTuple):
    """The unknowns that come nearest, their mean square misfit, and the steps taken."""

    found: Array
    mean_square: float
    iterations: int


def nearest_above(
    misfit: Callable[[Array], Array], jacobian: Callable[[Array], Array], start: Array, floor: float
) -> Nearest:
    """Return unknowns from ``floor`` on whose misfit is no more than noise, or else the least.

    Parameters
    ----------
    misfit : callable
        Data less model of given unknowns, in standard deviations, shape (n,).
    jacobian : callable
        Derivatives of the model in the same unit, at the unknowns ``misfit`` had last that
        were better; shape (n, n).
    start : ndarray of float64, shape (n,)
    floor : float

    Notes
    -----
    Ends as soon as the mean square is 1: what is nearer follows the noise. An unknown at the floor
    stays there as long as less of it would be better.
    """
    x = np.maximum(start, floor)
    left = misfit(x)
    square, damping, n = float(left @ left), FIRST_DAMPING, 0
    while n < MOST_ITERATIONS and square > len(x):
        slopes = jacobian(x)
        uphill = slopes.T @ left
        free = (x > floor) | (uphill > 0.0)
        normal = slopes[:, free].T @ slopes[:, free]
        weights = np.diag(normal) + 1e-12 * float(np.diag(normal).max(initial=1e-300))
        for _ in range(MOST_TRIALS):
            trial = x.copy()
            trial[free] += np.linalg.solve(normal + damping * np.diag(weights), uphill[free])
            trial = np.maximum(trial, floor)
            its = misfit(trial)
            if float(its @ its) < square:
                break
            damping *= 10.0
        else:
            break
        gained = square - float(its @ its)
        x, left, square, n = trial, its, square - gained, n + 1
        damping = max(0.1 * damping, LEAST_DAMPING)
        if gained < LITTLE * square:
            break
    return Nearest(x, square / max(len(x), 1), n)
