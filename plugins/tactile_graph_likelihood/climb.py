"""The most likely outline, by scoring steps: slopes of coverage, information of the readings."""

from __future__ import annotations

import math

import numpy as np

from tactile_graph.compiled import compiled_as_is
from tactile_graph_likelihood.covered import blurred, covered, window
from tactile_graph_likelihood.element_terms import (
    FOAM,
    LEAST,
    ON,
    SIGMA,
    SQRT_HALF,
    UNKNOWN,
    VOIDS,
    States,
    on_level,
)
from tactile_graph_likelihood.linear import cholesky, solved
from tactile_graph_likelihood.log_posterior import (
    Places,
    foam_margin,
    log_likelihood,
    log_rest,
    noise_at,
)
from tactile_graph_likelihood.outline_prior import TURN, pulled_in
from tactile_graph_likelihood.outlines import Values, period, sizes, unknowns

STEP = 0.02  # of a pitch: over which coverage is differenced
FOAM_STEP = 0.005
TIED = 0.01  # information, per squared pitch, that every length has: readings may leave one free
SLIVER = 0.1  # covered less, an element's slope is no guide to how far the outline may go
DENSITY = 1.0 / math.sqrt(2.0 * math.pi)


@compiled_as_is
def _share(
    kind: int,
    corners: int,
    p: Values,
    grid: Values,
    foam: float,
    box: tuple[int, int, int, int],
    rows: int,
    columns: int,
) -> Values:
    """Return the coverage of a window, blurred if there is foam."""
    shares = covered(kind, corners, p, grid, box)
    return blurred(shares, foam, box, rows, columns) if foam > 0.0 else shares


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
def _rises(
    kind: int,
    corners: int,
    p: Values,
    grid: Values,
    noise: Values,
    estimated: Places,
    box: tuple[int, int, int, int],
    states: States,
) -> tuple[Values, Values]:
    """Return coverage of a window, and its slope along each number of a point, (K, rows, cols)."""
    first, foam = unknowns(kind, corners), noise[FOAM]
    rows, columns = states.shape
    share = _share(kind, corners, p, grid, foam, box, rows, columns)
    rise = np.zeros((p.shape[0], box[2], box[3]))
    steps, at = steps_of(kind, corners, p, grid), p.copy()
    for k in range(first):
        at[k] += steps[k]
        moved = _share(kind, corners, at, grid, foam, box, rows, columns)
        at[k] = p[k]
        for i in range(box[2]):
            for j in range(box[3]):
                rise[k, i, j] = (moved[i, j] - share[i, j]) / steps[k]
    for k in range(estimated.shape[0]):
        if estimated[k] == FOAM:
            wider = foam * math.exp(FOAM_STEP)
            moved = _share(kind, corners, p, grid, wider, box, rows, columns)
            rise[first + 1 + k] = (moved - share) / FOAM_STEP
    return share, rise


@compiled_as_is
def _score(on: bool, log: float, mu: float, noise: Values, level: float) -> tuple[float, ...]:
    """Return what an element's reading says of the logarithm mu of its expected load.

    Returns
    -------
    tuple of float
        The slope of its log likelihood, its information; the chance that it is no stray and its
        residual, where it reads a load; the chance that its load shows, where it reads none.
    """
    sigma, present = noise[SIGMA], 1.0 - noise[VOIDS]
    if on:
        u = (log - mu) / sigma
        a = min(max(level - 0.5 * u * u, -700.0), 700.0)
        chance = 1.0 / (1.0 + math.exp(-a))
        return chance * u / sigma, chance / (sigma * sigma), chance, u, 0.0
    z = (mu - noise[LEAST]) / sigma
    tail = 0.5 * math.erfc(-SQRT_HALF * z)
    score = -present * DENSITY * math.exp(-0.5 * z * z) / (sigma * (1.0 - present * tail))
    return score, score * score, 1.0, z, tail


@compiled_as_is
def _add_noise_slopes(
    on: bool, score: tuple[float, ...], first: int, noise: Values, estimated: Places,
    slope: Values, matrix: Values,
) -> None:  # fmt: skip
    """Add what an element's reading says of the sigma and the voids that are estimated."""
    voids, chance, u, tail = noise[VOIDS], score[2], score[3], score[4]
    for k in range(estimated.shape[0]):
        m = first + 1 + k
        if estimated[k] == SIGMA:
            slope[m] += chance * (u * u - 1.0) if on else -score[0] * noise[SIGMA] * u
            matrix[m, m] += 2.0 * chance if on else 0.0
        elif estimated[k] == VOIDS:
            none = 1.0 - (1.0 - voids) * tail
            slope[m] += -voids * chance if on else voids * (1.0 - voids) * tail / none
            matrix[m, m] += voids * (1.0 - voids)


