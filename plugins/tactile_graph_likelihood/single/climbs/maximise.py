"""The mode of the posterior, by scoring steps: slopes of coverage, information of the readings."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from tactile_graph.compiled import compiled_as_is
from tactile_graph_likelihood.geometry.linear import cholesky, solved
from tactile_graph_likelihood.geometry.outline_prior import pulled_in
from tactile_graph_likelihood.geometry.outlines import DISC, RECTANGLE, Values
from tactile_graph_likelihood.single.density.element_terms import STRAYS
from tactile_graph_likelihood.single.density.information import (
    STEP,
    Information,
    add_prior,
    information,
    steps_of,
)
from tactile_graph_likelihood.single.density.log_posterior import log_likelihood, log_rest
from tactile_graph_likelihood.single.density.problem import Problem, with_elements

ROUNDS, HALVINGS = 25, 6
TIED, SLIDING, HELD = 0.01, 2.0, 6.0
"""Information, per squared pitch, that every length has. Readings may leave one free: an edge in a
gap, or a disc within an element, slides freely. Where slopes are exact nothing else says how far,
and on a large pad few of the points to be sampled would come near."""

ROUGH, ENOUGH = 0.5, 0.2  # gain in log posterior at which the first and second search end
SOFT = 0.05  # share of its load that an element takes from its surroundings in the first search
NO_STRAYS = 1e-12


class Mode(NamedTuple):
    """A most likely point, shape (K,), the lower root of the information there, and its height.

    The height is the log posterior, -inf where no outline is possible.
    """

    p: Values
    root: Values
    height: float


@compiled_as_is
def maximise(problem: Problem, p: Values, root: Values, enough: float, stride: float) -> float:
    """Bring a point, in place, to the top of the log posterior.

    Parameters
    ----------
    problem, p
        As in `log_posterior.log_likelihood`; of a prior for any angle.
    root : ndarray, shape (K, K)
        Written: the lower root of the information at the top.
    enough : float
        Gain in log posterior still promised, below which the search ends.
    stride : float
        Pitches that an edge moves at most in a round; infinite but for wide outlines.

    Returns
    -------
    float
        The log posterior there; -inf if no round found a finite one.
    """
    n = p.shape[0]
    step, trial = np.empty(n), np.empty(n)
    out = Information(np.empty(n), np.empty((n, n)))
    ahead = Information(np.empty(n), np.empty((n, n)))
    kind, corners, prior = problem.kind, problem.corners, problem.prior
    pulled_in(kind, corners, p, prior)
    now, new = log_rest(problem, p) + information(problem, p, out), -math.inf
    add_prior(problem, p, out)
    held = kind == DISC or stride < math.inf
    tied = HELD if held else SLIDING if kind == RECTANGLE else TIED
    damping, widths = 0.0, steps_of(kind, corners, p, problem.grid)
    for _ in range(ROUNDS):
        if not _rooted(out.matrix, widths, tied, damping, root):
            return now
        solved(root, out.slope, step)
        if _promised(out.slope, step) < enough:
            break
        first = share = _share_of_step(step, widths, stride)
        for _ in range(HALVINGS):
            for k in range(n):
                trial[k] = p[k] + share * step[k]
            pulled_in(kind, corners, trial, prior)
            new = log_rest(problem, trial)
            if new > -math.inf:
                if share == first:  # mostly the next point: a second look would cost more
                    new += information(problem, trial, ahead)
                else:
                    new += log_likelihood(problem, trial)
            if new > now:
                break
            share *= 0.4
        if not new > now:
            if damping > 50.0:
                break
            damping = max(1.0, 10.0 * damping)
            continue
        gained, now = new - now, new
        p[:] = trial
        if share < first:
            information(problem, p, ahead)
        out, ahead = ahead, out
        add_prior(problem, p, out)
        widths = steps_of(kind, corners, p, problem.grid)
        damping = 0.0 if share == first else 0.3
        if gained < 0.5 * enough:
            break
    _rooted(out.matrix, widths, tied, 0.0, root)
    return now


@compiled_as_is
def _rooted(matrix: Values, widths: Values, tied: float, damping: float, root: Values) -> bool:
    """Write an information's root, with what keeps steps short, and ties what readings leave free.

    Returns
    -------
    bool
        Whether there is any.
    """
    for k in range(matrix.shape[0]):
        scale = 1.0 if k >= widths.shape[0] else tied * STEP * STEP / (widths[k] * widths[k])
        root[k, k] = matrix[k, k] * (1.0 + damping) + scale
        for m in range(k):
            root[k, m] = matrix[k, m]
    return cholesky(root, root)


@compiled_as_is
def _promised(slope: Values, step: Values) -> float:
    """Return the gain that a step promises."""
    promised = 0.0
    for k in range(step.shape[0]):
        promised += slope[k] * step[k]
    return promised


@compiled_as_is
def _share_of_step(step: Values, widths: Values, stride: float) -> float:
    """Return the part of a step that moves edges no farther than a stride."""
    if stride == math.inf:
        return 1.0
    moved = 0.0
    for k in range(widths.shape[0]):
        moved += abs(step[k]) * STEP / widths[k]
    return stride / max(moved, stride)


@compiled_as_is
def softened(problem: Problem) -> Problem:
    """Return the problem with elements that feel a little beyond their edge, and no strays."""
    soft, strict = soft_and_strict(problem.grid, problem.noise)
    return with_elements(problem, soft, strict)


@compiled_as_is
def soft_and_strict(grid: Values, noise: Values) -> tuple[Values, Values]:
    """Return the grid of elements that feel a little beyond their edge, and a noise of no strays.

    Otherwise a touched element that no outline covers would not pull at all.
    """
    soft, strict = grid.copy(), noise.copy()
    soft[4], soft[5] = SOFT, grid[2]
    strict[STRAYS] = NO_STRAYS
    return soft, strict
