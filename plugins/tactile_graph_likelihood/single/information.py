"""Slopes of the log posterior along a point's numbers, and what information there is on each."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from tactile_graph.compiled import compiled_as_is
from tactile_graph_likelihood.geometry.covered import Box, window
from tactile_graph_likelihood.geometry.outlines import Values, period, sizes, unknowns
from tactile_graph_likelihood.single.element_terms import (
    FOAM,
    LEAST,
    OFF,
    ON,
    OVER,
    SIGMA,
    SQRT_HALF,
    UNKNOWN,
    VOIDS,
    on_level,
    over_odds,
)
from tactile_graph_likelihood.single.load_shares import foam_margin, is_even, shares_of
from tactile_graph_likelihood.single.log_posterior import noise_at
from tactile_graph_likelihood.single.problem import Problem

STEP = 0.02  # of a pitch: over which coverage is differenced
FOAM_STEP = 0.005
PRESSURE_STEP = 0.01
SLIVER = 0.1  # covered less, an element's slope is no guide to how far the outline may go
DENSITY = 1.0 / math.sqrt(2.0 * math.pi)


class Information(NamedTuple):
    """A log density's slope along a point's numbers, (K,), and the information on them, (K, K)."""

    slope: Values
    matrix: Values


@compiled_as_is
def steps_of(kind: int, corners: int, p: Values, grid: Values) -> Values:
    """Return over how much each of an outline's numbers is varied to difference its coverage."""
    first = unknowns(kind, corners)
    out = np.full(first, STEP * grid[2])
    if period(kind, corners) > 0.0:
        n = 2 + sizes(kind)
        out[n] = STEP * grid[2] / max(p[2], p[n - 1])
    return out


@compiled_as_is
def _rises(problem: Problem, p: Values, noise: Values, box: Box) -> tuple[Values, Values]:
    """Return coverage of a window, and its slope along each number of a point, (K, rows, cols)."""
    kind, corners, grid, estimated = problem.kind, problem.corners, problem.grid, problem.estimated
    first, (rows, columns) = unknowns(kind, corners), problem.states.shape
    share = shares_of(kind, corners, p, grid, noise, box, rows, columns)
    rise = np.zeros((p.shape[0], box[2], box[3]))
    steps, at = steps_of(kind, corners, p, grid), p.copy()
    for k in range(first):
        at[k] += steps[k]
        moved = shares_of(kind, corners, at, grid, noise, box, rows, columns)
        at[k] = p[k]
        for i in range(box[2]):
            for j in range(box[3]):
                rise[k, i, j] = (moved[i, j] - share[i, j]) / steps[k]
    for k in range(estimated.shape[0]):
        place = estimated[k]
        if place < FOAM:
            continue
        other, step = noise.copy(), FOAM_STEP if place == FOAM else PRESSURE_STEP
        other[place] = noise[FOAM] * math.exp(step) if place == FOAM else noise[place] + step
        moved = shares_of(kind, corners, p, grid, other, box, rows, columns)
        for i in range(box[2]):
            for j in range(box[3]):
                rise[first + 1 + k, i, j] = (moved[i, j] - share[i, j]) / step
    return share, rise


@compiled_as_is
def score_of(state: int, log: float, mu: float, noise: Values, level: float) -> tuple[float, ...]:
    """Return what an element's reading says of the logarithm mu of its expected load.

    ``log`` is that of its reading, of the least load that shows where it reads nothing, of the load
    at which readings end where it reads the most.

    Returns
    -------
    tuple of float
        The slope of its log likelihood, its information; the chance that it is no stray and its
        residual, where it reads a load; the chance that its load shows, where it reads none or
        the most.
    """
    sigma, present = noise[SIGMA], 1.0 - noise[VOIDS]
    if state == ON:
        u = (log - mu) / sigma
        a = min(max(level - 0.5 * u * u, -700.0), 700.0)
        chance = 1.0 / (1.0 + math.exp(-a))
        return chance * u / sigma, chance / (sigma * sigma), chance, u, 0.0
    z = (mu - log) / sigma
    tail = 0.5 * math.erfc(-SQRT_HALF * z)
    if state == OVER:
        odds = over_odds(noise)
        score = odds * DENSITY * math.exp(-0.5 * z * z) / (sigma * (1.0 + odds * tail))
        return score, score * score, odds * tail / (1.0 + odds * tail), z, tail
    score = -present * DENSITY * math.exp(-0.5 * z * z) / (sigma * (1.0 - present * tail))
    return score, score * score, 1.0, z, tail


