"""Slopes of the log posterior along a point's numbers, and what information there is on each."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from tactile_graph.compiled import compiled_as_is
from tactile_graph_likelihood.geometry.covered import Box, covered, window
from tactile_graph_likelihood.geometry.outlines import Values, period, sizes, unknowns
from tactile_graph_likelihood.geometry.rim_slopes import covered_with_slopes, has_slopes
from tactile_graph_likelihood.single.density.element_terms import (
    CONTRAST,
    FALL,
    FOAM,
    LEAN_Y,
    LEAST,
    OFF,
    ON,
    OVER,
    SIGMA,
    SQRT_HALF,
    UNDER,
    UNFELT,
    UNKNOWN,
    VOIDS,
    on_level,
    over_odds,
)
from tactile_graph_likelihood.single.density.load_shares import (
    blurred,
    foam_margin,
    is_even,
    passed_on,
    press,
    shares_of,
)
from tactile_graph_likelihood.single.density.log_posterior import noise_at
from tactile_graph_likelihood.single.density.pressure_slopes import (
    Laid,
    is_pressed,
    press_with_slopes,
)
from tactile_graph_likelihood.single.density.problem import Places, Problem

STEP = 0.02  # of a pitch: over which coverage is differenced
FOAM_STEP = 0.005
PRESSURE_STEP = 0.01
SLIVER = 0.1  # read less, an element's slope is no guide to how far the outline may go
DENSITY = 1.0 / math.sqrt(2.0 * math.pi)
MOST_EXPONENT = 300.0  # beyond which a chance is 0 or 1
MOST_ODDS = 1e150  # of many elements, multiplied, at which their logarithm is taken


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


class Scatter(NamedTuple):
    """How readings scatter: a noise vector's sigma and voids, `on_level` and `over_odds` of it."""

    sigma: float
    voids: float
    level: float
    odds: float


class Score(NamedTuple):
    """What readings say: slopes of their log likelihood and information on what it depends on.

    ``load`` is along the logarithm of the expected load, ``sigma`` along ln sigma, ``voids`` along
    the log odds of a void.
    """

    load: float
    load_information: float
    sigma: float
    sigma_information: float
    voids: float
    voids_information: float


NO_SCORE = Score(0.0, 0.0, 0.0, 0.0, 0.0, 0.0)


@compiled_as_is
def scatter_of(noise: Values) -> Scatter:
    """Return a noise vector's scatter of readings."""
    return Scatter(noise[SIGMA], noise[VOIDS], on_level(noise), over_odds(noise))


@compiled_as_is
def score_of(state: int, log: float, mu: float, scatter: Scatter) -> tuple[float, Score]:
    """Return what an element's reading says, given the logarithm mu of its expected load.

    That is how many times likelier it is than on a bare pad, as in `element_terms.terms`, and its
    score.

    ``log`` is that of its reading, of the least load that shows where it reads nothing, of the load
    at which readings end where it reads the most. Of arguments and results none is an array: that
    would cost more than all the rest.
    """
    sigma, voids, level, odds = scatter
    some = voids * (1.0 - voids)
    if state == ON:
        u = (log - mu) / sigma
        by_load = math.exp(min(max(level - 0.5 * u * u, -MOST_EXPONENT), MOST_EXPONENT))
        chance = by_load / (1.0 + by_load)
        weight = chance / (sigma * sigma)
        return 1.0 + by_load, Score(
            chance * u / sigma, weight, chance * (u * u - 1.0), 2.0 * chance, -voids * chance, some
        )
    z = (mu - log) / sigma
    tail, density = 0.5 * math.erfc(-SQRT_HALF * z), DENSITY * math.exp(-0.5 * z * z)
    if state == OVER:
        likely = 1.0 + odds * tail
        score, by_voids = odds * density / (sigma * likely), -voids * odds * tail / likely
    else:
        likely = 1.0 - (1.0 - voids) * tail
        score, by_voids = (voids - 1.0) * density / (sigma * likely), some * tail / likely
    return likely, Score(score, score * score, -score * sigma * z, 0.0, by_voids, some)


