"""The posterior by adaptive importance sampling, from few points that fill space evenly.

Points come in blocks, drawn from Student's t around the mean and covariance that the points
before have found, the first around the most likely point. A new proposal is made whenever the
points have doubled. All are weighted together, by the mixture they come from (J.-M. Cornuet
et al. 2012, 10.1111/j.1467-9469.2011.00756.x). It ends once they are worth enough equal ones.
"""

from __future__ import annotations

import math

import numpy as np

from tactile_graph.compiled import compiled_as_is
from tactile_graph_likelihood.geometry.linear import cholesky, squared_length
from tactile_graph_likelihood.geometry.outlines import DISC, OVAL, Values
from tactile_graph_likelihood.geometry.oval import log_stretch
from tactile_graph_likelihood.large_pads.rim_likelihood import likelihood_at
from tactile_graph_likelihood.single.covered_whole import Inside
from tactile_graph_likelihood.single.log_posterior import log_rest
from tactile_graph_likelihood.single.problem import Problem

FREEDOM = 8.0  # of Student's t
WIDER = 1.3  # the proposal's variance over the posterior's
PROPOSALS = 8
FIRST = 1.6  # the first proposal's, over the inverse information: a gap lets an edge slide
KEPT = 0.02  # of the first covariance, added to each later one: it stays invertible
FEWEST = 3.0  # equal weights per unknown: fewer are flattened before a covariance is taken