@compiled_as_is
def add_noise_slopes(
    state: int, score: tuple[float, ...], problem: Problem, noise: Values, out: Information
) -> None:
    """Add what an element's reading says of the sigma and the voids that are estimated."""
    voids, chance, u, tail = noise[VOIDS], score[2], score[3], score[4]
    first, estimated = unknowns(problem.kind, problem.corners), problem.estimated
    slope, matrix = out.slope, out.matrix
    for k in range(estimated.shape[0]):
        m = first + 1 + k
        if estimated[k] == SIGMA:
            on = state == ON
            slope[m] += chance * (u * u - 1.0) if on else -score[0] * noise[SIGMA] * u
            matrix[m, m] += 2.0 * chance if on else 0.0
        elif estimated[k] == VOIDS:
            none = 1.0 - (1.0 - voids) * tail
            shows = state in (ON, OVER)
            slope[m] += -voids * chance if shows else voids * (1.0 - voids) * tail / none
            matrix[m, m] += voids * (1.0 - voids)


@compiled_as_is
def information(problem: Problem, p: Values, out: Information) -> None:
    """Write the slope of the log likelihood at a point, and an information matrix.

    Parameters
    ----------
    problem, p
        As in `log_posterior.log_likelihood`.
    out : Information
        Written.

    Notes
    -----
    With mu the logarithm of an element's expected load, a touched one adds its chance of being
    no stray over sigma**2 times the outer product of the slopes of mu, an untouched one its
    squared score: positive whatever was read. Coverage is differenced over 0.02 of a pitch.
    """
    kind, corners, grid, estimated = problem.kind, problem.corners, problem.grid, problem.estimated
    first, slope, matrix = unknowns(kind, corners), out.slope, out.matrix
    rows, columns = problem.states.shape
    noise = noise_at(problem, p)
    margin = foam_margin(grid, noise) + grid[2] * STEP
    box = window(kind, corners, p, grid, rows, columns, margin)
    slope[:] = 0.0
    matrix[:] = 0.0
    if box[2] <= 0 or box[3] <= 0:
        return
    share, rise = _rises(problem, p, noise, box)
    n, level = p.shape[0], on_level(noise)
    plain = noise[FOAM] <= 0.0 and grid[4] <= 0.0 and is_even(noise)
    along = np.zeros(n)
    along[first] = 1.0
    for i in range(box[2]):
        for j in range(box[3]):
            state, its = problem.states[box[0] + i, box[1] + j], share[i, j]
            if its <= 0.0 or state == UNKNOWN:
                continue
            mu = p[first] if its == 1.0 else math.log(its) + p[first]
            log = noise[LEAST] if state == OFF else problem.logs[box[0] + i, box[1] + j]
            score = score_of(state, log, mu, noise, level)
            add_noise_slopes(state, score, problem, noise, out)
            edge = its < 1.0 or not plain
            for k in range(first):
                along[k] = rise[k, i, j] / max(its, SLIVER)
                edge = edge or along[k] != 0.0
            for k in range(estimated.shape[0]):
                along[first + 1 + k] = rise[first + 1 + k, i, j] / its
                edge = edge or along[first + 1 + k] != 0.0
            if edge:
                add_outer(score, along, out)
            else:
                slope[first] += score[0]
                matrix[first, first] += score[1]
    for k in range(n):
        for m in range(k):
            matrix[m, k] = matrix[k, m]


@compiled_as_is
def add_outer(score: tuple[float, ...], along: Values, out: Information) -> None:
    """Add an element's slope and information along all numbers."""
    for k in range(along.shape[0]):
        out.slope[k] += score[0] * along[k]
        for m in range(k + 1):
            out.matrix[k, m] += score[1] * along[k] * along[m]


@compiled_as_is
def add_prior(problem: Problem, p: Values, out: Information) -> None:
    """Add what the priors say to a slope and an information matrix."""
    first, guess = unknowns(problem.kind, problem.corners), problem.guess
    slope, matrix = out.slope, out.matrix
    for k in range(2, 2 + sizes(problem.kind)):
        slope[k] -= 1.0 / p[k]
    for k in range(guess.shape[0]):
        m, width = first + 1 + k, guess[k, 1] * guess[k, 1]
        slope[m] -= (p[m] - guess[k, 0]) / width
        matrix[m, m] += 1.0 / width
    belief, precision = problem.belief, problem.precision
    for i in range(first):
        for k in range(first):
            slope[i] -= precision[i, k] * (p[k] - belief[k])
            matrix[i, k] += precision[i, k]
