"""Whether touch and order look like the model's: numbers that are normal where they do."""

from __future__ import annotations

import math

import numpy as np

from tactile_graph.compiled import compiled_as_is
from tactile_graph_likelihood.by_order.hazards import hazard, hazards_at
from tactile_graph_likelihood.by_order.likelihood import (
    LEAST_SHARE,
    Order,
    OrderProblem,
    log_order,
    noise_at,
    shares_along,
)
from tactile_graph_likelihood.geometry.covered import Box
from tactile_graph_likelihood.geometry.outlines import Values, unknowns
from tactile_graph_likelihood.single.density.element_terms import (
    OFF,
    ON,
    SIGMA,
    SQRT_HALF,
    STRAYS,
    VOIDS,
    States,
)
from tactile_graph_likelihood.single.density.goodness_of_fit import (
    DENSITY,
    SEEN,
    SURE,
    GoodnessOfFit,
    dome,
    neighbours_alike,
    standardised,
    trend,
)
from tactile_graph_likelihood.single.density.load_shares import shares_around

MOST_TIED = 0.25
"""Share of the touched elements that, if they read the same, say nothing of a pattern."""


@compiled_as_is
def _add(chance: float, happened: bool, sums: Values) -> None:
    """Add what one yes or no tells, and its mean and variance, to three sums."""
    yes, no = math.log(chance), math.log(1.0 - chance)
    sums[0] += yes if happened else no
    sums[1] += chance * yes + (1.0 - chance) * no
    sums[2] += chance * (1.0 - chance) * (yes - no) * (yes - no)


@compiled_as_is
def touch_moments(share: Values, t: float, box: Box, states: States, noise: Values) -> Values:
    """Return the log likelihood of what is touched, its mean and its variance, shape (3,).

    Parameters
    ----------
    share : ndarray, shape (rows, columns)
        Coverage of a window.
    t, box, states, noise
        As in `likelihood.log_touched`.
    """
    sums = np.zeros(3)
    for i in range(states.shape[0]):
        for j in range(states.shape[1]):
            state = states[i, j]
            if state != ON and state != OFF:
                continue
            r, c = i - box[0], j - box[1]
            chance = noise[STRAYS]
            if 0 <= r < box[2] and 0 <= c < box[3] and share[r, c] > 0.0:
                z = (math.log(share[r, c]) + t) / noise[SIGMA]
                own = 0.5 * (1.0 - noise[VOIDS]) * math.erfc(-SQRT_HALF * z)
                chance += (1.0 - noise[STRAYS]) * own
            _add(chance, state == ON, sums)
    return sums


@compiled_as_is
def order_moments(
    along: Values, ends: Order, sigma: float, table: Values, levels: Values
) -> Values:
    """Return the log likelihood of an order, its mean and its variance, shape (3,).

    Of each element that reads as no other the chance that it is the next of those left, which
    has mean and variance given who is left. Parameters as in `log_order`, which wrote ``levels``.
    """
    n, sums = along.shape[0], np.zeros(3)
    marks = np.log(np.maximum(along, LEAST_SHARE)) / sigma
    for k in range(n):
        if along[k] <= 0.0 or ends[k] != k + 1 or (k > 0 and ends[k - 1] != k):
            continue
        total = own = logs = squares = 0.0
        for m in range(k, n):
            if along[m] <= 0.0:
                continue
            rate = hazard(table, levels[k] - marks[m])
            log = math.log(rate)
            own = log if m == k else own
            total += rate
            logs += rate * log
            squares += rate * log * log
        mean = logs / total
        sums[0] += own - math.log(total)
        sums[1] += mean - math.log(total)
        sums[2] += squares / total - mean * mean
    return sums


@compiled_as_is
def order_goodness_of_fit(problem: OrderProblem, p: Values) -> tuple[GoodnessOfFit, float]:
    """Return how surprising touch and order are at a posterior mean, and what patterns they leave.

    The residuals are of the loads at which `log_order` expects the elements of such an order;
    those of many equal readings are left out. Beside it, by how many deviations the order alone is
    likelier than it should be.
    """
    kind, corners, noise = problem.kind, problem.corners, noise_at(problem, p)
    states, order, ends = problem.states, problem.order, problem.ends
    table = hazards_at(problem.hazards, noise[SIGMA])
    box, share = shares_around(kind, corners, p, problem.grid, noise, states.shape)
    n, sigma, t = order.shape[0], noise[SIGMA], p[unknowns(kind, corners)]
    along, levels = shares_along(share, box, order), np.zeros(n)
    log_order(along, ends, sigma, t, table, levels)
    alone = order_moments(along, ends, sigma, table, levels)
    sums = touch_moments(share, t, box, states, noise) + alone
    orderly = (alone[0] - alone[1]) / math.sqrt(alone[2]) if alone[2] > 0.0 else 0.0
    residuals, leaning = np.zeros(share.shape), np.zeros(share.shape)
    first = 0
    for k in range(n):
        first = k if k == 0 or ends[k - 1] == k else first
        if along[k] <= 0.0 or ends[k] - first > max(MOST_TIED * n, 1.0):
            continue
        mark = math.log(max(along[k], LEAST_SHARE)) / sigma
        u, z = levels[k] - mark, mark + t / sigma
        tail, density = 0.5 * math.erfc(-SQRT_HALF * z), DENSITY * math.exp(-0.5 * z * z)
        i, j = order[k, 0] - box[0], order[k, 1] - box[1]
        residuals[i, j] = u if z > SURE else 0.0
        leaning[i, j] = standardised(u, z, tail, density) if z > SEEN else 0.0
    surprise = (sums[0] - sums[1] - 0.5 * p.shape[0]) / math.sqrt(sums[2])
    lean, fall = trend(leaning, dome(share))
    return GoodnessOfFit(surprise, neighbours_alike(residuals), lean, fall), orderly
