"""The posterior of an outline by touch and order: importance sampling in a few rounds."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import replace
from functools import lru_cache

import numpy as np

from tactile_graph.errors import Degenerate
from tactile_graph_likelihood.by_order.goodness_of_fit import order_goodness_of_fit
from tactile_graph_likelihood.by_order.hazards import hazards
from tactile_graph_likelihood.by_order.likelihood import OrderProblem, order_log_densities, order_of
from tactile_graph_likelihood.geometry.outline_prior import TURN
from tactile_graph_likelihood.geometry.outlines import DISC, Values, period, sizes, unknowns
from tactile_graph_likelihood.single.even_points import even_points
from tactile_graph_likelihood.single.importance import (
    FEWEST,
    FREEDOM,
    KEPT,
    WIDER,
    temper,
    weigh,
    weighted_moments,
)
from tactile_graph_likelihood.single.model import Model
from tactile_graph_likelihood.single.posterior import Posterior
from tactile_graph_likelihood.single.readings import Readings

ROUND = 32  # points
WIDE_ROUND = 128  # of outlines with an angle or corners: a void at an end looks like the end
MOST = 1024
FIRST = 3.0  # the first one's over that of the start
APART = 0.15  # of a pitch: standard deviation that the first adds to every length
SPREAD = 2.0  # of ln of the share that shows, before a frame is read


def order_posterior(
    model: Model, readings: Readings, start: Posterior, worth: float | None = None
) -> Posterior:
    """Return the posterior by touch and order.

    Parameters
    ----------
    model : Model
        Its least load that shows is the share of an element that does, before a frame is read.
    readings : Readings
        Of any monotone quantity.
    start : Posterior
        A rough one of the same outline.
    worth : float
        Number of equal weights at which to end; the model's own if not given.

    Raises
    ------
    Degenerate
        If no outline explains what is touched.
    """
    first = unknowns.call(model.kind, model.corners)
    pitch = float(readings.grid[2])
    noise, middle = model.noise.vector(pitch), -math.log(model.noise.least)
    prior = model.prior_vector(readings)
    if (turned := period.call(model.kind, model.corners)) > 0.0:
        prior[TURN] = start.mean[2 + sizes.call(model.kind)]
    problem = OrderProblem(
        model.kind, model.corners, readings.grid, readings.states, noise, prior,
        *order_of(readings.logs, readings.states), hazards(noise),
    )  # fmt: skip

    def density(points: Values) -> Values:
        found = order_log_densities.call(problem, points)
        off = (points[:, first] - middle) / SPREAD
        return np.asarray(found - 0.5 * off * off)

    enough = model.precision**-2 if worth is None else worth
    centre = np.append(start.mean[:first], middle)
    spread = np.zeros((first + 1, first + 1))
    spread[:first, :first] = FIRST * start.covariance[:first, :first]
    floor = np.full(first + 1, (APART * pitch) ** 2)
    floor[first] = SPREAD**2
    if turned > 0.0:
        k = 2 + sizes.call(model.kind)
        floor[k] /= max(float(start.mean[2:k].max()), pitch) ** 2
    found = _sampled(model, readings, density, centre, spread + np.diag(floor), enough)
    fit = order_goodness_of_fit.call(problem, found.mean)
    return replace(found, **fit._asdict())


def _sampled(
    model: Model,
    readings: Readings,
    density: Callable[[Values], Values],
    centre: Values,
    spread: Values,
    worth: float,
) -> Posterior:
    """Return the posterior from rounds of points, each around what those before it have found."""
    n, step = len(centre), ROUND if model.kind == DISC else WIDE_ROUND
    table, rounds = _table(n, model.seed), MOST // step
    points, logs_p = np.empty(table.shape), np.empty(len(table))
    logs_q = np.full((rounds, len(table)), -math.inf)
    weights, flat = np.empty(len(table)), np.empty(len(table))
    mean, matrix, aim = np.empty(n), np.empty((n, n)), centre
    proposals: list[tuple[Values, Values]] = []
    evidence, equal, count = -math.inf, 0.0, 0
    for turn in range(rounds):
        proposals.append((aim.copy(), np.asarray(np.linalg.cholesky(spread), np.float64)))
        now = slice(count, count + step)
        points[now] = aim + table[now] @ proposals[-1][1].T
        logs_p[now] = density(points[now])
        count += step
        for c, (middle, root) in enumerate(proposals):
            here = slice(0 if c == turn else count - step, count)
            logs_q[c, here] = _log_density(points[here] - middle, root)
        shares = np.full(turn + 1, 1.0 / (turn + 1))
        evidence, equal = weigh.call(logs_p, logs_q, shares, turn + 1, count, weights)
        if equal <= 0.0:
            raise Degenerate(f"{readings.touched} touched elements: no such outline explains them")
        weighted_moments.call(points, weights, count, mean, matrix)
        if equal >= worth:
            break
        temper.call(weights, count, FEWEST * n, flat)
        aim, wide = np.empty(n), np.empty((n, n))
        weighted_moments.call(points, flat, count, aim, wide)
        spread = WIDER * wide + KEPT * spread
    top = points[int(np.argmax(logs_p[:count]))].copy()
    return Posterior(
        model.kind, model.corners, mean, matrix, points[:count], weights[:count], top, evidence,
        equal, 0.0, 0.0,
    )  # fmt: skip


def _log_density(off: Values, root: Values) -> Values:
    """Return the log density of Student's t with a covariance root, shape (N,)."""
    n = len(root)
    z = np.linalg.solve(root, off.T)
    constant = math.lgamma(0.5 * (FREEDOM + n)) - math.lgamma(0.5 * FREEDOM)
    constant -= 0.5 * n * math.log(FREEDOM * math.pi) + float(np.log(np.diag(root)).sum())
    return np.asarray(constant - 0.5 * (FREEDOM + n) * np.log1p((z * z).sum(axis=0) / FREEDOM))


@lru_cache(maxsize=16)
def _table(n: int, seed: int) -> Values:
    table = even_points(MOST, n, seed)
    table.setflags(write=False)
    return table
