"""How likely it is what is touched, and in which order elements read: no law is used.

An element of coverage c bears the load ``c W``, W of Weibull's distribution with the shape
``a = 0.8 / sigma``; beyond the least load ``exp(-t)`` it is touched, but for voids:

    P(touched) = (1 - v) exp(-(c exp(t))**-a)

Loads to the power a are then arrival times at the rates ``c**-a``, and what has not arrived by
any time is as it was at the start. The order of the touched ones, lightest first, has

    P(order) = product over i of  rate_i / (sum of the rates of those not lighter)

(R. L. Plackett 1975, 10.2307/2346567), whatever monotone law turned load into readings.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from tactile_graph.compiled import compiled_as_is
from tactile_graph_likelihood.covered import blurred, covered, window
from tactile_graph_likelihood.element_terms import (
    FOAM,
    OFF,
    ON,
    SIGMA,
    STRAYS,
    VOIDS,
    States,
)
from tactile_graph_likelihood.outline_prior import log_prior
from tactile_graph_likelihood.outlines import Values, unknowns
from tactile_graph_likelihood.shares import foam_margin

Order = NDArray[np.int64]

WIDTH = 0.8
"""Weibull's shape times sigma. At pi / sqrt(6) the logarithm's deviation would be sigma; gains are
lognormal, and wider tails gave radii without a bias on simulated pads of four laws."""

LEAST_SHARE = 1e-3
"""Coverage below it ranks as it does: a reading is no worse than a slip of the pad."""

_LEGENDRE = np.polynomial.legendre.leggauss(24)
NODES, HALVES = 0.5 * (_LEGENDRE[0] + 1.0), 0.5 * _LEGENDRE[1]


@compiled_as_is
def log_order(shares: Values, ends: Order, shape: float) -> float:
    """Return the log probability of an order, over that of all orders being alike.

    Parameters
    ----------
    shares : ndarray, shape (n,)
        Coverage of the touched elements, those that read least first; 0 where uncovered: such an
        element's place in the order tells nothing.
    ends : ndarray of int, shape (n,)
        For each element the place after the last that reads the same.
    shape : float
        Weibull's.

    Notes
    -----
    That all of a set of equal readings are lighter than the rest, of rates R in all, has the
    probability of the integral over u from 0 to 1 of ``product (1 - u**(rate_i / R))``: u is the
    chance that none of the rest has arrived (R. DeLong et al. 1994, 10.1093/biomet/81.3.607).
    Those that read most of all are certain to come last.
    """
    total, product, rest, counted = 0.0, 1.0, 0.0, 0
    last = shares.shape[0] - 1
    while last >= 0:
        first = last
        while first > 0 and ends[first - 1] == last + 1:
            first -= 1
        rates, equal = 0.0, 0
        for i in range(first, last + 1):
            if shares[i] > 0.0:
                rates += 1.0 if shares[i] == 1.0 else max(shares[i], LEAST_SHARE) ** -shape
                equal += 1
        if rest > 0.0 and equal == 1:
            product *= (counted + 1.0) * rates / (rates + rest)
            if not 1e-200 < product < 1e200:
                total += math.log(product)
                product = 1.0
        elif rest > 0.0 and equal > 1:
            total += _log_before(shares[first : last + 1], shape, rest)
            total += math.lgamma(counted + equal + 1.0) - math.lgamma(counted + 1.0)
            total -= math.lgamma(equal + 1.0)
        rest += rates
        counted += equal
        last = first - 1
    return total + math.log(product)


@compiled_as_is
def _log_before(shares: Values, shape: float, rest: float) -> float:
    """Return the log probability that all of a set arrive before any of the rest."""
    total = 0.0
    for k in range(NODES.shape[0]):
        log_u, product = math.log(NODES[k]), 1.0
        for i in range(shares.shape[0]):
            if shares[i] > 0.0:
                product *= -math.expm1(max(shares[i], LEAST_SHARE) ** -shape / rest * log_u)
        total += HALVES[k] * product
    return math.log(max(total, 1e-300))


@compiled_as_is
def order_log_likelihood(
    kind: int,
    corners: int,
    p: Values,
    grid: Values,
    states: States,
    order: Order,
    ends: Order,
    noise: Values,
) -> float:
    """Return the log likelihood of touch and order over that of a bare pad.

    Parameters
    ----------
    kind, corners, grid, states, noise
        As in `log_posterior`; the least load that shows is not looked at.
    p : ndarray, shape (K,)
        The outline's numbers, and t.
    order : ndarray of int, shape (n, 2)
        Row and column of the touched elements, those that read least first.
    ends : ndarray of int, shape (n,)
        As in `log_order`.
    """
    rows, columns = states.shape
    box = window(kind, corners, p, grid, rows, columns, foam_margin(grid, noise))
    if box[2] <= 0 or box[3] <= 0:
        return 0.0
    share = covered(kind, corners, p, grid, box)
    if noise[FOAM] > 0.0:
        share = blurred(share, noise[FOAM], box, rows, columns)
    t, present = p[unknowns(kind, corners)], 1.0 - noise[VOIDS]
    a = WIDTH / noise[SIGMA]
    product, known, shows = 1.0, -1.0, 0.0
    total = 0.0
    for i in range(box[2]):
        for j in range(box[3]):
            state, c = states[box[0] + i, box[1] + j], share[i, j]
            if c <= 0.0 or (state != ON and state != OFF):
                continue
            if c != known:
                known = c
                late = min(-a * (math.log(c) + t), 300.0)
                shows = present * math.exp(-math.exp(late))
            product *= 1.0 + shows / noise[STRAYS] if state == ON else 1.0 - shows
            if not 1e-200 < product < 1e200:
                total += math.log(product)
                product = 1.0
    total += math.log(product)
    along = np.zeros(order.shape[0])
    for k in range(order.shape[0]):
        i, j = order[k, 0] - box[0], order[k, 1] - box[1]
        if 0 <= i < box[2] and 0 <= j < box[3]:
            along[k] = share[i, j]
    return total + log_order(along, ends, a)


@compiled_as_is
def order_log_densities(
    kind: int,
    corners: int,
    points: Values,
    grid: Values,
    states: States,
    order: Order,
    ends: Order,
    noise: Values,
    prior: Values,
) -> Values:
    """Return `order_log_likelihood` plus the outline's log prior of many points, shape (N, K)."""
    out = np.empty(points.shape[0])
    for k in range(points.shape[0]):
        out[k] = log_prior(kind, corners, points[k], prior)
        if out[k] > -math.inf:
            out[k] += order_log_likelihood(
                kind, corners, points[k], grid, states, order, ends, noise
            )
    return out


def ranked(logs: Values, states: States) -> tuple[Order, Order]:
    """Return the touched elements, those that read least first, and where equal ones end."""
    cells = np.argwhere(states == ON)
    values = logs[states == ON]
    by = np.argsort(values, kind="stable")
    return cells[by], np.searchsorted(values[by], values[by], side="right")
