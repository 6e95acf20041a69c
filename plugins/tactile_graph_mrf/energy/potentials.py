"""The clique potentials as tables: of cells, of pairs of cells, and of lines that meet.

What a clique costs is looked up here and nowhere else; `tactile_graph_mrf.energy.total` adds it
up, `tactile_graph_mrf.energy.conditionals` takes what one cell or line has part in.
"""

from __future__ import annotations

from typing import Literal, NamedTuple

import numpy as np
from numpy.typing import NDArray

Noise = Literal["gaussian", "laplace", "student_t", "poisson", "outliers"]
Smoothness = Literal[
    "quadratic", "truncated_quadratic", "absolute", "truncated_absolute", "huber", "geman_mcclure"
]

OFFSETS = np.array([(0, 1), (1, 0), (1, 1), (1, -1), (0, 2), (2, 0)], np.int64)
"""One (row, column) step for each kind of pair clique; the first 2, 4 and 6 of them are those of
the neighbourhoods of order 1, 2 and 3 (Eq. 5.8, fig. 5.1)."""
UP, DOWN, LEFT, RIGHT = 1, 2, 4, 8
"""Bits of a pattern: which of the four lines that meet where four cells meet are on."""


class Unary(NamedTuple):
    """What cells cost by themselves: ``curvature (x - centre)² + table[row, x]`` for label x.

    Parameters
    ----------
    in_field : ndarray of bool, shape (rows, columns)
        Cells that are sites.
    curvature, centre : ndarray of float64, shape (rows, columns)
        Data term, if Gaussian, and prior: a parabola.
    table : ndarray of float64, shape (kinds, L)
        Data terms of other noise; row 0 holds zeros.
    row : ndarray of int64, shape (rows, columns)
        Row of ``table`` of each cell.
    """

    in_field: NDArray[np.bool_]
    curvature: NDArray[np.float64]
    centre: NDArray[np.float64]
    table: NDArray[np.float64]
    row: NDArray[np.int64]


class Pairwise(NamedTuple):
    """What pairs of cells cost that no line parts.

    Parameters
    ----------
    smooth : ndarray of float64, shape (L,)
        lambda_d * rho of a difference; with ``marginal`` lines at most the price of a line.
    bare : ndarray of float64, shape (L,)
        The same without lines.
    price : float
        Of a line that is summed out; below 0 where lines are no matter of the pair.
    offsets : ndarray of int64, shape (K, 2)
        (row, column) steps of the pair cliques.
    weights : ndarray of float64, shape (K,)
        1 / distance² of each.
    """

    smooth: NDArray[np.float64]
    bare: NDArray[np.float64]
    price: float
    offsets: NDArray[np.int64]
    weights: NDArray[np.float64]


class LineCliques(NamedTuple):
    """What lines cost (Eq. 5.22).

    Parameters
    ----------
    pattern : ndarray of float64, shape (16,)
        lambda_l * V_l4 by pattern: bit 1 for the line up, 2 down, 4 left, 8 right.
    parallel, one : float
        lambda_l * V_l2 and lambda_l * V_l1.
    """

    pattern: NDArray[np.float64]
    parallel: float
    one: float


class Potentials(NamedTuple):
    """All that an energy is made of."""

    unary: Unary
    pairwise: Pairwise
    lines: LineCliques


def data_costs(
    noise: Noise,
    observed: NDArray[np.float64],
    n_levels: int,
    *,
    sigma: float,
    freedom: float,
    outlier_share: float,
    zero_level: float,
) -> NDArray[np.float64]:
    """Return what each level costs against each observation, shape (observations, levels).

    All noises are scaled to ``-2 sigma² log P(N = Phi(F, G))`` of Eq. 5.14 up to a constant, so
    that the Gaussian one is the squared difference of Eq. 5.7 and 5.17 whatever its sigma, and
    the same lambdas suit all of them. The cost of an exact agreement is 0, but for ``outliers``
    where that is so up to the share of the outliers.

    Parameters
    ----------
    noise : str
        ``gaussian``; ``laplace`` of standard deviation sigma; ``student_t`` of scale sigma;
        ``poisson``: variance in proportion to the load, equal to the Gaussian's at half range;
        ``outliers``: Gaussian, but a share of the cells reads anything within the range.
    observed : ndarray of float64, shape (observations,)
        In levels.
    n_levels : int
    sigma : float
        Standard deviation of the noise, in levels.
    freedom : float
        Degrees of freedom of Student's t.
    outlier_share : float
        Expected share of cells that read anything.
    zero_level : float
        Where a load of zero lies on the scale of levels (below 0 if the image's least is above).

    Returns
    -------
    ndarray of float64
    """
    level = np.arange(n_levels, dtype=np.float64)
    d = np.abs(level[None, :] - observed[:, None])
    if noise == "gaussian":
        return np.asarray(d * d)
    if noise == "laplace":
        return np.asarray(2.0 * np.sqrt(2.0) * sigma * d)
    variance = sigma * sigma
    if noise == "student_t":
        return np.asarray(variance * (freedom + 1.0) * np.log1p(d * d / (freedom * variance)))
    if noise == "poisson":
        # One level stands in for no load at all: a Poisson variable of mean 0 forbids any other.
        load = np.maximum(level - zero_level, 0.0) + 1.0
        seen = np.maximum(observed - zero_level, 0.0)[:, None] + 1.0
        middle = max(0.5 * (n_levels - 1) - zero_level, 0.0) + 1.0
        deviance = load - seen + seen * np.log(seen / load)
        return np.asarray(2.0 * middle * np.maximum(deviance, 0.0))
    flat = outlier_share / (1.0 - outlier_share) * np.sqrt(2.0 * np.pi) * sigma / n_levels
    return np.asarray(-2.0 * variance * np.logaddexp(-0.5 * d * d / variance, np.log(flat)))


def smoothness_costs(kind: Smoothness, n_levels: int, truncation: float) -> NDArray[np.float64]:
    """Return the cost of each difference of two levels in a clique, shape (levels,).

    ``quadratic`` is Eq. 5.6. The others grow less beyond ``truncation`` levels: the truncated
    ones not at all, ``huber`` linearly; ``geman_mcclure`` is d² t² / (t² + d²).
    """
    d = np.arange(n_levels, dtype=np.float64)
    t = truncation
    if kind == "quadratic":
        return d * d
    if kind == "truncated_quadratic":
        return np.asarray(np.minimum(d * d, t * t))
    if kind == "absolute":
        return d
    if kind == "truncated_absolute":
        return np.asarray(np.minimum(d, t))
    if kind == "huber":
        return np.where(d <= t, d * d, t * (2.0 * d - t))
    return np.asarray(d * d / (1.0 + (d / t) ** 2))


def pattern_costs(
    end: float, straight: float, corner: float, tee: float, cross: float
) -> NDArray[np.float64]:
    """Return V_l4 of Eq. 5.22 for each of the 16 patterns of four lines that meet, shape (16,)."""
    costs = np.zeros(16)
    for code in range(16):
        on = bin(code).count("1")
        through = code in (UP | DOWN, LEFT | RIGHT)
        costs[code] = (0.0, end, straight if through else corner, tee, cross)[on]
    return costs
