"""Whether an image looks like the model's at all: numbers that are normal where it does."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from tactile_graph.compiled import compiled_as_is
from tactile_graph_likelihood.geometry.covered import Box
from tactile_graph_likelihood.geometry.linear import cholesky, squared_length
from tactile_graph_likelihood.geometry.outlines import RECTANGLE, Values, unknowns
from tactile_graph_likelihood.single.density.element_terms import (
    CONTRAST,
    FALL,
    LEAST,
    ON,
    OVER,
    ROOT_TWO_PI,
    SIGMA,
    SPAN,
    SQRT_HALF,
    STRAYS,
    UNDER,
    UNKNOWN,
    VOIDS,
    States,
)
from tactile_graph_likelihood.single.density.load_shares import press, shares_around
from tactile_graph_likelihood.single.density.log_posterior import noise_at
from tactile_graph_likelihood.single.density.problem import Problem

SURE = 1.5  # standard deviations of ln gain by which a covered element's load exceeds the least
SEEN = -1.0  # the same, for what reads a load at all
MOST = 3.5  # a stray's residual counts as no more
DENSITY = 1.0 / ROOT_TWO_PI
FEWEST = 8  # residuals, for a trend
BALL = 0.5  # fall of a ball's pressure
RIM = 0.15  # pressure squared at the rim: the outermost elements are covered in part only


class GoodnessOfFit(NamedTuple):
    """How well an image fits an outline: numbers that are about normal where the model holds.

    ``surprise``: the log likelihood less its expectation under the model, less half the number of
    unknowns that were fitted, in its standard deviations: below -3 the readings are worse than the
    model's own. ``neighbours``: how alike neighbours' residuals are; ``lean``: how much they lean
    to a side, 0 where they don't, by and large; ``fall``: how much they fall to the rim; each in
    its standard deviations. Above 3 the model takes for many bumps what is one, or the load is not
    spread over the outline as it thinks, as under a tilt, foam or a curved face.
    """

    surprise: float
    neighbours: float
    lean: float
    fall: float


NO_FIT = GoodnessOfFit(0.0, 0.0, 0.0, 0.0)


@compiled_as_is
def standardised(u: float, z: float, tail: float, density: float) -> float:
    """Return a residual of mean 0 and variance 1, given that it shows, which it does above -z.

    ``tail`` and ``density`` are Phi(z) and phi(z).
    """
    ratio = density / tail
    scaled = (u - ratio) / math.sqrt(1.0 - ratio * (z + ratio))
    return min(max(scaled, -MOST), MOST)


@compiled_as_is
def moments_of_strays(strays: float) -> tuple[float, float]:
    """Return mean and variance of the term of an element on which nothing is expected."""
    stray, bare = math.log(strays / SPAN), math.log(1.0 - strays)
    mean = strays * stray + (1.0 - strays) * bare
    return mean, strays * stray * stray + (1.0 - strays) * bare * bare - mean * mean


@compiled_as_is
def moments_of_term(
    z: float, tail: float, density: float, level: float, present: float, bare: float
) -> tuple[float, float, float]:
    """Return the term of an expected element that reads nothing, and all terms' mean and variance.

    ``level`` is the largest log likelihood of a reading, ``present`` the share of elements that
    are no voids. With u normal and cut at -z, the mean of u**2 is ``Phi(z) - z phi(z)`` and that
    of u**4 ``3 Phi(z) - (z**3 + 3 z) phi(z)``.
    """
    none = 1.0 - present * tail
    off = bare + math.log(none)
    second = tail - z * density
    fourth = 3.0 * tail - (z * z * z + 3.0 * z) * density
    one = present * (level * tail - 0.5 * second) + none * off
    two = present * (level * level * tail - level * second + 0.25 * fourth)
    return off, one, two + none * off * off - one * one


class Neighbours(NamedTuple):
    """Sums over pairs of neighbours' residuals, and over residuals."""

    n_pairs: float
    product: float
    n_residuals: float
    squares: float


