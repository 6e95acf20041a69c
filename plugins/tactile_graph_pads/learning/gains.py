"""Relative gains of the elements, from objects of any shape put down at many places."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from tactile_graph_pads.learning.silent import between

Array = NDArray[np.float64]
Flags = NDArray[np.bool_]
LEAST_PAIRS = 8.0
"""Comparisons with neighbours from which on an element's gain is told at all, in each half."""
LEAST_PLACEMENTS, LEAST_ELEMENTS = 20, 10
LEAST_SPREAD = 0.2
"""Of the objects' centres over the width of what they touch: less, and each element always lies
under the same part of them."""
LEAST_ALIKE = 0.6
"""Correlation of the gains of two halves of the frames below which they are chance."""


class Gains(NamedTuple):
    """Gains relative to the pad's own, (rows, columns), 1 where nothing is known.

    ``alike`` is the correlation of what two halves of the frames say of the elements' logarithms;
    ``sigma`` the standard deviation of a gain's logarithm in one placement, and ``fixed`` the
    share of its variance that stays with the element. ``halves`` holds both halves' logarithms
    for drawing, NaN where too few comparisons were made. ``lacks`` says what there is too little of
    to tell any gain, empty where there is enough.
    """

    gain: Array
    comparisons: Array
    alike: float
    sigma: float
    fixed: float
    halves: tuple[Array, Array]
    lacks: str = ""

    @property
    def stand_out(self) -> bool:
        """Whether the gains are more than chance."""
        return self.alike >= LEAST_ALIKE and self.fixed > 0.0


