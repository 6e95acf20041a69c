"""The posterior of an outline by touch and order: importance sampling in a few rounds."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np

from tactile_graph.compiled import compiled_as_is
from tactile_graph.errors import Degenerate
from tactile_graph_likelihood.by_order.goodness_of_fit import order_goodness_of_fit
from tactile_graph_likelihood.by_order.hazards import hazard_parts, hazards
from tactile_graph_likelihood.by_order.likelihood import (
    OrderProblem,
    order_log_likelihood,
    order_of,
)
from tactile_graph_likelihood.geometry.outline_prior import TURN, log_prior
from tactile_graph_likelihood.geometry.outlines import DISC, Values, period, sizes, unknowns
from tactile_graph_likelihood.single.density.element_terms import (
    ROOT_TWO_PI,
    SIGMA,
    STRAYS,
    VOIDS,
)
from tactile_graph_likelihood.single.density.goodness_of_fit import NO_FIT
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
ORDERLY, LIKELY, PRESSES = 0.5, 1.5, -1.5
"""Deviations by which the order, and it with touch, are likelier than they should be on a pad that
seems more even than told; the fall below which it is the face that presses more at its rim."""
LEAST_MORE = -7.0  # nats: evidence that no longer counts
EVENER, SIGMA_SPREAD = 1.0 / 3.0, 0.8
"""The middle of the guess at sigma on a pad that seems more even than told, over the told one, and
of its logarithm the standard deviation."""


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

    Notes
    -----
    Sigma is the model's own. Where touch and order are likelier than that lets them be, it is
    estimated, and believed as far as the evidence goes: too large a sigma makes outlines small.
    A frame that leaves a pattern, or whose rim reads more, is of another face instead.
    """
    noise = model.noise.vector(float(readings.grid[2]))
    prior = model.prior_vector(readings)
    if period.call(model.kind, model.corners) > 0.0:
        prior[TURN] = start.mean[2 + sizes.call(model.kind)]
    told = OrderProblem(
        model.kind, model.corners, readings.grid, readings.states, noise, prior,
        *order_of(readings.logs, readings.states),
        hazards(*noise[[STRAYS, VOIDS, SIGMA]].tolist())[None],
    )  # fmt: skip
    guess = np.array(((-math.log(model.noise.least), SPREAD),))
    enough = model.precision**-2 if worth is None else worth
    found, orderly = _posterior_of(model, told, guess, start, enough)
    if found.equal_points <= 0.0:
        raise Degenerate(f"{readings.touched} touched elements: no such outline explains them")
    likely = orderly > ORDERLY and found.surprise > LIKELY
    if not (likely and found.fits and found.fall > PRESSES):
        return found
    even = told._replace(hazards=hazard_parts(*noise[[STRAYS, VOIDS]].tolist()))
    guess = np.vstack((guess, (math.log(EVENER * noise[SIGMA]), SIGMA_SPREAD)))
    free, _ = _posterior_of(model, even, guess, found, enough)
    return _either(found, free, math.log(noise[SIGMA]))


def _either(told: Posterior, free: Posterior, log_sigma: float) -> Posterior:
    """Return the posterior by a sigma as told, or by one estimated: as likely, each, beforehand."""
    more = free.log_evidence - told.log_evidence
    if more < LEAST_MORE:
        return told
    n, chance = len(free.mean), 1.0 / (1.0 + math.exp(-more))
    with_told = np.insert(told.points, n - 1, log_sigma, axis=1)
    points = np.vstack((with_told, free.points))
    weights = np.concatenate(((1.0 - chance) * told.weights, chance * free.weights))
    mean, covariance = np.empty(n), np.empty((n, n))
    weighted_moments.call(points, weights, len(points), mean, covariance)
    top_of_told = np.append(told.most_likely, log_sigma)
    likelier = free if more > 0.0 else replace(told, most_likely=top_of_told)
    return replace(
        likelier, mean=mean, covariance=covariance, points=points, weights=weights,
        log_evidence=float(np.logaddexp(told.log_evidence, free.log_evidence)) - math.log(2.0),
        equal_points=1.0 / float(weights @ weights),
    )  # fmt: skip


def _posterior_of(
    model: Model, problem: OrderProblem, guess: Values, start: Posterior, enough: float
) -> tuple[Posterior, float]:
    """Return the posterior, and by how many deviations the order is likelier than it should be.

    ``guess`` has mean and standard deviation of what is estimated beside the outline, (M, 2).
    """
    kind, corners, pitch = model.kind, model.corners, float(problem.grid[2])
    first, more = unknowns.call(kind, corners), len(guess)
    n = first + more
    centre = np.concatenate((start.mean[:first], guess[:, 0]))
    spread = np.zeros((n, n))
    spread[:first, :first] = FIRST * start.covariance[:first, :first]
    floor = np.full(n, (APART * pitch) ** 2)
    floor[first:] = guess[:, 1] ** 2
    if period.call(kind, corners) > 0.0:
        k = 2 + sizes.call(kind)
        floor[k] /= max(float(start.mean[2:k].max()), pitch) ** 2
    plan = Plan(model.table_of(n), ROUND if kind == DISC else WIDE_ROUND, enough)
    draws = no_draws.call(len(plan.table), n)
    count, evidence, equal = sample_by_order.call(
        problem, guess, plan, centre, spread + np.diag(floor), draws
    )
    fit, orderly = NO_FIT, 0.0
    if equal > 0.0:
        fit, orderly = order_goodness_of_fit.call(problem, draws.mean)
    evidence -= float(np.log(guess[1:, 1] * ROOT_TWO_PI).sum())
    top = draws.points[int(np.argmax(draws.logs_p[:count]))].copy()
    found = Posterior(
        kind, corners, draws.mean, draws.covariance, draws.points[:count],
        draws.weights[:count], top, evidence, equal, *fit,
    )  # fmt: skip
    return found, orderly


@compiled_as_is
def sample_by_order(
    problem: OrderProblem, guess: Values, plan: Plan, centre: Values, covariance: Values,
    draws: Draws,
) -> tuple[int, float, float]:  # fmt: skip
    """Sample the posterior by touch and order in rounds, each around what those before have found.

    Parameters
    ----------
    problem : OrderProblem
    guess : ndarray, shape (M, 2)
        Mean and standard deviation of t and, where it is estimated, ln sigma.
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
                here += order_log_likelihood(problem, p)
                for k in range(guess.shape[0]):
                    off = (p[n - guess.shape[0] + k] - guess[k, 0]) / guess[k, 1]
                    here -= 0.5 * off * off
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
