"""From an image's numbers to the posterior of one outline, in one compiled call."""

from __future__ import annotations

import math

import numpy as np

from tactile_graph.compiled import compiled_as_is
from tactile_graph_likelihood.geometry.outline_prior import TURN, pulled_in
from tactile_graph_likelihood.geometry.outlines import Values, period, sizes, unknowns
from tactile_graph_likelihood.large_pads.coarse import coarsened, in_one_piece
from tactile_graph_likelihood.large_pads.rim_misfit import surprise_at
from tactile_graph_likelihood.large_pads.solid import LARGE_PAD
from tactile_graph_likelihood.single.around import Found, spread_out
from tactile_graph_likelihood.single.covered_whole import inside_of, settle
from tactile_graph_likelihood.single.element_terms import VOIDS
from tactile_graph_likelihood.single.log_posterior import log_likelihood, log_rest
from tactile_graph_likelihood.single.maximise_from import climbed_from, climbed_twice
from tactile_graph_likelihood.single.problem import Problem, believed
from tactile_graph_likelihood.single.start import THINNEST, moments, outline_of_moments, turns

ATTEMPTS = 3
SAME = 0.5  # log posterior within which another attempt has found the same
POOR = -1.5  # surprise from which on there is no further attempt
TRIES = 24  # outlines tried around the moments own, in attempts after the first
PLACE_OFF, SIZE_OFF, TURN_OFF = 0.2, 0.08, 0.1
"""How far they are off: in pitches, in the logarithm of a size, in radians."""


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
    thinnest = THINNEST if problem.states.size <= LARGE_PAD else 0.0
    n, pitch = sizes(kind), grid[2]
    ways = turns(kind, corners)
    for t in range(ways + tries):
        turn = (t % ways) * period(kind, corners) / ways
        outline_of_moments(kind, corners, found, turn, thinnest, trial)
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
def _begun_large(
    problem: Problem, rough: Problem, block: int, load: float, start: Values, table: Values,
    tries: int, p: Values,
) -> None:  # fmt: skip
    """Write where a climb on a large pad begins into ``p``: near the top, if blocks show it.

    Parameters
    ----------
    problem, start, table, p
        As in `topped`.
    rough, block, load
        As `coarse.coarsened` gives them.
    tries : int
        As in `begun`.
    """
    first = unknowns(problem.kind, problem.corners)
    given = start.shape[0] == p.shape[0]
    if given:
        p[:] = start
    if block == 1:
        if not given:
            begun(rough, table, tries, p)
        return
    at, root = np.zeros(first + 1), np.zeros((first + 1, first + 1))
    if given:
        at[:first], at[first] = start[:first], math.log(1.0 - problem.noise[VOIDS])
    else:
        begun(rough, table, tries, at)
        for k in range(problem.guess.shape[0]):
            p[first + 1 + k] = problem.guess[k, 0]
    climbed_twice(rough, math.inf, at, root)
    at[first] = load
    if given:
        moved = p.copy()
        moved[: first + 1] = at
        if log_likelihood(problem, p) > log_likelihood(problem, moved):
            return
    p[: first + 1] = at


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
    large = problem.states.size > LARGE_PAD
    rough, block, load = coarsened(problem)
    for attempt in range(attempts[0], attempts[1]):
        given = start if attempt == 0 else start[:0]
        if large:
            seen = in_one_piece(rough) if attempt == 0 else rough
            _begun_large(problem, seen, block, load, given, table, attempt * TRIES, trial)
        elif given.shape[0] == n:
            trial[:] = given
        else:
            begun(problem, table, attempt * TRIES, trial)
        here = climbed_from(problem, block, trial, its_root)
        again = attempt > 0 and abs(here - top) < SAME
        if here > top:
            top = here
            p[:] = trial
            root[:] = its_root
        if top > -math.inf:
            inside = inside_of(problem, p)
            settle(problem, inside, p)
            if surprise_at(problem, inside, p) > POOR or again:
                return top, False
    return top, attempts[1] < ATTEMPTS


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