def gains(readings: Array, touched: Flags, good: Flags) -> Gains:
    """Return how strongly each element answers compared with its neighbours.

    Parameters
    ----------
    readings : ndarray, shape (placements, rows, columns)
        Above the offset; loads where they are known.
    touched : ndarray of bool, same shape
    good : ndarray of bool, shape (rows, columns)

    Notes
    -----
    Compared are the logarithms of neighbours' readings wherever both lie within a contact (all
    four neighbours touched, void or no good), where a face that is even presses both alike. The
    gains are the most likely ones under a normal prior: with L the Laplacian of the comparisons
    and b their sums, (L / s² + 1 / t²) g = b / s², with s² the variance of one comparison and t²
    that of the gains; t² is the covariance of what two halves of the frames say.
    """
    # Neighbours in time are alike: halves of whole blocks, not every second frame.
    half = (np.arange(len(readings)) * 8 // max(len(readings), 1)) % 2
    within = _within(touched, touched | between(touched), good)
    logs = np.log(np.where(touched & (readings > 0.0), readings, 1.0))
    n = good.size
    sums = [_compare(logs[half == h], within[half == h], n) for h in (0, 1)]
    pairs = sums[0].laplacian + sums[1].laplacian
    number = sums[0].number + sums[1].number
    comparisons = pairs.diagonal().reshape(good.shape)
    fewest = np.minimum(sums[0].laplacian.diagonal(), sums[1].laplacian.diagonal())
    told, seen = fewest >= LEAST_PAIRS, np.where(touched & good, readings, 0.0)
    if lacks := _lacks(seen, fewest, int(good.sum())):
        return _untold(comparisons, np.nan)._replace(lacks=lacks)
    one_comparison = float(sums[0].squares + sums[1].squares) / number
    first, second = (_solved(s.laplacian, s.sums, 1e-2) for s in sums)
    covariance = np.cov(first[told], second[told])
    lasting = max(float(covariance[0, 1]), 0.0)
    if lasting == 0.0:
        return _untold(comparisons, float(np.sqrt(0.5 * one_comparison)))
    alike = lasting / float(np.sqrt(covariance[0, 0] * covariance[1, 1]))
    placement = max(0.5 * one_comparison - lasting, 1e-12)
    logs_of = _solved(pairs, sums[0].sums + sums[1].sums, 2.0 * placement / lasting)
    logs_of -= np.median(logs_of[told])
    gain = np.where(comparisons > 0.0, np.exp(logs_of).reshape(good.shape), 1.0)
    halves = [np.where(told, v, np.nan).reshape(good.shape) for v in (first, second)]
    sigma, fixed = float(np.sqrt(placement + lasting)), lasting / (placement + lasting)
    if alike < LEAST_ALIKE:
        gain, fixed = np.ones(good.shape), 0.0
    return Gains(gain, comparisons, alike, sigma, fixed, (halves[0], halves[1]))


def _lacks(seen: Array, fewest: Array, n_good: int) -> str:
    """Return what there is too little of to tell gains, and how much more is wanted; or nothing.

    ``fewest`` holds each element's comparisons in that half of the placements that has fewer.
    """
    n, n_told = len(seen), int((fewest >= LEAST_PAIRS).sum())
    if n < LEAST_PLACEMENTS:
        return f"at least {LEAST_PLACEMENTS} are needed"
    if (scatter := spread(seen)) < LEAST_SPREAD:
        return (
            f"they lie in one place (their centres scatter by {scatter:.2g} of the width of what "
            f"they touch, at least {LEAST_SPREAD:g} is needed); put objects down all over the pad"
        )
    if n_told >= LEAST_ELEMENTS:
        return ""
    often = float(np.sort(fewest)[-LEAST_ELEMENTS]) if fewest.size >= LEAST_ELEMENTS else 0.0
    told = (
        f"{n_told} of {n_good} elements lay within contacts often enough to be compared with their "
        f"neighbours {LEAST_PAIRS:g} times in each half of them, at least {LEAST_ELEMENTS} are "
        "needed; "
    )
    if often == 0.0:
        return f"{told}put down objects that cover more elements"
    more = int(np.ceil(n * (LEAST_PAIRS / often - 1.0)))
    return f"{told}make about {more} more that touch other elements, of objects of other sizes too"


def spread(readings: Array) -> float:
    """Return how far the centres of placements scatter, over how far readings lie around them.

    Parameters
    ----------
    readings : ndarray, shape (placements, rows, columns)

    Returns
    -------
    float
        The smaller of both axes' ratios of standard deviations; of one axis on a single line.
    """
    total = np.maximum(readings.sum(axis=(1, 2)), 1e-300)
    ratios = []
    for axis, n in ((2, readings.shape[1]), (1, readings.shape[2])):
        if n < 2:
            continue
        profile = readings.sum(axis=axis) / total[:, None]
        centre = profile @ np.arange(n)
        square = np.maximum(profile @ np.arange(n) ** 2 - centre**2, 1e-12)
        ratios.append(float(np.std(centre) / np.sqrt(np.mean(square))))
    return min(ratios, default=0.0)


def _untold(comparisons: Array, sigma: float) -> Gains:
    """Return no gains; ``sigma`` is NaN where too little was compared to tell even that."""
    none = np.full(comparisons.shape, np.nan)
    return Gains(np.ones(comparisons.shape), comparisons, 0.0, sigma, 0.0, (none, none))


class _Sums(NamedTuple):
    """Comparisons of neighbours: their Laplacian (sparse), sums, sum of squares and number."""

    laplacian: Any
    sums: Array
    squares: float
    number: int


def _within(touched: Flags, within: Flags, good: Flags) -> Flags:
    """Return elements whose four neighbours lie in a contact, are no good, or off the pad."""
    ok = np.pad(within | ~good, ((0, 0), (1, 1), (1, 1)), constant_values=True)
    around = ok[:, :-2, 1:-1] & ok[:, 2:, 1:-1] & ok[:, 1:-1, :-2] & ok[:, 1:-1, 2:]
    return np.asarray(touched & good & around)


def _compare(logs: Array, within: Flags, n: int) -> _Sums:
    """Return number and sum of the comparisons of each pair of neighbours, as matrices."""
    from scipy.sparse import coo_array

    index = np.arange(n).reshape(logs.shape[1:])
    sums, squares, number = np.zeros(n), 0.0, 0
    entries: list[tuple[NDArray[Any], NDArray[Any], NDArray[Any]]] = []
    for axis in (1, 2):
        a = (slice(None), slice(None, -1), slice(None)) if axis == 1 else np.s_[:, :, :-1]
        b = (slice(None), slice(1, None), slice(None)) if axis == 1 else np.s_[:, :, 1:]
        both = within[a] & within[b]
        apart = np.where(both, logs[a] - logs[b], 0.0)
        count, total = both.sum(axis=0).ravel(), apart.sum(axis=0).ravel()
        i, j = index[a[1:]].ravel(), index[b[1:]].ravel()
        entries += [(count, i, i), (count, j, j), (-count, i, j), (-count, j, i)]
        sums[i] += total
        sums[j] -= total
        squares += float((apart**2).sum())
        number += int(count.sum())
    values, at, to = (np.concatenate(part) for part in zip(*entries, strict=True))
    laplacian = coo_array((values.astype(np.float64), (at, to)), shape=(n, n)).tocsc()
    return _Sums(laplacian, sums, squares, number)


def _solved(laplacian: Any, sums: Array, ridge: float) -> Array:
    from scipy.sparse import eye_array
    from scipy.sparse.linalg import spsolve

    return np.asarray(spsolve(laplacian + ridge * eye_array(len(sums), format="csc"), sums))
