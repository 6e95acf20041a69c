"""How much alike the outlines of one pad are expected to be, in size and in load.

Each by itself, an outline may be of any size and load. Those that lie together are mostly of one
sort, of which nobody knows the middle or the spread. Without that, every further outline costs as
much as if nothing were known of it, so that of many that touch too few are found.
"""

from __future__ import annotations

import math

from tactile_graph_likelihood.geometry.outline_prior import LARGEST, SMALLEST
from tactile_graph_likelihood.geometry.outlines import Values
from tactile_graph_likelihood.several.joint_posterior import MIDDLE, SPREAD

SPREADS = 0.2, 0.4, 0.8, 1.6
"""What the standard deviation of the logarithms may be, all alike likely."""

HALF_LN_TWO_PI = 0.5 * math.log(2.0 * math.pi)


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
    some: list[float] = values.tolist()  # a few numbers: numpy takes ten times as long
    n, mean = len(some), sum(some) / len(some)
    squared = sum((value - mean) ** 2 for value in some)
    logs = [
        -(n - 1) * (math.log(spread) + HALF_LN_TWO_PI) - 0.5 * squared / spread**2
        for spread in SPREADS
    ]
    top = max(logs)
    each = sum(math.exp(log - top) for log in logs) / len(logs)
    return top + math.log(each) - 0.5 * math.log(n)


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
    spread, middle = float(prior[SPREAD]), float(prior[MIDDLE])
    alone: float = math.log(math.log(prior[LARGEST] / prior[SMALLEST]))
    alone += math.log(spread) + HALF_LN_TWO_PI
    off = [(load - middle) / spread for load in log_loads.tolist()]
    together = log_alike(log_sizes) + log_alike(log_loads)
    squared = sum(one * one for one in off) - (sum(off) / n) ** 2
    return together + (n - 1) * alone + 0.5 * float(squared)
