"""The posterior of an outline by touch and order: importance sampling in a few rounds."""

from __future__ import annotations

import math

import numpy as np

from tactile_graph.compiled import compiled_as_is
from tactile_graph.errors import Degenerate
from tactile_graph_likelihood.by_order.goodness_of_fit import order_goodness_of_fit
from tactile_graph_likelihood.by_order.hazards import hazards
from tactile_graph_likelihood.by_order.likelihood import (
    OrderProblem,
    order_log_likelihood,
    order_of,
)
from tactile_graph_likelihood.geometry.outline_prior import TURN, log_prior
from tactile_graph_likelihood.geometry.outlines import DISC, Values, period, sizes, unknowns
from tactile_graph_likelihood.single.density.element_terms import SIGMA, STRAYS, VOIDS
from tactile_graph_likelihood.single.model import Model
from tactile_graph_likelihood.single.posterior import Posterior
from tactile_graph_likelihood.single.readings import Readings
from tactile_graph_likelihood.single.sampling.importance import weigh, weighted_moments
from tactile_graph_likelihood.single.sampling.sample import (
    Draws,
    Plan,
    draw,
    log_evidence_of,
    next_covariance,
    no_draws,
    no_proposals,
    propose,
    take_block,
)

ROUND = 32  # points
WIDE_ROUND = 128  # of outlines with an angle or corners: a void at an end looks like the end
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
        *order_of(readings.logs, readings.states), hazards(*noise[[STRAYS, VOIDS, SIGMA]].tolist()),
    )  # fmt: skip

    enough = model.precision**-2 if worth is None else worth
    centre = np.append(start.mean[:first], middle)
    spread = np.zeros((first + 1, first + 1))
    spread[:first, :first] = FIRST * start.covariance[:first, :first]
    floor = np.full(first + 1, (APART * pitch) ** 2)
    floor[first] = SPREAD**2
    if turned > 0.0:
        k = 2 + sizes.call(model.kind)
        floor[k] /= max(float(start.mean[2:k].max()), pitch) ** 2
    plan = Plan(model.table_of(first + 1), ROUND if model.kind == DISC else WIDE_ROUND, enough)
    draws = no_draws.call(len(plan.table), first + 1)
    count, evidence, equal = sample_by_order.call(
        problem, middle, plan, centre, spread + np.diag(floor), draws
    )
    if equal <= 0.0:
        raise Degenerate(f"{readings.touched} touched elements: no such outline explains them")
    top = draws.points[int(np.argmax(draws.logs_p[:count]))].copy()
    fit = order_goodness_of_fit.call(problem, draws.mean)
    return Posterior(
        model.kind, model.corners, draws.mean, draws.covariance, draws.points[:count],
        draws.weights[:count], top, evidence, equal, *fit,
    )  # fmt: skip


@compiled_as_is
def sample_by_order(
    problem: OrderProblem, middle: float, plan: Plan, centre: Values, covariance: Values,
    draws: Draws,
) -> tuple[int, float, float]:  # fmt: skip
    """Sample the posterior by touch and order in rounds, each around what those before have found.

    Parameters
    ----------
    problem : OrderProblem
    middle : float
        Of the guess of t.
    plan : Plan
    centre, covariance : ndarray, shape (K,) and (K, K)
        Of the first round's proposal.
    draws : Draws
        Written.

    Returns
    -------
    (int, float, float)
        As of `sample.importance_sample`.
    """
    n, block, most = centre.shape[0], plan.block, plan.table.shape[0]
    proposals, wanted, aim = no_proposals(most // block, n, most), covariance, centre.copy()
    count, evidence, equal = 0, -math.inf, 0.0
    for turn in range(most // block):
        if turn > 0:
            wanted = next_covariance(draws, count, wanted, aim)
        if not propose(proposals, turn, aim, wanted):
            break
        for i in range(count, count + block):
            draw(proposals, turn, plan.table[i], draws.points[i])
            p = draws.points[i]
            here = log_prior(problem.kind, problem.corners, p, problem.prior)
            if here > -math.inf:
                off = (p[n - 1] - middle) / SPREAD
                here += order_log_likelihood(problem, p) - 0.5 * off * off
            draws.logs_p[i] = here
        take_block(proposals, turn + 1, draws.points, 0, count, block)
        count += block
        shares = proposals.drawn / count
        evidence, equal = weigh(
            draws.logs_p, proposals.densities, shares, turn + 1, count, draws.weights
        )
        if equal <= 0.0 or equal >= plan.worth:
            break
    weighted_moments(draws.points, draws.weights, count, draws.mean, draws.covariance)
    return count, log_evidence_of(proposals, evidence, n), equal
