"""Whether an image looks like the model's at all: numbers that are normal where it does."""

from __future__ import annotations

import math

import numpy as np

from tactile_graph.compiled import compiled_as_is
from tactile_graph_likelihood.geometry.covered import window
from tactile_graph_likelihood.geometry.outlines import Values, unknowns
from tactile_graph_likelihood.single.element_terms import (
    LEAST,
    ON,
    ROOT_TWO_PI,
    SIGMA,
    SPAN,
    SQRT_HALF,
    STRAYS,
    UNKNOWN,
    VOIDS,
)
from tactile_graph_likelihood.single.log_posterior import noise_at
from tactile_graph_likelihood.single.patterns import dome, neighbours_alike, trend
from tactile_graph_likelihood.single.problem import Problem
from tactile_graph_likelihood.single.shares import foam_margin, shares_of

SURE = 1.5  # standard deviations of ln gain by which a covered element's load exceeds the least
SEEN = -1.0  # the same, for what reads a load at all
MOST = 3.5  # a stray's residual counts as no more
DENSITY = 1.0 / ROOT_TWO_PI


@compiled_as_is
def leaning_of(u: float, z: float, tail: float, density: float) -> float:
    """Return a residual of mean 0 and variance 1, given that it shows, which it does above -z.

    ``tail`` and ``density`` are Phi(z) and phi(z).
    """
    ratio = density / tail
    scaled = (u - ratio) / math.sqrt(1.0 - ratio * (z + ratio))
    return min(max(scaled, -MOST), MOST)


@compiled_as_is
def moments_of_strays(strays: float) -> tuple[float, float]:
    """Return mean and variance of the term of an element on which nothing is expected."""
    stray, bare = math.log(strays / SPAN), math.log(1.0 - strays)
    mean = strays * stray + (1.0 - strays) * bare
    return mean, strays * stray**2 + (1.0 - strays) * bare**2 - mean**2


@compiled_as_is
def moments_of_term(
    z: float, tail: float, density: float, level: float, present: float, bare: float
) -> tuple[float, float, float]:
    """Return the term of an expected element that reads nothing, and all terms' mean and variance.

    ``level`` is the largest log likelihood of a reading, ``present`` the share of elements that
    are no voids. With u normal and cut at -z, the mean of u**2 is ``Phi(z) - z phi(z)`` and that
    of u**4 ``3 Phi(z) - (z**3 + 3 z) phi(z)``.
    """
    none = 1.0 - present * tail
    off = bare + math.log(none)
    second = tail - z * density
    fourth = 3.0 * tail - (z * z * z + 3.0 * z) * density
    one = present * (level * tail - 0.5 * second) + none * off
    two = present * (level * level * tail - level * second + 0.25 * fourth)
    return off, one, two + none * off * off - one * one


@compiled_as_is
def misfit(problem: Problem, p: Values) -> tuple[float, float, float, float]:
    """Return how surprising an image is, and what patterns it leaves over.

    Parameters
    ----------
    problem, p
        As in `log_posterior.log_likelihood`; the point is the posterior mean.

    Returns
    -------
    (float, float, float, float)
        The log likelihood less its expectation under the model, less half the number of
        unknowns that were fitted, in its standard deviations: below -3 the readings are worse
        than the model's own. How alike neighbours' residuals are, how much they lean to a
        side, and how much they fall to the rim (see `patterns`), each in its standard deviations;
        a lean has 0 where there is none, by and large. Above 3 the model
        takes for many bumps what is one, or the load is not spread over the outline as it
        thinks, as under a tilt, foam or a curved face.
    """
    kind, corners, grid = problem.kind, problem.corners, problem.grid
    logs, states, first = problem.logs, problem.states, unknowns(problem.kind, problem.corners)
    rows, columns = states.shape
    here = noise_at(problem, p)
    box = window(kind, corners, p, grid, rows, columns, foam_margin(grid, here))
    share = np.zeros((max(box[2], 0), max(box[3], 0)))
    if box[2] > 0 and box[3] > 0:
        share = shares_of(kind, corners, p, grid, here, box, rows, columns)
    sigma, voids, strays = here[SIGMA], here[VOIDS], here[STRAYS]
    level = math.log((1.0 - strays) * (1.0 - voids) / (sigma * ROOT_TWO_PI))
    stray, bare = math.log(strays / SPAN), math.log(1.0 - strays)
    mean_bare, var_bare = moments_of_strays(strays)
    got = mean = variance = 0.0
    residuals, leaning = np.zeros((rows, columns)), np.zeros((rows, columns))
    for i in range(rows):
        for j in range(columns):
            if states[i, j] == UNKNOWN:
                continue
            on = states[i, j] == ON
            r, c = i - box[0], j - box[1]
            inside = 0 <= r < box[2] and 0 <= c < box[3]
            if not inside or share[r, c] <= 0.0:
                got += stray if on else bare
                mean += mean_bare
                variance += var_bare
                continue
            mu = math.log(share[r, c]) + p[first]
            z = min(max((mu - here[LEAST]) / sigma, -40.0), 40.0)
            tail, density = 0.5 * math.erfc(-SQRT_HALF * z), DENSITY * math.exp(-0.5 * z * z)
            off, one, spread = moments_of_term(z, tail, density, level, 1.0 - voids, bare)
            if on:
                u = (logs[i, j] - mu) / sigma
                got += math.log(math.exp(level - 0.5 * u * u) + strays / SPAN)
                residuals[i, j] = u if z > SURE else 0.0
                leaning[i, j] = leaning_of(u, z, tail, density) if z > SEEN else 0.0
            else:
                got += off
            mean += one
            variance += spread
    surprise = (got - 0.5 * p.shape[0] - mean) / math.sqrt(variance)
    lean, fall = trend(leaning, box[0], box[1], dome(share))
    return surprise, neighbours_alike(residuals), lean, fall
