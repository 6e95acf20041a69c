"""The logarithm of the posterior density of an outline, its load and, if asked, the noise.

The numbers of a point are the outline's own (see `outlines`), the logarithm of the load of a
fully covered element, and one for each part of the noise that is estimated with them: ln sigma,
the log odds of a void, ln of the foam's width, the pressure's fall and lean.
"""

from __future__ import annotations

import math

from tactile_graph.compiled import compiled_as_is
from tactile_graph_likelihood.geometry.outline_prior import log_prior
from tactile_graph_likelihood.geometry.outlines import Values, unknowns
from tactile_graph_likelihood.single.density.element_terms import (
    CONTRAST,
    FALL,
    SPAN,
    VOIDS,
    terms,
)
from tactile_graph_likelihood.single.density.load_shares import shares_around
from tactile_graph_likelihood.single.density.problem import Problem

LN_TWO_PI = math.log(2.0 * math.pi)
LEAST_CONTRAST = 0.25  # it is a power: at 0, all that is covered would read alike


@compiled_as_is
def noise_at(problem: Problem, p: Values) -> Values:
    """Return the noise at a point: the pad's own, but for what is estimated with the outline."""
    if problem.estimated.shape[0] == 0:
        return problem.noise
    found, first = problem.noise.copy(), unknowns(problem.kind, problem.corners) + 1
    for k in range(problem.estimated.shape[0]):
        place, value = problem.estimated[k], p[first + k]
        if place < FALL:
            value = math.exp(min(max(value, -30.0), 30.0))
        found[place] = value / (1.0 + value) if place == VOIDS else value
    found[CONTRAST] = min(max(found[CONTRAST], LEAST_CONTRAST), 1.0 / LEAST_CONTRAST)
    return found


@compiled_as_is
def log_likelihood(problem: Problem, p: Values) -> float:
    """Return the log likelihood of an image, over that of a bare pad, at a point, shape (K,)."""
    kind, corners, states = problem.kind, problem.corners, problem.states
    noise, load = noise_at(problem, p), p[unknowns(kind, corners)]
    box, shares = shares_around(kind, corners, p, problem.grid, noise, states.shape)
    return terms(shares, load, box[0], box[1], problem.logs, states, noise)


@compiled_as_is
def log_rest(problem: Problem, p: Values) -> float:
    """Return the log density of everything but the image: priors and belief."""
    total = log_prior(problem.kind, problem.corners, p, problem.prior)
    if total == -math.inf:
        return total
    first, guess = unknowns(problem.kind, problem.corners), problem.guess
    total -= math.log(SPAN)
    for k in range(guess.shape[0]):
        off = (p[first + 1 + k] - guess[k, 0]) / guess[k, 1]
        total -= 0.5 * (off * off + LN_TWO_PI) + math.log(guess[k, 1])
    belief, precision = problem.belief, problem.precision
    for i in range(first):
        for k in range(first):
            total -= 0.5 * (p[i] - belief[i]) * precision[i, k] * (p[k] - belief[k])
    return total
