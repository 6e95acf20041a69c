"""The logarithm of the posterior density of an outline, its load and, if asked, the noise.

The numbers of a point are the outline's own (see `outlines`), the logarithm of the load of a
fully covered element, and one for each part of the noise that is estimated with them: ln sigma,
the log odds of a void, ln of the foam's width.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from tactile_graph.compiled import compiled_as_is
from tactile_graph_likelihood.covered import FOAM_REACH, blurred, covered, window
from tactile_graph_likelihood.element_terms import FOAM, SPAN, VOIDS, States, terms
from tactile_graph_likelihood.outline_prior import log_prior
from tactile_graph_likelihood.outlines import Values, unknowns

Places = NDArray[np.int64]

LN_TWO_PI = math.log(2.0 * math.pi)


@compiled_as_is
def noise_at(p: Values, first: int, noise: Values, estimated: Places) -> Values:
    """Return the noise at a point: ``noise``, but for what is estimated, from ``p[first]`` on."""
    if estimated.shape[0] == 0:
        return noise
    found = noise.copy()
    for k in range(estimated.shape[0]):
        value = math.exp(min(max(p[first + k], -30.0), 30.0))
        found[estimated[k]] = value / (1.0 + value) if estimated[k] == VOIDS else value
    return found


@compiled_as_is
def foam_margin(grid: Values, noise: Values) -> float:
    """Return how far, in cm, foam carries load beyond an outline."""
    foam = (FOAM_REACH * noise[FOAM] + 2.0) * grid[2] if noise[FOAM] > 0.0 else 0.0
    margin: float = foam + grid[5]
    return margin


@compiled_as_is
def log_likelihood(
    kind: int,
    corners: int,
    p: Values,
    grid: Values,
    logs: Values,
    states: States,
    noise: Values,
    estimated: Places,
) -> float:
    """Return the log likelihood of an image over that of a bare pad.

    Parameters
    ----------
    kind, corners : int
        Of the outline, as in `outlines`.
    p : ndarray, shape (K,)
        The point, as above.
    grid : ndarray, shape (4,)
        Left and top edge of the first element, pitch, side of an element; in cm.
    logs, states : ndarray, shape (rows, columns)
        The image, as in `element_terms`.
    noise : ndarray, shape (5,)
        As in `element_terms`.
    estimated : ndarray of int
        Which of them are the point's own instead.
    """
    first = unknowns(kind, corners)
    rows, columns = states.shape
    here = noise_at(p, first + 1, noise, estimated)
    margin = foam_margin(grid, here)
    box = window(kind, corners, p, grid, rows, columns, margin)
    if box[2] <= 0 or box[3] <= 0:
        return 0.0
    expected = covered(kind, corners, p, grid, box)
    if here[FOAM] > 0.0:
        expected = blurred(expected, here[FOAM], box, rows, columns)
    scale = math.exp(p[first])
    for i in range(expected.shape[0]):
        for j in range(expected.shape[1]):
            expected[i, j] *= scale
    return terms(expected, box[0], box[1], logs, states, here)


@compiled_as_is
def log_rest(
    kind: int,
    corners: int,
    p: Values,
    guess: Values,
    prior: Values,
    belief: Values,
    precision: Values,
) -> float:
    """Return the log density of everything but the image: priors and belief.

    Parameters
    ----------
    kind, corners, p
        As in `log_likelihood`.
    guess : ndarray, shape (M, 2)
        Mean and standard deviation of each estimated part of the noise.
    prior : ndarray, shape (9,)
        As in `outline_prior`.
    belief, precision : ndarray, shape (D,) and (D, D)
        A normal belief about the outline that multiplies the prior; zeros for none. The caller
        puts its constant, if it matters, into the prior's `EXTRA`.
    """
    total = log_prior(kind, corners, p, prior)
    if total == -math.inf:
        return total
    first = unknowns(kind, corners)
    total -= math.log(SPAN)
    for k in range(guess.shape[0]):
        off = (p[first + 1 + k] - guess[k, 0]) / guess[k, 1]
        total -= 0.5 * (off * off + LN_TWO_PI) + math.log(guess[k, 1])
    for i in range(first):
        for k in range(first):
            total -= 0.5 * (p[i] - belief[i]) * precision[i, k] * (p[k] - belief[k])
    return total


@compiled_as_is
def log_likelihoods(
    kind: int,
    corners: int,
    points: Values,
    grid: Values,
    logs: Values,
    states: States,
    noise: Values,
    estimated: Places,
) -> Values:
    """Return `log_likelihood` of many points, shape (N, K)."""
    out = np.empty(points.shape[0])
    for k in range(points.shape[0]):
        out[k] = log_likelihood(kind, corners, points[k], grid, logs, states, noise, estimated)
    return out