@compiled_as_is
def summed(total: Score, more: Score, times: float) -> Score:
    """Return a score with another one added so many times."""
    return Score(
        total.load + times * more.load,
        total.load_information + times * more.load_information,
        total.sigma + times * more.sigma,
        total.sigma_information + times * more.sigma_information,
        total.voids + times * more.voids,
        total.voids_information + times * more.voids_information,
    )


@compiled_as_is
def number_of_contrast(problem: Problem) -> int:
    """Return which of a point's numbers is the contrast, -1 where none is."""
    for k in range(problem.estimated.shape[0]):
        if problem.estimated[k] == CONTRAST:
            return unknowns(problem.kind, problem.corners) + 1 + k
    return -1


@compiled_as_is
def add_score(problem: Problem, score: Score, out: Information) -> None:
    """Add what readings say of the load, where nothing else moves it, and of their scatter.

    With that the matrix is done: its upper half is written as well.
    """
    first, estimated = unknowns(problem.kind, problem.corners), problem.estimated
    slope, matrix = out.slope, out.matrix
    slope[first] += score.load
    matrix[first, first] += score.load_information
    for k in range(estimated.shape[0]):
        m = first + 1 + k
        if estimated[k] == SIGMA:
            slope[m] += score.sigma
            matrix[m, m] += score.sigma_information
        elif estimated[k] == VOIDS:
            slope[m] += score.voids
            matrix[m, m] += score.voids_information
    mirror(matrix)


@compiled_as_is
def add_outer(score: Score, along: Values, out: Information) -> None:
    """Add an element's slope and information along what moves its load: lower half only.

    ``along`` may leave out the last of a point's numbers.
    """
    slope, matrix, by, weight = out.slope, out.matrix, score.load, score.load_information
    for k in range(along.shape[0]):
        slope[k] += by * along[k]
        row = weight * along[k]
        for m in range(k + 1):
            matrix[k, m] += row * along[m]


@compiled_as_is
def without_load(score: Score) -> Score:
    """Return what a score says of the scatter alone."""
    return Score(
        0.0, 0.0, score.sigma, score.sigma_information, score.voids, score.voids_information
    )


@compiled_as_is
def mirror(matrix: Values) -> None:
    """Write a symmetric matrix' upper half."""
    for k in range(matrix.shape[0]):
        for m in range(k):
            matrix[m, k] = matrix[k, m]


@compiled_as_is
def _rises(problem: Problem, p: Values, noise: Values, box: Box) -> tuple[Values, Values]:
    """Return shares of a window, and their slope along a point's first numbers, (N, rows, cols).

    Those are all up to the last that brings another load to elements.
    """
    kind, corners, grid, estimated = problem.kind, problem.corners, problem.grid, problem.estimated
    first, (rows, columns) = unknowns(kind, corners), problem.states.shape
    moving = first + 1
    for k in range(estimated.shape[0]):
        if estimated[k] not in (SIGMA, VOIDS):
            moving = first + 2 + k
    rise = np.zeros((moving, box[2], box[3]))
    laid = Laid(kind, corners, p, grid, noise, box)
    share, pressed = shares_with_slopes(laid, rows, columns, estimated, rise)
    for k in range(estimated.shape[0]):
        place = estimated[k]
        if place == FOAM:
            wider = blurred(pressed, noise[FOAM] * math.exp(FOAM_STEP), box, rows, columns)
            rise[first + 1 + k] = (wider - share) / FOAM_STEP
        elif FALL <= place <= LEAN_Y and not has_slopes(kind):
            other = noise.copy()
            other[place] += PRESSURE_STEP
            moved = shares_of(kind, corners, p, grid, other, box, rows, columns)
            rise[first + 1 + k] = (moved - share) / PRESSURE_STEP
    return share, rise


