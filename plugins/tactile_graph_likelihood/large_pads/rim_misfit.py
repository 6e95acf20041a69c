"""How surprising an image with a large outline is: its rim element by element, the rest counted."""

from __future__ import annotations

import math

import numpy as np

from tactile_graph.compiled import compiled_as_is
from tactile_graph_likelihood.geometry.covered import Box, covered, window
from tactile_graph_likelihood.geometry.outlines import Values, unknowns
from tactile_graph_likelihood.large_pads.rim_likelihood import log_likelihood_by_rim
from tactile_graph_likelihood.large_pads.rim_shares import rim_shares
from tactile_graph_likelihood.large_pads.rims import drawn_as, rim_count, runs_of
from tactile_graph_likelihood.single.covered_whole import Inside
from tactile_graph_likelihood.single.element_terms import (
    LEAST,
    ON,
    ROOT_TWO_PI,
    SIGMA,
    SQRT_HALF,
    STRAYS,
    UNKNOWN,
    VOIDS,
    bare,
)
from tactile_graph_likelihood.single.log_posterior import noise_at
from tactile_graph_likelihood.single.misfit import (
    SEEN,
    SURE,
    leaning_of,
    misfit,
    moments_of_strays,
    moments_of_term,
)
from tactile_graph_likelihood.single.patterns import dome, neighbours_alike, trend
from tactile_graph_likelihood.single.problem import Problem


@compiled_as_is
def misfit_at(problem: Problem, inside: Inside, p: Values) -> tuple[float, float, float, float]:
    """Return what `misfit.misfit` does, element by element or by the rim.

    Parameters
    ----------
    problem, p
        As there.
    inside : Inside
        As in `rim_likelihood.likelihood_at`.
    """
    rows, columns = problem.states.shape
    box = window(problem.kind, problem.corners, p, problem.grid, rows, columns, 0.0)
    if inside.runs.shape[0] == 0 or box[2] <= 0 or box[3] <= 0:
        return misfit(problem, p)
    share = covered(problem.kind, problem.corners, p, problem.grid, box)
    residuals, leaning = _residuals(problem, p, box, share)
    lean, fall = trend(leaning, 0, 0, dome(share))
    return surprise_by_rim(problem, inside, p), neighbours_alike(residuals), lean, fall


@compiled_as_is
def _residuals(problem: Problem, p: Values, box: Box, share: Values) -> tuple[Values, Values]:
    """Return a window's residuals, and the same freed of their bias from showing at all."""
    noise, load = noise_at(problem, p), p[unknowns(problem.kind, problem.corners)]
    residuals, leaning = np.zeros(share.shape), np.zeros(share.shape)
    last, mu, z, tail, density = 0.0, 0.0, 0.0, 0.0, 0.0
    for i in range(box[2]):
        for j in range(box[3]):
            its, row, column = share[i, j], box[0] + i, box[1] + j
            if its <= 0.0 or problem.states[row, column] != ON:
                continue
            if its != last:
                last, mu = its, math.log(its) + load
                z = _level(mu, noise)
                tail, density = _normal(z)
            u = (problem.logs[row, column] - mu) / noise[SIGMA]
            residuals[i, j] = u if z > SURE else 0.0
            leaning[i, j] = leaning_of(u, z, tail, density) if z > SEEN else 0.0
    return residuals, leaning


@compiled_as_is
def _level(mu: float, noise: Values) -> float:
    """Return the deviations of ln gain by which an expected load exceeds the least."""
    z: float = (mu - noise[LEAST]) / noise[SIGMA]
    return min(max(z, -40.0), 40.0)


@compiled_as_is
def _normal(z: float) -> tuple[float, float]:
    """Return the standard normal distribution and its density."""
    return 0.5 * math.erfc(-SQRT_HALF * z), math.exp(-0.5 * z * z) / ROOT_TWO_PI


@compiled_as_is
def surprise_at(problem: Problem, inside: Inside, p: Values) -> float:
    """Return the first of these numbers."""
    if inside.runs.shape[0] == 0:
        return misfit(problem, p)[0]
    return surprise_by_rim(problem, inside, p)


@compiled_as_is
def surprise_by_rim(problem: Problem, inside: Inside, p: Values) -> float:
    """Return `misfit`'s surprise, where a face is even and without foam.

    The likelihood is relative to that of a bare pad, and all elements that are covered whole have
    the same mean and variance of what they add.
    """
    kind, corners, grid, states = problem.kind, problem.corners, problem.grid, problem.states
    noise, load = noise_at(problem, p), p[unknowns(kind, corners)]
    rows, columns = states.shape
    known, whole, mean, variance = 0, 0, 0.0, 0.0
    for i in range(rows):
        for j in range(columns):
            known += 1 if states[i, j] != UNKNOWN else 0
    box = window(kind, corners, p, grid, rows, columns, 0.0)
    numbers, xy = drawn_as(kind, corners, p)
    runs = runs_of(numbers, xy, grid, box, 0.0)
    share = np.empty(rim_count(runs))
    rim_shares(numbers, xy, grid, box, runs, share)
    at = 0
    for i in range(box[2]):
        row = box[0] + i
        for part in range(2):
            for column in range(runs[i, 2 * part], runs[i, 2 * part + 1]):
                its = share[at]
                at += 1
                if its > 0.0 and states[row, column] != UNKNOWN:
                    one, spread = _moments_at(math.log(its) + load, noise)
                    mean += one
                    variance += spread
                    known -= 1
        for column in range(runs[i, 1], runs[i, 2]):
            whole += 1 if states[row, column] != UNKNOWN else 0
    one, spread = _moments_at(load, noise)
    bare_mean, bare_spread = moments_of_strays(noise[STRAYS])
    mean += whole * one + (known - whole) * bare_mean
    variance += whole * spread + (known - whole) * bare_spread
    got = log_likelihood_by_rim(problem, inside, p) + bare(states, noise)
    surprise: float = (got - 0.5 * p.shape[0] - mean) / math.sqrt(variance)
    return surprise


@compiled_as_is
def _moments_at(mu: float, noise: Values) -> tuple[float, float]:
    """Return mean and variance of the term of an element that expects a load's logarithm."""
    z = _level(mu, noise)
    tail, density = _normal(z)
    present, strays = 1.0 - noise[VOIDS], noise[STRAYS]
    level = math.log((1.0 - strays) * present / (noise[SIGMA] * ROOT_TWO_PI))
    _, one, spread = moments_of_term(z, tail, density, level, present, math.log(1.0 - strays))
    return one, spread