@compiled_as_is
def neighbours_of(residuals: Values) -> Neighbours:
    """Return what neighbours' residuals sum up to.

    Parameters
    ----------
    residuals : ndarray, shape (rows, columns)
        Normal under the model; 0 where there is none.
    """
    rows, columns = residuals.shape
    pairs = product = count = squares = 0.0
    for i in range(rows):
        for j in range(columns):
            here = residuals[i, j]
            if here == 0.0:
                continue
            count += 1.0
            squares += here * here
            if i + 1 < rows and residuals[i + 1, j] != 0.0:
                pairs += 1.0
                product += here * residuals[i + 1, j]
            if j + 1 < columns and residuals[i, j + 1] != 0.0:
                pairs += 1.0
                product += here * residuals[i, j + 1]
    return Neighbours(pairs, product, count, squares)


@compiled_as_is
def neighbours_alike(residuals: Values) -> float:
    """Return the correlation of neighbours' residuals, in its standard deviations."""
    pairs, product, count, squares = neighbours_of(residuals)
    return product * count / (math.sqrt(pairs) * squares) if pairs > 0.0 else 0.0


@compiled_as_is
def dome(share: Values) -> Values:
    """Return the logarithm of the pressure under a ball that covers what an outline covers.

    Parameters
    ----------
    share : ndarray, shape (rows, columns)
        Of each element that is covered.

    Notes
    -----
    The pressure is ``sqrt(1 - 0.85 r**2)``; r is the distance from the middle in terms of the
    share's second moments, so 1 at the rim of a disc or ellipse.
    """
    rows, columns = share.shape
    total = y = x = yy = xy = xx = 0.0
    for i in range(rows):
        for j in range(columns):
            c = share[i, j]
            total += c
            y += c * i
            x += c * j
            yy += c * i * i
            xy += c * i * j
            xx += c * j * j
    out = np.zeros(share.shape)
    if total <= 0.0:
        return out
    y, x = y / total, x / total
    yy, xy, xx = yy / total - y * y, xy / total - x * y, xx / total - x * x
    area = yy * xx - xy * xy
    if area < 1e-3:
        return out
    for i in range(rows):
        for j in range(columns):
            u, v = i - y, j - x
            squared = 0.25 * (xx * u * u - 2.0 * xy * u * v + yy * v * v) / area
            out[i, j] = 0.5 * math.log(max(1.0 - (1.0 - RIM) * squared, 0.5 * RIM))
    return out


@compiled_as_is
def dome_over(problem: Problem, p: Values, noise: Values, box: Box, share: Values) -> Values:
    """Return the logarithm of a ball's pressure where an outline covers anything.

    Parameters
    ----------
    problem, p
        As in `log_posterior.log_likelihood`.
    noise : ndarray, shape (9,)
        At that point.
    box, share
        As of `load_shares.shares_around`.

    Notes
    -----
    That of a rectangle has edges, as its own shape has: by its moments, of `dome`, its corners
    would lie beyond the rim.
    """
    if problem.kind != RECTANGLE:
        return dome(share)
    ball, out = noise.copy(), np.where(share > 0.0, 1.0, 0.0)
    ball[FALL] = BALL
    press(problem.kind, problem.corners, p, problem.grid, ball, box, out)
    for i in range(share.shape[0]):
        for j in range(share.shape[1]):
            if out[i, j] > 0.0:
                out[i, j] = math.log(out[i, j])
    return out


@compiled_as_is
def trend(residuals: Values, domes: Values) -> tuple[float, float]:
    """Return how much residuals lean to a side, and fall to the rim, in standard deviations.

    Parameters
    ----------
    residuals : ndarray, shape (rows, columns)
        Of mean 0 and equal variance under the model; 0 where there is none.
    domes : ndarray, the same shape
        As `dome` gives it.

    Notes
    -----
    Residuals are regressed on row and column, and on what these leave of the dome: score tests of
    a load that leans, and of one that falls or rises towards the rim. For the lean, the number of
    residuals times the explained share of their squares, s, is chi squared with 2 degrees of
    freedom, and ``sqrt(2 s) - sqrt(3)`` nearly normal (R. A. Fisher).
    """
    means, values = np.zeros(4), np.empty(4)
    matrix, right, root = np.zeros((3, 3)), np.zeros(3), np.zeros((3, 3))
    count = squares = 0.0
    for turn in range(2):
        for i in range(domes.shape[0]):
            for j in range(domes.shape[1]):
                here = residuals[i, j]
                if here == 0.0:
                    continue
                values[0], values[1], values[2], values[3] = i, j, domes[i, j], here
                if turn == 0:
                    count += 1.0
                    for k in range(4):
                        means[k] += values[k]
                    continue
                for k in range(4):
                    values[k] -= means[k]
                squares += values[3] * values[3]
                for k in range(3):
                    right[k] += values[k] * values[3]
                    for m in range(k + 1):
                        matrix[k, m] += values[k] * values[m]
        if turn == 0:
            if count < FEWEST:
                return 0.0, 0.0
            means /= count
    if squares <= 0.0 or not cholesky(matrix, root):
        return 0.0, 0.0
    squared_length(root, right, values)
    scale = 2.0 * count / squares
    tilt = math.sqrt(scale * (values[0] * values[0] + values[1] * values[1])) - math.sqrt(3.0)
    return tilt, math.sqrt(0.5 * scale) * values[2]


