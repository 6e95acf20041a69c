"""From an image's numbers to the posterior of one outline, in one compiled call."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from tactile_graph.compiled import compiled_as_is
from tactile_graph_likelihood.climb import climbed
from tactile_graph_likelihood.element_terms import STRAYS
from tactile_graph_likelihood.linear import inverted
from tactile_graph_likelihood.log_posterior import LN_TWO_PI, log_likelihood, log_rest
from tactile_graph_likelihood.misfit import misfit
from tactile_graph_likelihood.other_tops import widen
from tactile_graph_likelihood.outline_prior import TURN, pulled_in
from tactile_graph_likelihood.outlines import OVAL, Values, period, sizes, unknowns
from tactile_graph_likelihood.oval import log_stretch
from tactile_graph_likelihood.problem import Problem, believed, read_by
from tactile_graph_likelihood.sampling import sampled
from tactile_graph_likelihood.start import first_outline, moments, turns

ROUNDS = 25  # of the climb
ROUGH, ENOUGH = 0.5, 0.2  # gain in log posterior at which the first and second climb end
ATTEMPTS = 3
SAME = 0.5  # log posterior within which another attempt has found the same
POOR = -1.5  # surprise from which on there is no further attempt
SOFT = 0.05  # share of its load that an element takes from its surroundings in the first climb
NO_STRAYS = 1e-12
TRIES = 24  # outlines tried around the moments own, in attempts after the first
PLACE_OFF, SIZE_OFF, TURN_OFF = 0.2, 0.08, 0.1
"""How far they are off: in pitches, in the logarithm of a size, in radians."""


class Found(NamedTuple):
    """A posterior as weighted points.

    ``used`` points made it, 0 if no outline is possible; ``likeliest`` is the one with the
    largest density, ``height`` its log posterior; ``equal`` says how many equally weighted points
    they are worth; the last four numbers are those of `misfit`.
    """

    used: int
    likeliest: Values
    points: Values
    weights: Values
    mean: Values
    covariance: Values
    evidence: float
    equal: float
    height: float
    surprise: float
    alike: float
    lean: float
    fall: float


@compiled_as_is
def begun(problem: Problem, table: Values, tries: int, p: Values) -> None:
    """Write the likeliest of a few outlines around the touched elements' moments into ``p``."""
    kind, corners, grid, guess = problem.kind, problem.corners, problem.grid, problem.guess
    found = moments(grid, problem.logs, problem.states)
    first = unknowns(kind, corners)
    for k in range(guess.shape[0]):
        p[first + 1 + k] = guess[k, 0]
    best, trial = -math.inf, p.copy()
    loose = problem.prior.copy()
    near = believed(problem, loose)
    n, pitch = sizes(kind), grid[2]
    ways = turns(kind, corners)
    for t in range(ways + tries):
        first_outline(kind, corners, found, (t % ways) * period(kind, corners) / ways, trial)
        if t >= ways:
            for k in range(first):
                if 2 <= k < 2 + n:
                    trial[k] *= math.exp(SIZE_OFF * (table[t, k] - 0.5))
                elif period(kind, corners) > 0.0 and k == 2 + n:
                    trial[k] += TURN_OFF * table[t, k]
                else:
                    trial[k] += PLACE_OFF * pitch * table[t, k]
        pulled_in(kind, corners, trial, problem.prior)
        if period(kind, corners) > 0.0:
            loose[TURN] = trial[2 + n]
        here = log_rest(near, trial)
        if here > -math.inf:
            here += log_likelihood(problem, trial)
        if here > best or t == 0:
            best = here
            p[:] = trial


@compiled_as_is
def _climbed_twice(problem: Problem, p: Values, root: Values) -> float:
    """Climb with elements that feel a little beyond their edge, then with the true ones.

    Otherwise a touched element that is not covered would not pull at all.
    """
    soft, strict = problem.grid.copy(), problem.noise.copy()
    soft[4], soft[5] = SOFT, problem.grid[2]
    strict[STRAYS] = NO_STRAYS
    climbed(read_by(problem, soft, strict), p, ROUNDS, ROUGH, root)
    top, _ = climbed(problem, p, ROUNDS, ENOUGH, root)
    return top


