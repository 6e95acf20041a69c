"""The most likely outline, by scoring steps: slopes of coverage, information of the readings."""

from __future__ import annotations

import math

import numpy as np

from tactile_graph.compiled import compiled_as_is
from tactile_graph_likelihood.geometry.linear import cholesky, solved
from tactile_graph_likelihood.geometry.outline_prior import TURN, pulled_in
from tactile_graph_likelihood.geometry.outlines import Values, period, sizes, unknowns
from tactile_graph_likelihood.large_pads.rim_information import information_at
from tactile_graph_likelihood.large_pads.rim_likelihood import likelihood_at
from tactile_graph_likelihood.single.covered_whole import Inside, settle
from tactile_graph_likelihood.single.information import STEP, add_prior, steps_of
from tactile_graph_likelihood.single.log_posterior import log_rest
from tactile_graph_likelihood.single.problem import Problem, believed

TIED = 0.01  # information, per squared pitch, that every length has: readings may leave one free


@compiled_as_is
def climbed(
    problem: Problem, inside: Inside, p: Values, most: int, enough: float, stride: float,
    root: Values,
) -> tuple[float, int]:  # fmt: skip
    """Bring a point, in place, to the top of the log posterior.

    Parameters
    ----------
    problem, p
        As in `log_posterior`; the prior's `TURN` is not looked at.
    inside : Inside
        As in `rim_likelihood.likelihood_at`; written.
    most : int
        Rounds.
    enough : float
        Gain in log posterior still promised, below which the search ends.
    stride : float
        Pitches that an edge moves at most in a round.
    root : ndarray, shape (K, K)
        Written: the lower root of the information at the top.

    Returns
    -------
    (float, int)
        The log posterior there and the rounds made; -inf if no round found a finite one.
    """
    n, first = p.shape[0], unknowns(problem.kind, problem.corners)
    slope, step, trial = np.empty(n), np.empty(n), np.empty(n)
    matrix = np.empty((n, n))
    kind, corners, grid, prior = problem.kind, problem.corners, problem.grid, problem.prior
    loose = prior.copy()
    near = believed(problem, loose)
    turn = 2 + sizes(kind) if period(kind, corners) > 0.0 else -1
    pulled_in(kind, corners, p, prior)
    if turn >= 0:
        loose[TURN] = p[turn]
    settle(problem, inside, p)
    now = log_rest(near, p) + likelihood_at(problem, inside, p)
    damping = 0.0
    for rounds in range(1, most + 1):
        settle(problem, inside, p)
        information_at(problem, inside, p, slope, matrix)
        add_prior(problem, p, slope, matrix)
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
        if stride < math.inf:
            moved = 0.0
            for k in range(first):
                moved += abs(step[k]) * STEP / widths[k]
            share = stride / max(moved, stride)
        whole = share
        for _ in range(6):
            for k in range(n):
                trial[k] = p[k] + share * step[k]
            pulled_in(kind, corners, trial, prior)
            if turn >= 0:
                loose[TURN] = trial[turn]
            new = log_rest(near, trial)
            if new > -math.inf:
                new += likelihood_at(problem, inside, trial)
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
        damping = 0.0 if share == whole else 0.3
        if gained < 0.5 * enough:
            return now, rounds
    return now, most
