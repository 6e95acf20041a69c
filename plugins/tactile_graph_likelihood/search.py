"""From an image's numbers to the posterior of one outline, in one compiled call."""

from __future__ import annotations

import math

import numpy as np

from tactile_graph.compiled import compiled_as_is
from tactile_graph_likelihood.climb import climbed
from tactile_graph_likelihood.element_terms import STRAYS, States
from tactile_graph_likelihood.linear import inverted
from tactile_graph_likelihood.log_posterior import LN_TWO_PI, Places, log_likelihood, log_rest
from tactile_graph_likelihood.misfit import misfit
from tactile_graph_likelihood.other_tops import widen
from tactile_graph_likelihood.outline_prior import TURN, pulled_in
from tactile_graph_likelihood.outlines import OVAL, Values, period, sizes, unknowns
from tactile_graph_likelihood.oval import log_stretch
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

Found = tuple[
    int, Values, Values, Values, Values, Values, Values, float, float, float, float, float, int
]
"""Points used (0: none), most likely point, points, their log posterior, weights, mean,
covariance, log evidence, number of equal weights, log posterior at the most likely point, the two
numbers of `misfit`, rounds climbed."""


@compiled_as_is
def begun(
    kind: int,
    corners: int,
    grid: Values,
    logs: Values,
    states: States,
    noise: Values,
    estimated: Places,
    guess: Values,
    prior: Values,
    belief: Values,
    precision: Values,
    table: Values,
    tries: int,
    p: Values,
) -> None:
    """Write the likeliest of a few outlines around the touched elements' moments into ``p``."""
    found = moments(grid, logs, states)
    first = unknowns(kind, corners)
    for k in range(guess.shape[0]):
        p[first + 1 + k] = guess[k, 0]
    best, trial = -math.inf, p.copy()
    loose = prior.copy()
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
        pulled_in(kind, corners, trial, prior)
        if period(kind, corners) > 0.0:
            loose[TURN] = trial[2 + n]
        here = log_rest(kind, corners, trial, guess, loose, belief, precision)
        if here > -math.inf:
            here += log_likelihood(kind, corners, trial, grid, logs, states, noise, estimated)
        if here > best or t == 0:
            best = here
            p[:] = trial


@compiled_as_is
def _climbed_twice(
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
    root: Values,
) -> tuple[float, int]:
    """Climb with elements that feel a little beyond their edge, then with the true ones.

    Otherwise a touched element that is not covered would not pull at all.
    """
    soft, strict = grid.copy(), noise.copy()
    soft[4], soft[5] = SOFT, grid[2]
    strict[STRAYS] = NO_STRAYS
    _, first = climbed(
        kind, corners, p, soft, logs, states, strict, estimated, guess, prior, belief, precision,
        ROUNDS, ROUGH, root,
    )  # fmt: skip
    top, second = climbed(
        kind, corners, p, grid, logs, states, noise, estimated, guess, prior, belief, precision,
        ROUNDS, ENOUGH, root,
    )  # fmt: skip
    return top, first + second


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
    kind: int,
    corners: int,
    grid: Values,
    logs: Values,
    states: States,
    noise: Values,
    estimated: Places,
    guess: Values,
    prior: Values,
    belief: Values,
    precision: Values,
    table: Values,
    start: Values,
    attempts: tuple[int, int],
    top: float,
    p: Values,
    root: Values,
) -> tuple[float, bool, int]:
    """Write the most likely outline and the root of its information, after some attempts.

    Parameters
    ----------
    kind, corners, grid, logs, states, noise, estimated, guess, prior, belief, precision
        As in `log_posterior`.
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
    (float, bool, int)
        Log posterior there, -inf where no outline is possible; whether another attempt is worth
        its time; rounds climbed.
    """
    n = p.shape[0]
    trial, its_root = np.zeros(n), np.zeros((n, n))
    rounds = 0
    for attempt in range(attempts[0], attempts[1]):
        if attempt == 0 and start.shape[0] == n:
            trial[:] = start
        else:
            begun(
                kind, corners, grid, logs, states, noise, estimated, guess, prior, belief,
                precision, table, attempt * TRIES, trial,
            )  # fmt: skip
        here, made = _climbed_twice(
            kind, corners, trial, grid, logs, states, noise, estimated, guess, prior, belief,
            precision, its_root,
        )  # fmt: skip
        rounds += made
        again = attempt > 0 and abs(here - top) < SAME
        if here > top:
            top = here
            p[:] = trial
            root[:] = its_root
        if top > -math.inf:
            surprise, _ = misfit(kind, corners, p, grid, logs, states, noise, estimated)
            if surprise > POOR or again:
                return top, False, rounds
    return top, attempts[1] < ATTEMPTS, rounds


