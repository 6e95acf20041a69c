"""How likely it is what is touched, and in which order elements read: no law is used.

An element of coverage c bears the load ``c g`` of a fully covered one's, its gain g lognormal;
beyond the least load ``exp(-t)`` it is touched, but for voids:

    P(touched) = (1 - v) Phi((ln c + t) / sigma)

As loads rise from there, one touched element after the other reaches its own. At the load z the
next to do so is element i with the probability

    rate_i(z) / (sum of the rates of those that have not)

where a rate is the density of ln load at z over the chance of more: exact, whatever monotone law
turned load into readings. The loads at which it happens are not read; that all those left reach
theirs at a total rate, at which the next comes, tells where it is to be expected.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from tactile_graph.compiled import compiled_as_is
from tactile_graph_likelihood.by_order.hazards import hazard, hazards_at
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
from tactile_graph_likelihood.single.density.load_shares import shares_around

Order = NDArray[np.int64]

LEAST_SHARE = 1e-3
"""Coverage below it ranks as it does: a reading is no worse than a slip of the pad."""

STRIDE = 0.5
"""Standard deviations of ln load over which rates are taken as constant."""

EARLY = 6.0
"""Standard deviations below the lightest element where loads begin to rise, at the earliest."""


class OrderProblem(NamedTuple):
    """What the posterior by touch and order depends on, beside the outline, t and a free sigma.

    Parameters
    ----------
    kind, corners, grid, states, noise, prior
        As in `problem.Problem`; the least load that shows is not looked at.
    order : ndarray of int, shape (n, 2)
        Row and column of the touched elements, those that read least first.
    ends : ndarray of int, shape (n,)
        For each of them the place after the last that reads the same.
    hazards : ndarray, shape (1, N) or (2, N)
        As `hazards.hazards` gives them or, where sigma is estimated, `hazards.hazard_parts`.
    """

    kind: int
    corners: int
    grid: Values
    states: States
    noise: Values
    prior: Values
    order: Order
    ends: Order
    hazards: Values


@compiled_as_is
def _total_rate(
    marks: Values, left: Values, first: int, z: float, table: Values, rates: Values
) -> float:
    """Write the rates of elements from a place on, at a load; return their sum."""
    total, full = 0.0, hazard(table, z)
    for k in range(first, marks.shape[0]):
        if left[k] > 0.0:
            rates[k] = full if marks[k] == 0.0 else hazard(table, z - marks[k])
            total += left[k] * rates[k]
    return total


@compiled_as_is
def log_order(
    shares: Values, ends: Order, sigma: float, t: float, table: Values, levels: Values
) -> float:
    """Return the log probability of an order, over that of all orders being alike.

    Parameters
    ----------
    shares : ndarray, shape (n,)
        Coverage of the touched elements, those that read least first; 0 where uncovered: such an
        element's place in the order tells nothing.
    ends : ndarray of int, shape (n,)
        For each element the place after the last that reads the same.
    sigma : float
        Standard deviation of ln gain.
    t : float
        Logarithm of a fully covered element's load over the least that is touched.
    table : ndarray
        As `hazards.hazards` gives it.
    levels : ndarray, shape (n,)
        Written: the logarithm of the load at which each is expected, in units of ``sigma``.

    Notes
    -----
    Of equal readings one after the other goes, each in part: by how likely it is the next of
    them. Those that read most of all are certain to come last.
    """
    n = shares.shape[0]
    marks, left, rates = np.zeros(n), np.zeros(n), np.zeros(n)
    counted, lowest = 0, 0.0
    for k in range(n):
        if shares[k] > 0.0:
            counted += 1
            left[k] = 1.0
            if shares[k] < 1.0:
                marks[k] = math.log(max(shares[k], LEAST_SHARE)) / sigma
                lowest = min(lowest, marks[k])
    z = edge = max(-t / sigma, lowest - EARLY)
    total, product, sum_of_rates, first = 0.0, 1.0, 0.0, 0
    while first < n:
        last, equal, began = ends[first], 0, z
        for k in range(first, last):
            equal += 1 if left[k] > 0.0 else 0
        for gone in range(equal if equal < counted else 0):
            need = 1.0
            while need > (edge - z) * sum_of_rates:
                need -= (edge - z) * sum_of_rates
                z, edge = edge, edge + STRIDE
                sum_of_rates = _total_rate(marks, left, first, z + 0.5 * STRIDE, table, rates)
            z += need / sum_of_rates
            theirs = 1e-300
            for k in range(first, last):
                theirs += left[k] * rates[k]
            product *= (counted - gone) / (equal - gone) * min(theirs / sum_of_rates, 1.0)
            if not 1e-200 < product < 1e200:
                total += math.log(product)
                product = 1.0
            began = z if gone == 0 else began
            for k in range(first, last):
                goes = min(rates[k] / theirs, 1.0) * left[k]
                left[k] -= goes
                sum_of_rates -= goes * rates[k]
        for k in range(first, last):
            left[k], levels[k] = 0.0, 0.5 * (began + z)
        counted -= equal
        first = last
    return total + math.log(product)


@compiled_as_is
def log_touched(shares: Values, t: float, box: Box, states: States, noise: Values) -> float:
    """Return the log likelihood of what is touched, over that of a bare pad.

    Parameters
    ----------
    shares : ndarray, shape (rows, columns)
        Coverage of a window.
    t, box, states, noise
        As in `log_order`, `covered.covered` and `order_log_likelihood`.
    """
    present, sigma = 1.0 - noise[VOIDS], noise[SIGMA]
    total, product, known, shows = 0.0, 1.0, -1.0, 0.0
    for i in range(box[2]):
        for j in range(box[3]):
            state, c = states[box[0] + i, box[1] + j], shares[i, j]
            if c <= 0.0 or (state != ON and state != OFF):
                continue
            if c != known:
                known = c
                shows = 0.5 * present * math.erfc(-SQRT_HALF * (math.log(c) + t) / sigma)
            product *= 1.0 + shows / noise[STRAYS] if state == ON else 1.0 - shows
            if not 1e-200 < product < 1e200:
                total += math.log(product)
                product = 1.0
    return total + math.log(product)


@compiled_as_is
def order_log_likelihood(problem: OrderProblem, p: Values) -> float:
    """Return the log likelihood of touch and order over that of a bare pad.

    Parameters
    ----------
    problem : OrderProblem
    p : ndarray, shape (K,)
        The outline's numbers, t and, where it is estimated, the logarithm of sigma.
    """
    kind, corners, noise = problem.kind, problem.corners, noise_at(problem, p)
    box, share = shares_around(kind, corners, p, problem.grid, noise, problem.states.shape)
    t = p[unknowns(kind, corners)]
    along = shares_along(share, box, problem.order)
    table = hazards_at(problem.hazards, noise[SIGMA])
    levels = np.empty(problem.order.shape[0])
    return log_touched(share, t, box, problem.states, noise) + log_order(
        along, problem.ends, noise[SIGMA], t, table, levels
    )


@compiled_as_is
def noise_at(problem: OrderProblem, p: Values) -> Values:
    """Return the noise, with the sigma of a point that has one."""
    k = unknowns(problem.kind, problem.corners) + 1
    if p.shape[0] == k:
        return problem.noise
    noise = problem.noise.copy()
    noise[SIGMA] = math.exp(p[k])
    return noise


@compiled_as_is
def shares_along(share: Values, box: Box, order: Order) -> Values:
    """Return a window's coverage of the touched elements, those that read least first."""
    along = np.zeros(order.shape[0])
    for k in range(order.shape[0]):
        i, j = order[k, 0] - box[0], order[k, 1] - box[1]
        if 0 <= i < box[2] and 0 <= j < box[3]:
            along[k] = share[i, j]
    return along


def order_of(logs: Values, states: States) -> tuple[Order, Order]:
    """Return the touched elements, those that read least first, and where equal ones end."""
    cells = np.argwhere(states == ON)
    values = logs[states == ON]
    by = np.argsort(values, kind="stable")
    return cells[by], np.searchsorted(values[by], values[by], side="right")