@compiled_as_is
def information(
    kind: int,
    corners: int,
    p: Values,
    grid: Values,
    logs: Values,
    states: States,
    noise: Values,
    estimated: Places,
    slope: Values,
    matrix: Values,
) -> None:
    """Write the slope of the log likelihood at a point, and an information matrix.

    Parameters
    ----------
    kind, corners, p, grid, logs, states, noise, estimated
        As in `log_posterior.log_likelihood`.
    slope, matrix : ndarray, shape (K,) and (K, K)
        Written.

    Notes
    -----
    With mu the logarithm of an element's expected load, a touched one adds its chance of being
    no stray over sigma**2 times the outer product of the slopes of mu, an untouched one its
    squared score: positive whatever was read. Coverage is differenced over 0.02 of a pitch.
    """
    first = unknowns(kind, corners)
    rows, columns = states.shape
    here = noise_at(p, first + 1, noise, estimated)
    box = window(kind, corners, p, grid, rows, columns, foam_margin(grid, here) + grid[2] * STEP)
    slope[:] = 0.0
    matrix[:] = 0.0
    if box[2] <= 0 or box[3] <= 0:
        return
    share, rise = _rises(kind, corners, p, grid, here, estimated, box, states)
    n, level, plain = p.shape[0], on_level(here), here[FOAM] <= 0.0 and grid[4] <= 0.0
    along = np.zeros(n)
    along[first] = 1.0
    for i in range(box[2]):
        for j in range(box[3]):
            state, its = states[box[0] + i, box[1] + j], share[i, j]
            if its <= 0.0 or state == UNKNOWN:
                continue
            mu = p[first] if its == 1.0 else math.log(its) + p[first]
            on = state == ON
            score = _score(on, logs[box[0] + i, box[1] + j], mu, here, level)
            _add_noise_slopes(on, score, first, here, estimated, slope, matrix)
            edge = its < 1.0 or not plain
            for k in range(first):
                along[k] = rise[k, i, j] / max(its, SLIVER)
                edge = edge or along[k] != 0.0
            if not edge:
                slope[first] += score[0]
                matrix[first, first] += score[1]
                continue
            for k in range(estimated.shape[0]):
                along[first + 1 + k] = rise[first + 1 + k, i, j] / its
            for k in range(n):
                slope[k] += score[0] * along[k]
                for m in range(k + 1):
                    matrix[k, m] += score[1] * along[k] * along[m]
    for k in range(n):
        for m in range(k):
            matrix[m, k] = matrix[k, m]


@compiled_as_is
def add_prior(
    kind: int,
    corners: int,
    p: Values,
    guess: Values,
    belief: Values,
    precision: Values,
    slope: Values,
    matrix: Values,
) -> None:
    """Add what the priors say to a slope and an information matrix."""
    first = unknowns(kind, corners)
    for k in range(2, 2 + sizes(kind)):
        slope[k] -= 1.0 / p[k]
    for k in range(guess.shape[0]):
        m, width = first + 1 + k, guess[k, 1] * guess[k, 1]
        slope[m] -= (p[m] - guess[k, 0]) / width
        matrix[m, m] += 1.0 / width
    for i in range(first):
        for k in range(first):
            slope[i] -= precision[i, k] * (p[k] - belief[k])
            matrix[i, k] += precision[i, k]


@compiled_as_is
def climbed(
    kind: int,
    corners: int,
    p: Values,
    grid: Values,
    logs: Values,
    states: States,
    noise: Values,
    estimated: Places,
    guess: Values,
    prior: Values,
    belief: Values,
    precision: Values,
    most: int,
    enough: float,
    root: Values,
) -> tuple[float, int]:
    """Bring a point, in place, to the top of the log posterior.

    Parameters
    ----------
    kind, corners, p, grid, logs, states, noise, estimated, guess, prior, belief, precision
        As in `log_posterior`; the prior's `TURN` is not looked at.
    most : int
        Rounds.
    enough : float
        Gain in log posterior still promised, below which the search ends.
    root : ndarray, shape (K, K)
        Written: the lower root of the information at the top.

    Returns
    -------
    (float, int)
        The log posterior there and the rounds made; -inf if no round found a finite one.
    """
    n, first = p.shape[0], unknowns(kind, corners)
    slope, step, trial = np.empty(n), np.empty(n), np.empty(n)
    matrix = np.empty((n, n))
    turn = 2 + sizes(kind) if period(kind, corners) > 0.0 else -1
    loose = prior.copy()
    pulled_in(kind, corners, p, prior)
    if turn >= 0:
        loose[TURN] = p[turn]
    now = log_rest(kind, corners, p, guess, loose, belief, precision) + log_likelihood(
        kind, corners, p, grid, logs, states, noise, estimated
    )
    damping = 0.0
    for rounds in range(1, most + 1):
        information(kind, corners, p, grid, logs, states, noise, estimated, slope, matrix)
        add_prior(kind, corners, p, guess, belief, precision, slope, matrix)
        widths = steps_of(kind, corners, p, grid)
        for k in range(n):
            scale = 1.0 if k >= first else TIED / (widths[k] / STEP) ** 2
            matrix[k, k] = matrix[k, k] * (1.0 + damping) + scale
        if not cholesky(matrix, root):
            return now, rounds
        solved(root, slope, step)
        promised = 0.0
        for k in range(n):
            promised += slope[k] * step[k]
        if promised < enough:
            return now, rounds
        share, better = 1.0, False
        for _ in range(6):
            for k in range(n):
                trial[k] = p[k] + share * step[k]
            pulled_in(kind, corners, trial, prior)
            if turn >= 0:
                loose[TURN] = trial[turn]
            new = log_rest(kind, corners, trial, guess, loose, belief, precision)
            if new > -math.inf:
                new += log_likelihood(kind, corners, trial, grid, logs, states, noise, estimated)
            if new > now:
                better = True
                break
            share *= 0.4
        if not better:
            if damping > 50.0:
                return now, rounds
            damping = max(1.0, 10.0 * damping)
            continue
        gained = new - now
        now = new
        p[:] = trial
        damping = 0.0 if share == 1.0 else 0.3
        if gained < 0.5 * enough:
            return now, rounds
    return now, most
