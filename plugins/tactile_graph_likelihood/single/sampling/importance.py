"""Importance weights of points drawn from Student's t, and what weighted points say.

Points that come from several proposals are weighted together, by the mixture they come from (J.-M.
Cornuet et al. 2012, 10.1111/j.1467-9469.2011.00756.x).
"""

from __future__ import annotations

import math

import numpy as np

from tactile_graph.compiled import compiled_as_is
from tactile_graph_likelihood.geometry.linear import inverse_root
from tactile_graph_likelihood.geometry.outlines import Values

FREEDOM = 8.0  # of Student's t
WIDER = 1.3  # a proposal's variance over that of the posterior so far
HALF_STEP = math.gamma(0.5 * (FREEDOM + 1.0)) / math.gamma(0.5 * FREEDOM)
KEPT = 0.02  # of the first covariance, added to each later one: it stays invertible
FEWEST = 3.0  # equal weights per unknown: fewer are tempered before a covariance is taken


@compiled_as_is
def t_density(length: float, unknowns: int) -> float:
    """Return Student's t density at a squared length, over that in its middle."""
    power = round(FREEDOM) + unknowns
    base = 1.0 / (1.0 + length / FREEDOM)
    found = math.sqrt(base) if power % 2 == 1 else 1.0
    for _ in range(power // 2):
        found *= base
    return found


@compiled_as_is
def t_constant(unknowns: int) -> float:
    """Return the logarithm of Student's t density in the middle, of unit scale."""
    odd = unknowns % 2
    ratio = HALF_STEP if odd == 1 else 1.0
    for k in range(unknowns // 2):
        ratio *= 0.5 * (FREEDOM + odd) + k
    found: float = math.log(ratio) - 0.5 * unknowns * math.log(FREEDOM * math.pi)
    return found


@compiled_as_is
def weigh(
    logs_p: Values, densities: Values, shares: Values, proposals: int, count: int, weights: Values
) -> tuple[float, float]:
    """Write the weights of ``count`` points, summing to 1.

    Parameters
    ----------
    logs_p : ndarray, shape (N,)
        Log posterior of each point, up to a constant.
    densities : ndarray, shape (proposals, N)
        Of each point under each proposal, up to one factor.
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
    top = -math.inf
    for i in range(count):
        if logs_p[i] == -math.inf:
            weights[i] = -math.inf
            continue
        mixed = 0.0
        for c in range(proposals):
            mixed += shares[c] * densities[c, i]
        weights[i] = logs_p[i] - math.log(mixed)
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
def temper(weights: Values, count: int, wanted: float, flat: Values) -> None:
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
def weighted_moments(
    points: Values, weights: Values, count: int, mean: Values, matrix: Values
) -> None:
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
def normal_points(
    p: Values, root: Values, steps: Values, pull: Values
) -> tuple[Values, Values, Values]:
    """Return points of a normal distribution of a mode's first numbers, the others known.

    Parameters
    ----------
    p : ndarray, shape (K,)
    root : ndarray, shape (K, K)
        Of the information there, a lower triangle; of the first n numbers its first n rows are.
    steps : ndarray, shape (N, n)
        Points of Student's t, of `FREEDOM` and unit scale.
    pull : ndarray, shape (n,)
        Slope of what is known besides, and was not where the mode was looked for: the mean is
        that much farther on.

    Returns
    -------
    mean : ndarray, shape (n,)
    points : ndarray, shape (N, n)
        With the distribution's own variance.
    covariance : ndarray, shape (n, n)
    """
    n, scale = steps.shape[1], math.sqrt(1.0 - 2.0 / FREEDOM)
    spread, covariance = inverse_root(root[:n, :n]), np.zeros((n, n))
    for i in range(n):
        for j in range(i + 1):
            for k in range(i, n):
                covariance[i, j] += spread[k, i] * spread[k, j]
            covariance[j, i] = covariance[i, j]
    mean, points = p[:n].copy(), np.empty(steps.shape)
    for i in range(n):
        for j in range(n):
            mean[i] += covariance[i, j] * pull[j]
    for i in range(steps.shape[0]):
        for j in range(n):
            along = 0.0
            for k in range(j, n):
                along += steps[i, k] * spread[k, j]
            points[i, j] = mean[j] + scale * along
    return mean, points, covariance