@compiled_as_is
def spread_out(
    kind: int,
    corners: int,
    grid: Values,
    logs: Values,
    states: States,
    noise: Values,
    estimated: Places,
    guess: Values,
    prior: Values,
    belief: Values,
    precision: Values,
    table: Values,
    block: int,
    worth: float,
    p: Values,
    root: Values,
    top: float,
) -> Found:
    """Return the posterior around a top, as `topped` gives it; the rounds come out as 0."""
    n = p.shape[0]
    near = prior.copy()
    if period(kind, corners) > 0.0:
        near[TURN] = p[2 + sizes(kind)]
    count = table.shape[0]
    points, logs_p, weights = np.empty((count, n)), np.empty(count), np.empty(count)
    mean, matrix = np.empty(n), np.empty((n, n))
    surprise, alike, most_likely = 0.0, 0.0, p.copy()
    covariance = inverted(root)
    widen(
        kind, corners, p, top, grid, logs, states, noise, estimated, guess, near, belief,
        precision, covariance,
    )  # fmt: skip
    used, evidence, equal = sampled(
        kind, corners, grid, logs, states, noise, estimated, guess, near, belief, precision,
        p, covariance, table, block, worth, points, logs_p, weights, mean, matrix,
    )  # fmt: skip
    if equal <= 0.0:
        used = 0
    if kind == OVAL:
        top += log_stretch(p)
    for i in range(used):
        if logs_p[i] > top:
            top = logs_p[i]
            most_likely[:] = points[i]
    if used > 0:
        surprise, alike = misfit(kind, corners, mean, grid, logs, states, noise, estimated)
    return (
        used, most_likely, points[:used], logs_p[:used], weights[:used], mean, matrix, evidence,
        equal, top, surprise, alike, 0,
    )  # fmt: skip


@compiled_as_is
def searched(
    kind: int,
    corners: int,
    grid: Values,
    logs: Values,
    states: States,
    noise: Values,
    estimated: Places,
    guess: Values,
    prior: Values,
    belief: Values,
    precision: Values,
    table: Values,
    block: int,
    worth: float,
    start: Values,
) -> Found:
    """Return the posterior of one outline.

    Parameters
    ----------
    kind, corners, grid, logs, states, noise, estimated, guess, prior, belief, precision
        As in `log_posterior`.
    table, block, worth
        As in `sampling.sampled`.
    start : ndarray, shape (0,) or (K,)
        Where to begin; empty for the touched elements' moments.
    """
    n = unknowns(kind, corners) + 1 + estimated.shape[0]
    p, root = np.zeros(n), np.zeros((n, n))
    top, _, rounds = topped(
        kind, corners, grid, logs, states, noise, estimated, guess, prior, belief, precision,
        table, start, (0, ATTEMPTS), -math.inf, p, root,
    )  # fmt: skip
    if top == -math.inf:
        return (
            0, p, np.empty((0, n)), np.empty(0), np.empty(0), p, root, top, 0.0, top, 0.0, 0.0,
            rounds,
        )  # fmt: skip
    (used, likeliest, points, logs_p, weights, mean, matrix, evidence, equal, top, surprise, alike,
     _) = spread_out(
        kind, corners, grid, logs, states, noise, estimated, guess, prior, belief, precision,
        table, block, worth, p, root, top,
    )  # fmt: skip
    return (
        used, likeliest, points, logs_p, weights, mean, matrix, evidence, equal, top, surprise,
        alike, rounds,
    )  # fmt: skip
