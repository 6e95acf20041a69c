"""Where else an outline with sides may end: a void at an end looks like the end itself."""

from __future__ import annotations

import math

import numpy as np

from tactile_graph.compiled import compiled_as_is
from tactile_graph_likelihood.geometry.outlines import ELLIPSE, OVAL, RECTANGLE, Values
from tactile_graph_likelihood.geometry.oval import as_ellipse, to_oval
from tactile_graph_likelihood.large_pads.rim_likelihood import likelihood_at
from tactile_graph_likelihood.single.covered_whole import Inside
from tactile_graph_likelihood.single.log_posterior import log_rest
from tactile_graph_likelihood.single.problem import Problem

SHIFTS = (-1.2, -0.8, -0.4, 0.4, 0.8, 1.2)  # of one side, in pitches
FLATTER = 0.5  # power of the likelihood: a side that was moved has not yet settled


@compiled_as_is
def widen(problem: Problem, inside: Inside, p: Values, top: float, covariance: Values) -> None:
    """Widen a covariance, in place, towards each side's other likely places.

    Parameters
    ----------
    problem, p
        As in `log_posterior`; ``p`` is the most likely point.
    inside : Inside
        As in `rim_likelihood.likelihood_at`.
    top : float
        Log posterior there.
    covariance : ndarray, shape (K, K)
        Of the posterior around ``p``.

    Notes
    -----
    Each side of a rectangle, each end of an ellipse's axes, is moved by itself, by up to 1.2
    pitches. The outer product of each move is added, by the square root of how likely it is.
    """
    kind, grid = problem.kind, problem.grid
    if kind not in (RECTANGLE, ELLIPSE, OVAL):
        return
    at = as_ellipse(p) if kind == OVAL else p
    move, trial = np.zeros(5), p.copy()
    for side in range(4):
        axis = side // 2
        way = 1.0 if side % 2 == 0 else -1.0
        turn = at[4] + 0.5 * math.pi * axis
        for shift in SHIFTS:
            half = 0.5 * shift * grid[2]
            move[0], move[1] = way * half * math.cos(turn), -way * half * math.sin(turn)
            move[2], move[3], move[4] = half * (1 - axis), half * axis, 0.0
            for k in range(5):
                trial[k] = at[k] + move[k]
            if kind == OVAL:
                to_oval(trial)
                for k in range(5):
                    move[k] = trial[k] - p[k]
            here = log_rest(problem, trial)
            if here == -math.inf:
                continue
            here += likelihood_at(problem, inside, trial)
            share = math.exp(FLATTER * min(here - top, 0.0))
            for k in range(5):
                for m in range(5):
                    covariance[k, m] += share * move[k] * move[m]