class Unexplained(NamedTuple):
    """How far readings are from what is expected of them.

    ``surprise`` is the log likelihood less its expectation under the model and half the numbers
    that were fitted, in its standard deviations. Of each element of a window that reads a load:
    ``residuals``, 0 where they would be cut by what shows, and ``leaning``, freed of that.
    """

    surprise: float
    residuals: Values
    leaning: Values


@compiled_as_is
def unexplained(
    shares: Values, load: float, row: int, column: int, logs: Values, states: States,
    noise: Values, fitted: int,
) -> Unexplained:  # fmt: skip
    """Return how far an image is from what is expected of it.

    Parameters
    ----------
    shares, load, row, column, logs, states, noise
        As in `element_terms.terms`.
    fitted : int
        How many numbers were fitted.
    """
    sigma, voids, strays = noise[SIGMA], noise[VOIDS], noise[STRAYS]
    level = math.log((1.0 - strays) * (1.0 - voids) / (sigma * ROOT_TWO_PI))
    stray, bare = math.log(strays / SPAN), math.log(1.0 - strays)
    mean_bare, var_bare = moments_of_strays(strays)
    got = mean = variance = 0.0
    residuals, leaning = np.zeros(shares.shape), np.zeros(shares.shape)
    last = last_least = math.nan
    mu = z = tail = density = off = one = spread = 0.0
    for i in range(states.shape[0]):
        for j in range(states.shape[1]):
            if states[i, j] == UNKNOWN or states[i, j] == OVER:
                continue
            on = states[i, j] == ON
            r, c = i - row, j - column
            inside = 0 <= r < shares.shape[0] and 0 <= c < shares.shape[1]
            if not inside or shares[r, c] <= 0.0:
                got += stray if on else bare
                mean += mean_bare
                variance += var_bare
                continue
            least = logs[i, j] if states[i, j] == UNDER else noise[LEAST]
            if shares[r, c] != last or least != last_least:
                last, last_least = shares[r, c], least
                mu = noise[CONTRAST] * math.log(last) + load
                z = min(max((mu - least) / sigma, -40.0), 40.0)
                tail, density = 0.5 * math.erfc(-SQRT_HALF * z), DENSITY * math.exp(-0.5 * z * z)
                off, one, spread = moments_of_term(z, tail, density, level, 1.0 - voids, bare)
            if on:
                u = (logs[i, j] - mu) / sigma
                got += math.log(math.exp(level - 0.5 * u * u) + strays / SPAN)
                residuals[r, c] = u if z > SURE else 0.0
                leaning[r, c] = standardised(u, z, tail, density) if z > SEEN else 0.0
            else:
                got += off
            mean += one
            variance += spread
    # any of them may be a stray, though none is where all that is covered is sure to read nothing
    surprise = (got - 0.5 * fitted - mean) / math.sqrt(max(variance, var_bare))
    return Unexplained(surprise, residuals, leaning)


@compiled_as_is
def goodness_of_fit(problem: Problem, p: Values) -> GoodnessOfFit:
    """Return how surprising an image is, and what patterns it leaves over, at a posterior mean."""
    kind, corners, states = problem.kind, problem.corners, problem.states
    noise, load = noise_at(problem, p), p[unknowns(kind, corners)]
    box, share = shares_around(kind, corners, p, problem.grid, noise, states.shape)
    left = unexplained(share, load, box[0], box[1], problem.logs, states, noise, p.shape[0])
    lean, fall = trend(left.leaning, dome_over(problem, p, noise, box, share))
    return GoodnessOfFit(left.surprise, neighbours_alike(left.residuals), lean, fall)
