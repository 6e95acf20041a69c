"""How much alike the outlines of one pad are expected to be, in size and in load.

Each by itself, an outline may be of any size and load. Those that lie together are mostly of one
sort, of which nobody knows the middle or the spread. Without that, every further outline costs as
much as if nothing were known of it, so that of many that touch too few are found.
"""

from __future__ import annotations

import math

import numpy as np

from tactile_graph.compiled import compiled_as_is
from tactile_graph_likelihood.geometry.outline_prior import LARGEST, SMALLEST
from tactile_graph_likelihood.geometry.outlines import (
    DISC,
    RECTANGLE,
    REGULAR,
    Values,
    unknowns,
)
from tactile_graph_likelihood.several.joint_posterior import MIDDLE, SPREAD
from tactile_graph_likelihood.single.problem import Places

SPREADS = 0.2, 0.4, 0.8, 1.6
"""What the standard deviation of the logarithms may be, all alike likely."""

HALF_LN_TWO_PI = 0.5 * math.log(2.0 * math.pi)


@compiled_as_is
def log_alike(values: Values) -> float:
    """Return the log density of values around their mean, which is unknown as is their spread.

    Parameters
    ----------
    values : ndarray, shape (N,)

    Returns
    -------
    float
        Of N values over that of their mean; integrated over the mean, with a flat density of 1.
    """
    n, mean, total = len(values), 0.0, 0.0
    for value in values:
        mean += value / n
    squared, logs = 0.0, np.empty(len(SPREADS))
    for value in values:
        squared += (value - mean) ** 2
    for k in range(len(SPREADS)):
        logs[k] = -(n - 1) * (math.log(SPREADS[k]) + HALF_LN_TWO_PI)
        logs[k] -= 0.5 * squared / SPREADS[k] ** 2
    top = logs.max()
    for log in logs:
        total += math.exp(log - top) / len(SPREADS)
    log_density: float = top + math.log(total) - 0.5 * math.log(n)
    return log_density


@compiled_as_is
def alikeness(log_sizes: Values, log_loads: Values, prior: Values) -> float:
    """Return how much likelier outlines are as those of one pad than each by itself.

    Parameters
    ----------
    log_sizes, log_loads : ndarray, shape (N,)
        Logarithms of the roots of areas, and of loads.
    prior : ndarray, shape (11,)
        As in `JointProblem`: what a single one may be.
    """
    n = len(log_loads)
    if n < 2:
        return 0.0
    alone = math.log(math.log(prior[LARGEST] / prior[SMALLEST]))
    alone += math.log(prior[SPREAD]) + HALF_LN_TWO_PI
    total = log_alike(log_sizes) + log_alike(log_loads) + (n - 1) * alone
    mean = 0.0
    for load in log_loads:
        off = (load - prior[MIDDLE]) / prior[SPREAD]
        mean += off / n
        total += 0.5 * off * off
    return total - 0.5 * mean * mean


@compiled_as_is
def alikeness_of(kinds: Places, corners: Places, points: Values, prior: Values) -> float:
    """Return `alikeness` of outlines."""
    sizes, loads = np.empty(len(kinds)), np.empty(len(kinds))
    for k in range(len(kinds)):
        sizes[k] = 0.5 * math.log(area_of(kinds[k], corners[k], points[k]))
        loads[k] = points[k, unknowns(kinds[k], corners[k])]
    return alikeness(sizes, loads, prior)


@compiled_as_is
def area_of(kind: int, corners: int, p: Values) -> float:
    """Return the area of an outline, in cm2."""
    area: float = math.pi * p[2] * (p[2] if kind == DISC else p[3])
    if kind == REGULAR:
        area = p[2] * p[2] * filled(corners)
    elif kind == RECTANGLE:
        area = 4.0 * p[2] * p[3]
    return area


@compiled_as_is
def filled(corners: int) -> float:
    """Return the area of a regular polygon whose corners are 1 from its centre."""
    return 0.5 * corners * math.sin(2.0 * math.pi / corners)
