"""The posterior around a top: how wide it is first thought to be, its points, and how it fits."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from tactile_graph.compiled import compiled_as_is
from tactile_graph_likelihood.geometry.linear import cholesky, inverted
from tactile_graph_likelihood.geometry.outline_prior import TURN
from tactile_graph_likelihood.geometry.outlines import OVAL, Values, period, sizes
from tactile_graph_likelihood.geometry.oval import log_stretch
from tactile_graph_likelihood.large_pads.rim_misfit import misfit_at
from tactile_graph_likelihood.large_pads.solid import LARGE_PAD
from tactile_graph_likelihood.single.covered_whole import inside_of, settle
from tactile_graph_likelihood.single.information import STEP, steps_of
from tactile_graph_likelihood.single.log_posterior import LN_TWO_PI
from tactile_graph_likelihood.single.other_tops import widen
from tactile_graph_likelihood.single.problem import Problem, believed
from tactile_graph_likelihood.single.sampling import sampled

HELD = 6.0  # information, per squared pitch, on each length of what is sampled first


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
def _hold_in_gaps(problem: Problem, p: Values, root: Values, covariance: Values) -> None:
    """Write the covariance of an outline whose edges slide no farther than a gap is wide.

    A straight edge that lies in a gap slides freely; where several do, hardly any of the first
    points would come near what is likely.
    """
    n, widths = root.shape[0], steps_of(problem.kind, problem.corners, p, problem.grid)
    matrix, held = np.zeros((n, n)), np.empty((n, n))
    for i in range(n):
        for j in range(n):
            for k in range(min(i, j) + 1):
                matrix[i, j] += root[i, k] * root[j, k]
    for k in range(widths.shape[0]):
        matrix[k, k] += HELD * (STEP / widths[k]) ** 2
    if cholesky(matrix, held):
        covariance[:] = inverted(held)


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
    inside = inside_of(problem, p)
    covariance = inverted(root)
    if problem.states.size > LARGE_PAD:
        _hold_in_gaps(problem, p, root, covariance)
    settle(problem, inside, p)
    widen(around, inside, p, top, covariance)
    used, evidence, equal = sampled(
        around, inside, p, covariance, table, block, worth, points, logs_p, weights, mean, matrix
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
        surprise, alike, lean, fall = misfit_at(problem, inside, mean)
    return Found(
        used, likeliest, points[:used], weights[:used], mean, matrix, evidence, equal, top,
        surprise, alike, lean, fall,
    )  # fmt: skip