@compiled_as_is
def density(length: float, unknowns: int) -> float:
    """Return Student's t density at a squared length, over that in its middle."""
    power = round(FREEDOM) + unknowns
    base = 1.0 / (1.0 + length / FREEDOM)
    found = base ** (power // 2)
    return found * math.sqrt(base) if power % 2 == 1 else found


@compiled_as_is
def t_constant(unknowns: int) -> float:
    """Return the logarithm of Student's t density in the middle, of unit scale."""
    constant = math.lgamma(0.5 * (FREEDOM + unknowns)) - math.lgamma(0.5 * FREEDOM)
    found: float = constant - 0.5 * unknowns * math.log(FREEDOM * math.pi)
    return found


@compiled_as_is
def weigh(
    logs_p: Values, logs_q: Values, shares: Values, proposals: int, count: int, weights: Values
) -> tuple[float, float]:
    """Write the weights of ``count`` points, summing to 1.

    Parameters
    ----------
    logs_p : ndarray, shape (N,)
        Log posterior of each point, up to a constant.
    logs_q : ndarray, shape (proposals, N)
        Log density of each point under each proposal.
    shares : ndarray, shape (proposals,)
        Part of the points that was drawn from each.
    proposals, count : int
        How many there are of each in the arrays.
    weights : ndarray, shape (N,)
        Written: the weights.

    Returns
    -------
    (float, float)
        Logarithm of the mean weight before that, and how many equal weights they are worth.
    """
    for i in range(count):
        if logs_p[i] == -math.inf:
            weights[i] = -math.inf
            continue
        most = logs_q[0, i]
        for c in range(1, proposals):
            most = max(most, logs_q[c, i])
        mixed = 0.0
        for c in range(proposals):
            mixed += shares[c] * math.exp(logs_q[c, i] - most)
        weights[i] = logs_p[i] - most - math.log(mixed)
    return normalise(weights, count)


@compiled_as_is
def weigh_by_density(
    logs_p: Values, densities: Values, shares: Values, proposals: int, count: int, weights: Values
) -> tuple[float, float]:
    """Do the same from densities, up to one factor, at half the time."""
    for i in range(count):
        if logs_p[i] == -math.inf:
            weights[i] = -math.inf
            continue
        mixed = 0.0
        for c in range(proposals):
            mixed += shares[c] * densities[c, i]
        weights[i] = logs_p[i] - math.log(mixed)
    return normalise(weights, count)


@compiled_as_is
def normalise(weights: Values, count: int) -> tuple[float, float]:
    """Turn logarithms of weights, in place, into weights that sum to 1; return as `weigh` does."""
    top = -math.inf
    for i in range(count):
        top = max(top, weights[i])
    if top == -math.inf:
        weights[:count] = 1.0 / count
        return -math.inf, 0.0
    total = squares = 0.0
    for i in range(count):
        weights[i] = math.exp(weights[i] - top)
        total += weights[i]
        squares += weights[i] * weights[i]
    for i in range(count):
        weights[i] /= total
    return top + math.log(total / count), total * total / squares


@compiled_as_is
def flatten(weights: Values, count: int, wanted: float, flat: Values) -> None:
    """Write weights to a power, at most 1, at which they are worth ``wanted`` equal ones or so."""
    power = 1.0
    for _ in range(8):
        total = squares = 0.0
        for i in range(count):
            flat[i] = weights[i] ** power if weights[i] > 0.0 else 0.0
            total += flat[i]
            squares += flat[i] * flat[i]
        for i in range(count):
            flat[i] /= total
        if total * total >= wanted * squares:
            return
        power *= 0.6


@compiled_as_is
def spread_of(points: Values, weights: Values, count: int, mean: Values, matrix: Values) -> None:
    """Write the weighted mean and covariance of the first ``count`` points."""
    n = points.shape[1]
    mean[:] = 0.0
    matrix[:] = 0.0
    for i in range(count):
        for k in range(n):
            mean[k] += weights[i] * points[i, k]
    for i in range(count):
        w = weights[i]
        if w < 1e-12:
            continue
        for k in range(n):
            off = w * (points[i, k] - mean[k])
            for m in range(k + 1):
                matrix[k, m] += off * (points[i, m] - mean[m])
    kept = 1.0
    for i in range(count):
        kept -= weights[i] * weights[i]  # a mean of few points lies too near to them
    for k in range(n):
        for m in range(k + 1):
            matrix[k, m] /= max(kept, 0.05)
            matrix[m, k] = matrix[k, m]


@compiled_as_is
def sampled(
    problem: Problem,
    inside: Inside,
    centre: Values,
    covariance: Values,
    table: Values,
    block: int,
    worth: float,
    points: Values,
    logs_p: Values,
    weights: Values,
    mean: Values,
    matrix: Values,
) -> tuple[int, float, float]:
    """Sample the posterior around a point; write points, weights, mean and covariance.

    Parameters
    ----------
    problem : Problem
        As in `log_posterior`.
    inside : Inside
        As in `rim_likelihood.likelihood_at`.
    centre, covariance : ndarray, shape (K,) and (K, K)
        First proposal.
    table : ndarray, shape (N, K)
        Points of Student's t with 8 degrees of freedom, as `even_points` gives them.
    block : int
        How many of them make a block.
    worth : float
        Number of equal weights at which to end.
    points, logs_p, weights : ndarray, shape (N, K), (N,) and (N,)
        Written: the points, the log posterior, the weights.
    mean, matrix : ndarray
        Written: mean and covariance.

    Returns
    -------
    (int, float, float)
        Points used, log evidence, number of equal weights; -inf and 0 if no point is possible.
    """
    kind, n, most = problem.kind, centre.shape[0], table.shape[0]
    root = np.zeros((n, n))
    centres, roots = np.empty((PROPOSALS, n)), np.zeros((PROPOSALS, n, n))
    levels, drawn = np.empty(PROPOSALS), np.zeros(PROPOSALS)
    densities, offsets = np.empty((PROPOSALS, most)), np.empty((2, n))
    proposal, matrix_of_flat = FIRST * covariance, np.empty((n, n))
    aim, flat = centre.copy(), np.empty(most)
    mean[:] = centre
    least = block * (1 if kind == DISC else 2 if kind == OVAL else 4)
    count, proposals, renewed, evidence, equal = 0, 0, 0, -math.inf, 0.0
    while count + block <= most:
        before = count
        if proposals == 0 or (count >= 2 * renewed and proposals < PROPOSALS):
            if proposals > 0:
                flatten(weights, count, FEWEST * n, flat)
                spread_of(points, flat, count, aim, matrix_of_flat)
                for k in range(n):
                    for m in range(n):
                        proposal[k, m] = WIDER * matrix_of_flat[k, m] + KEPT * covariance[k, m]
            if not cholesky(proposal, root):
                break
            renewed = count
            centres[proposals], roots[proposals] = aim, root
            levels[proposals] = 0.0
            for k in range(n):
                levels[proposals] -= math.log(root[k, k])
            proposals += 1
            before = 0
        now = proposals - 1
        for i in range(count, count + block):
            for k in range(n):
                place = centres[now, k]
                for m in range(k + 1):
                    place += roots[now, k, m] * table[i, m]
                points[i, k] = place
            here = log_rest(problem, points[i])
            if here > -math.inf:
                here += likelihood_at(problem, inside, points[i])
                if kind == OVAL:
                    here += log_stretch(points[i])
            logs_p[i] = here
        drawn[now] += block
        for c in range(proposals):
            level = math.exp(levels[c] - levels[0])
            for i in range(before if c == now else count, count + block):
                for k in range(n):
                    offsets[0, k] = points[i, k] - centres[c, k]
                far = squared_length(roots[c], offsets[0], offsets[1])
                densities[c, i] = level * density(far, n)
        count += block
        if count < least and count < 2 * renewed:
            continue
        evidence, equal = weigh_by_density(
            logs_p, densities, drawn / count, proposals, count, weights
        )
        if equal <= 0.0 or (equal >= worth and count >= least):
            break
    if equal > 0.0:
        spread_of(points, weights, count, mean, matrix)
    return count, evidence - levels[0] - t_constant(n), equal
