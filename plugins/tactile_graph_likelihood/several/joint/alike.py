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
from tactile_graph_likelihood.geometry.outlines import Values, unknowns
from tactile_graph_likelihood.several.joint.joint_posterior import MIDDLE, SPREAD, Outlines
from tactile_graph_likelihood.several.joint.kinds import area

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
    n, total, squared = values.shape[0], 0.0, 0.0
    for k in range(n):
        total += values[k]
    for k in range(n):
        squared += (values[k] - total / n) ** 2
    top = -math.inf
    for s in range(len(SPREADS)):
        top = max(top, _log_of_spread(n, squared, SPREADS[s]))
    each = 0.0
    for s in range(len(SPREADS)):
        each += math.exp(_log_of_spread(n, squared, SPREADS[s]) - top)
    return top + math.log(each / len(SPREADS)) - 0.5 * math.log(n)


@compiled_as_is
def _log_of_spread(n: int, squared: float, spread: float) -> float:
    return -(n - 1) * (math.log(spread) + HALF_LN_TWO_PI) - 0.5 * squared / spread**2


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
    n = log_loads.shape[0]
    if n < 2:
        return 0.0
    spread, middle = prior[SPREAD], prior[MIDDLE]
    alone = math.log(math.log(prior[LARGEST] / prior[SMALLEST])) + math.log(spread) + HALF_LN_TWO_PI
    total, squared = 0.0, 0.0
    for k in range(n):
        off = (log_loads[k] - middle) / spread
        total += off
        squared += off * off
    squared -= (total / n) ** 2
    together = log_alike(log_sizes) + log_alike(log_loads)
    found: float = together + (n - 1) * alone + 0.5 * squared
    return found


@compiled_as_is
def alikeness_of(outlines: Outlines, prior: Values) -> float:
    """Return `alikeness` of outlines."""
    n = outlines.kinds.shape[0]
    log_sizes, log_loads = np.empty(n), np.empty(n)
    for k in range(n):
        kind, corners, p = outlines.kinds[k], outlines.corners[k], outlines.points[k]
        log_sizes[k] = 0.5 * math.log(area(kind, corners, p))
        log_loads[k] = p[unknowns(kind, corners)]
    return alikeness(log_sizes, log_loads, prior)