@compiled_as_is
def log_volume(kind: int, p: Values, root: Values) -> float:
    """Return ln of the volume that a normal top of a posterior takes, of its own height.

    Parameters
    ----------
    kind, p : int, ndarray
        The top.
    root : ndarray, shape (K, K)
        Lower root of the information there.
    """
    n = p.shape[0]
    volume: float = 0.5 * n * LN_TWO_PI
    for k in range(n):
        volume -= math.log(root[k, k])
    if kind == OVAL:
        # the mean of 1 / d under a normal distribution, right where it is narrow and in a middle
        spread = inverted(root)
        d2 = p[3] * p[3] + p[4] * p[4] + 0.32 * (spread[3, 3] + spread[4, 4])
        volume -= 0.5 * math.log(d2)
    return volume


@compiled_as_is
def topped(
    problem: Problem, table: Values, start: Values, attempts: tuple[int, int], top: float,
    p: Values, root: Values,
) -> tuple[float, bool]:  # fmt: skip
    """Write the most likely outline and the root of its information, after some attempts.

    Parameters
    ----------
    problem : Problem
    table : ndarray, shape (N, K)
        As in `sampling.sampled`.
    start : ndarray, shape (0,) or (K,)
        Where to begin; empty for the touched elements' moments.
    attempts : (int, int)
        The first, from 0, and one past the last.
    top : float
        Log posterior of what earlier attempts found, -inf if this is the first.
    p, root : ndarray, shape (K,) and (K, K)
        What they found; written where something better is.

    Returns
    -------
    (float, bool)
        Log posterior there, -inf where no outline is possible; whether another attempt is worth
        its time.
    """
    n = p.shape[0]
    trial, its_root = np.zeros(n), np.zeros((n, n))
    for attempt in range(attempts[0], attempts[1]):
        if attempt == 0 and start.shape[0] == n:
            trial[:] = start
        else:
            begun(problem, table, attempt * TRIES, trial)
        here = _climbed_twice(problem, trial, its_root)
        again = attempt > 0 and abs(here - top) < SAME
        if here > top:
            top = here
            p[:] = trial
            root[:] = its_root
        if top > -math.inf:
            surprise, _, _, _ = misfit(problem, p)
            if surprise > POOR or again:
                return top, False
    return top, attempts[1] < ATTEMPTS


@compiled_as_is
def spread_out(
    problem: Problem, table: Values, block: int, worth: float, p: Values, root: Values, top: float
) -> Found:
    """Return the posterior around a top, as `topped` gives it."""
    kind, n = problem.kind, p.shape[0]
    near = problem.prior.copy()
    if period(kind, problem.corners) > 0.0:
        near[TURN] = p[2 + sizes(kind)]
    around = believed(problem, near)
    count = table.shape[0]
    points, logs_p, weights = np.empty((count, n)), np.empty(count), np.empty(count)
    mean, matrix = np.empty(n), np.empty((n, n))
    surprise, alike, lean, fall, likeliest = 0.0, 0.0, 0.0, 0.0, p.copy()
    covariance = inverted(root)
    widen(around, p, top, covariance)
    used, evidence, equal = sampled(
        around, p, covariance, table, block, worth, points, logs_p, weights, mean, matrix
    )
    if equal <= 0.0:
        used = 0
    if kind == OVAL:
        top += log_stretch(p)
    for i in range(used):
        if logs_p[i] > top:
            top = logs_p[i]
            likeliest[:] = points[i]
    if used > 0:
        surprise, alike, lean, fall = misfit(problem, mean)
    return Found(
        used, likeliest, points[:used], weights[:used], mean, matrix, evidence, equal, top,
        surprise, alike, lean, fall,
    )  # fmt: skip


@compiled_as_is
def searched(problem: Problem, table: Values, block: int, worth: float, start: Values) -> Found:
    """Return the posterior of one outline.

    Parameters
    ----------
    problem : Problem
    table, block, worth
        As in `sampling.sampled`.
    start : ndarray, shape (0,) or (K,)
        Where to begin; empty for the touched elements' moments.
    """
    n = unknowns(problem.kind, problem.corners) + 1 + problem.estimated.shape[0]
    p, root = np.zeros(n), np.zeros((n, n))
    top, _ = topped(problem, table, start, (0, ATTEMPTS), -math.inf, p, root)
    if top == -math.inf:
        return Found(
            0, p, np.empty((0, n)), np.empty(0), p, root, top, 0.0, top, 0.0, 0.0, 0.0, 0.0
        )  # fmt: skip
    return spread_out(problem, table, block, worth, p, root, top)
