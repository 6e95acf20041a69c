"""The posterior of one outline among others that stay as they are, by importance sampling.

As `sample.importance_sample`, but for an outline whose load adds to that of others.
"""

from __future__ import annotations

import math

import numpy as np

from tactile_graph.compiled import compiled_as_is
from tactile_graph_likelihood.geometry.linear import cholesky, squared_length
from tactile_graph_likelihood.geometry.outlines import Values, period, sizes
from tactile_graph_likelihood.several.joint_posterior import (
    WIDTH,
    JointProblem,
    Outlines,
    gain,
    log_rest_of,
)
from tactile_graph_likelihood.single.importance import (
    FEWEST,
    FREEDOM,
    KEPT,
    WIDER,
    temper,
    weigh,
    weighted_moments,
)
from tactile_graph_likelihood.single.sample import Plan

PROPOSALS = 4
FIRST = 2.0  # the first proposal's variance, over the inverse information


@compiled_as_is
def sample_beside(
    problem: JointProblem, outline: Outlines, covariance: Values, plan: Plan, points: Values,
    weights: Values,
) -> tuple[int, float, float]:  # fmt: skip
    """Sample around an outline's mode; write points and weights.

    Parameters
    ----------
    problem : JointProblem
    outline : Outlines
        One outline at its mode.
    covariance : ndarray, shape (K, K)
        Of its numbers and the logarithm of its load: the first proposal's.
    plan : Plan
        A new proposal is made after each block, four at most.
    points, weights : ndarray, shape (N, K) and (N,)
        Written.

    Returns
    -------
    (int, float, float)
        Points used, log evidence, number of equal weights.
    """
    table, block, worth = plan
    kinds, corners, n = outline.kinds, outline.corners, covariance.shape[0]
    centre = outline.points[0, :n].copy()
    most = table.shape[0]
    turn = 2 + sizes(kinds[0]) if period(kinds[0], corners[0]) > 0.0 else -1
    half = 0.5 * period(kinds[0], corners[0])
    off, work = np.empty(n), np.empty(n)
    centres, roots = np.empty((PROPOSALS, n)), np.zeros((PROPOSALS, n, n))
    levels, drawn = np.empty(PROPOSALS), np.zeros(PROPOSALS)
    logs_q, logs_p = np.empty((PROPOSALS, most)), np.empty(most)
    constant = math.lgamma(0.5 * (FREEDOM + n)) - math.lgamma(0.5 * FREEDOM)
    constant -= 0.5 * n * math.log(FREEDOM * math.pi)
    proposal, spread = FIRST * covariance, np.empty((n, n))
    aim, tempered, trial = centre.copy(), np.empty(most), np.zeros((1, WIDTH))
    tried = Outlines(kinds, corners, trial)
    count, proposals, evidence, equal = 0, 0, -math.inf, 0.0
    while count + block <= most:
        if proposals < PROPOSALS:
            if not cholesky(proposal, roots[proposals]):
                break
            levels[proposals] = constant
            for k in range(n):
                centres[proposals, k] = aim[k]
                levels[proposals] -= math.log(roots[proposals, k, k])
            proposals += 1
        now = proposals - 1
        for i in range(count, count + block):
            for k in range(n):
                points[i, k] = centres[now, k]
                for m in range(k + 1):
                    points[i, k] += roots[now, k, m] * table[i, m]
                trial[0, k] = points[i, k]
            here = -math.inf
            if turn < 0 or abs(points[i, turn] - centre[turn]) <= half:
                here = log_rest_of(problem, tried)
            if here > -math.inf:
                here += gain(problem, tried)
            logs_p[i] = here
        drawn[now] += block
        count += block
        for c in range(proposals):
            for i in range(count):
                for k in range(n):
                    off[k] = points[i, k] - centres[c, k]
                far = squared_length(roots[c], off, work)
                logs_q[c, i] = levels[c] - 0.5 * (FREEDOM + n) * math.log1p(far / FREEDOM)
        evidence, equal = weigh(logs_p, logs_q, drawn / count, proposals, count, weights)
        if equal <= 0.0 or (equal >= worth and count >= 2 * block):
            break
        temper(weights, count, FEWEST * n, tempered)
        weighted_moments(points, tempered, count, aim, spread)
        for k in range(n):
            for m in range(n):
                proposal[k, m] = WIDER * spread[k, m] + KEPT * covariance[k, m]
    return count, evidence, equal