@compiled_as_is
def shares_with_slopes(
    laid: Laid, rows: int, columns: int, estimated: Places, rise: Values
) -> tuple[Values, Values]:
    """Return `load_shares.shares_of`, with foam and without; write slopes along a point's numbers.

    Those of the outline, and of the pressure where coverage has exact ones; others are differenced.
    ``rise`` is zeros, shape (N, rows, cols) of the box.
    """
    kind, corners, p, grid, noise, box = laid
    first, steps = unknowns(kind, corners), steps_of(kind, corners, p, grid)
    if has_slopes(kind):
        share = covered_with_slopes(kind, p, grid, box, rise)
        if not is_even(noise) or is_pressed(estimated):
            press_with_slopes(laid, estimated, steps, share, rise)
        if noise[FOAM] <= 0.0:
            return share, share
        for k in range(rise.shape[0]):
            if k < first or (k > first and FALL <= estimated[k - first - 1] <= LEAN_Y):
                rise[k] = passed_on(rise[k], noise[FOAM], box, rows, columns)
        return blurred(share, noise[FOAM], box, rows, columns), share
    pressed = covered(kind, corners, p, grid, box)
    if not is_even(noise):
        press(kind, corners, p, grid, noise, box, pressed)
    share = pressed
    if noise[FOAM] > 0.0:
        share = blurred(pressed, noise[FOAM], box, rows, columns)
    at = p.copy()
    for k in range(first):
        at[k] += steps[k]
        moved = shares_of(kind, corners, at, grid, noise, box, rows, columns)
        at[k] = p[k]
        rise[k] = (moved - share) / steps[k]
    return share, pressed


@compiled_as_is
def information(problem: Problem, p: Values, out: Information) -> float:
    """Write the slope of the log likelihood at a point, and an information matrix.

    Parameters
    ----------
    problem, p
        As in `log_posterior.log_likelihood`.
    out : Information
        Written.

    Returns
    -------
    float
        The log likelihood, up to rounding.

    Notes
    -----
    With mu the logarithm of an element's expected load, a touched one adds its chance of being
    no stray over sigma**2 times the outer product of the slopes of mu, an untouched one its
    squared score: positive whatever was read. Slopes are those of `shares_with_slopes`.
    """
    kind, grid, states, logs = problem.kind, problem.grid, problem.states, problem.logs
    first, noise = unknowns(kind, problem.corners), noise_at(problem, p)
    margin = foam_margin(grid, noise) + grid[2] * STEP
    box = window(kind, problem.corners, p, grid, states.shape[0], states.shape[1], margin)
    out.slope[:] = out.matrix[:] = 0.0
    if box[2] <= 0 or box[3] <= 0:
        return 0.0
    row, column, load, power = box[0], box[1], p[first], noise[CONTRAST]
    by_power, (share, rise) = number_of_contrast(problem), _rises(problem, p, noise, box)
    scatter, total, along = scatter_of(noise), NO_SCORE, np.zeros(rise.shape[0])
    sliver, unfelt, odds, found = SLIVER ** (1.0 / power), UNFELT * scatter.sigma, 1.0, 0.0
    for i in range(box[2]):
        for j in range(box[3]):
            state, its, moves = states[row + i, column + j], share[i, j], False
            if its <= 0.0 or state == UNKNOWN:
                continue
            log_share = 0.0 if its == 1.0 else math.log(its)
            log = noise[LEAST] if state == OFF else logs[row + i, column + j]
            mu = load + power * log_share
            if state in (OFF, UNDER) and mu - log < unfelt:
                continue
            likelier, score = score_of(state, log, mu, scatter)
            odds *= likelier
            if not 1.0 / MOST_ODDS < odds < MOST_ODDS:
                found += math.log(odds)
                odds = 1.0
            steep, per_share = power / max(its, sliver), power / its
            for k in range(rise.shape[0]):
                along[k] = (steep if k < first else per_share) * rise[k, i, j]
                moves = moves or along[k] != 0.0
            if moves:
                if by_power >= 0:
                    along[by_power] = log_share
                along[first] = 1.0
                add_outer(score, along, out)
                score = without_load(score)
            total = summed(total, score, 1.0)
    add_score(problem, total, out)
    return found + math.log(odds)


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
