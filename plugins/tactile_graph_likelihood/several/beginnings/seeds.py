"""Sets of touched elements that may be an outline each: pieces cut straight where they are empty.

A set of elements whose ellipse of the same moments is much larger than those of its two halves is
no single convex outline. No likelihood is asked; it is where a search begins.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from tactile_graph.compiled import compiled_as_is
from tactile_graph_likelihood.several.beginnings.partings import across, spread, summed

Mask = NDArray[np.bool_]

EMPTIER, OF_MANY = 3.0, 0.01
"""By how much larger, in elements and over their number, a set's ellipse is than its halves'
together where it is cut."""


def seeds(pieces: list[Mask], most: int, least: int) -> list[Mask]:
    """Return pieces cut in two while that takes away empty ground, the emptiest first.

    Parameters
    ----------
    pieces : list of ndarray of bool, shape (rows, columns)
    most : int
        Sets at most, where there are no more pieces.
    least : int
        Elements on either side of a cut.
    """
    masks, cuts = list(pieces), [fullest_halves(mask, least) for mask in pieces]
    while len(masks) < most:
        gains = [gain for gain, _ in cuts]
        k = int(np.argmax(gains))
        if gains[k] < max(EMPTIER, OF_MANY * np.count_nonzero(masks[k])):
            break
        one = cuts[k][1]
        halves = [one, masks[k] & ~one]
        masks[k : k + 1] = halves
        cuts[k : k + 1] = [fullest_halves(half, least) for half in halves]
    return masks


def fullest_halves(mask: Mask, least: int) -> tuple[float, Mask]:
    """Return how much less ground two halves' ellipses take than the whole's, and one half."""
    half = np.zeros_like(mask)
    return fullest_half.call(mask, half, least), half


@compiled_as_is
def fullest_half(mask: Mask, half: Mask, least: int) -> float:
    """Mark one half of a mask where a straight cut leaves those that fill their ellipses best.

    Returns
    -------
    float
        How much less ground the halves' ellipses take than the whole's, in elements.
    """
    piece, count, best, whole = across(mask), 0, math.inf, 0.0
    n, angle = piece.row.shape[0], 0
    if n < 2 * least:
        return 0.0
    logs, place = np.zeros(mask.shape), np.empty(n, np.int64)  # of loads, which do not matter
    for t in range(piece.order.shape[0]):
        along, order = piece.along[t], piece.order[t]
        sums = summed(piece, t, logs, place)
        whole = spread(sums[n]) if t == 0 else whole
        for k in range(least, n - least + 1):
            if along[order[k]] - along[order[k - 1]] > 1e-9:
                area = spread(sums[k]) + spread(sums[n] - sums[k])
                if area < best:
                    angle, count, best = t, k, area
    for k in range(count):
        at = piece.order[angle, k]
        half[piece.row[at], piece.column[at]] = True
    return whole - best
