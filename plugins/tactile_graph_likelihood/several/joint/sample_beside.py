"""The posterior of one outline among others that stay as they are, by importance sampling.

As `sample.importance_sample`, but for an outline whose load adds to that of others.
"""

from __future__ import annotations

import math

import numpy as np

from tactile_graph.compiled import compiled_as_is
from tactile_graph_likelihood.geometry.outlines import Values, period, sizes
from tactile_graph_likelihood.several.joint.joint_posterior import (
    WIDTH,
    JointProblem,
    Outlines,
    gain,
    log_rest_of,
)
from tactile_graph_likelihood.single.sampling.importance import weigh
from tactile_graph_likelihood.single.sampling.sample import (
    Draws,
    Plan,
    draw,
    log_evidence_of,
    next_covariance,
    no_proposals,
    propose,
    take_block,
)

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
    kinds, corners, n = outline.kinds, outline.corners, covariance.shape[0]
    (table, block, worth), most = plan, plan.table.shape[0]
    turn = 2 + sizes(kinds[0]) if period(kinds[0], corners[0]) > 0.0 else -1
    half, angle = 0.5 * period(kinds[0], corners[0]), outline.points[0, turn]
    proposals = no_proposals(PROPOSALS, n, most)
    draws = Draws(points, np.empty(most), weights, np.empty(n), np.empty((n, n)))
    centre, wanted, trial = outline.points[0, :n].copy(), FIRST * covariance, np.zeros((1, WIDTH))
    tried = Outlines(kinds, corners, trial)
    count, made, evidence, equal = 0, 0, -math.inf, 0.0
    while count + block <= most:
        before = count
        if made < PROPOSALS:
            if made > 0:
                wanted = next_covariance(draws, count, covariance, centre)
            if not propose(proposals, made, centre, wanted):
                break
            made, before = made + 1, 0
        for i in range(count, count + block):
            draw(proposals, made - 1, table[i], points[i])
            for k in range(n):
                trial[0, k] = points[i, k]
            here = -math.inf
            if turn < 0 or abs(points[i, turn] - angle) <= half:
                here = log_rest_of(problem, tried)
            if here > -math.inf:
                here += gain(problem, tried)
            draws.logs_p[i] = here
        take_block(proposals, made, points, before, count, block)
        count += block
        shares = proposals.drawn / count
        evidence, equal = weigh(draws.logs_p, proposals.densities, shares, made, count, weights)
        if equal <= 0.0 or (equal >= worth and count >= 2 * block):
            break
    return count, log_evidence_of(proposals, evidence, n), equal
