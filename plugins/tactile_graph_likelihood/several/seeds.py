"""Sets of touched elements that may be an outline each: pieces cut straight where they are empty.

A set of elements whose ellipse of the same moments is much larger than those of its two halves is
no single convex outline. No likelihood is asked; it is where a search begins.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from tactile_graph.compiled import compiled_as_is
from tactile_graph_likelihood.geometry.outlines import Values
from tactile_graph_likelihood.several.partings import Across, across, spread, summed

Mask = NDArray[np.bool_]

EMPTIER = 3.0
"""By how much larger, in elements, a set's ellipse is than its halves' together where it is cut."""


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
        if gains[k] < EMPTIER:
            break
        one = cuts[k][1]
        halves = [one, masks[k] & ~one]
        masks[k : k + 1] = halves
        cuts[k : k + 1] = [fullest_halves(half, least) for half in halves]
    return masks


def fullest_halves(mask: Mask, least: int) -> tuple[float, Mask]:
    """Return how much less ground two halves' ellipses take than the whole's, and one half."""
    half, n = np.zeros_like(mask), int(np.count_nonzero(mask))
    if n < 2 * least:
        return 0.0, half
    piece = across(mask)
    angle, count, gain = fullest_cut.call(piece, np.zeros(mask.shape), least)
    its = piece.order[angle, :count]
    half[piece.row[its], piece.column[its]] = True
    return gain, half


@compiled_as_is
def fullest_cut(piece: Across, logs: Values, least: int) -> tuple[int, int, float]:
    """Return where a straight cut leaves the halves that fill their moments' ellipses best.

    ``logs``, shape (rows, columns), are as in `summed`; what they hold does not matter.

    Returns
    -------
    (int, int, float)
        At which angle, after how many elements, and how much less ground the halves' ellipses take
        than the whole's, in elements.
    """
    n = piece.row.shape[0]
    angle, count, best, whole, place = 0, least, math.inf, 0.0, np.empty(n, np.int64)
    for t in range(piece.order.shape[0]):
        along, order = piece.along[t], piece.order[t]
        sums = summed(piece, t, logs, place)
        whole = spread(sums[n]) if t == 0 else whole
        for k in range(least, n - least + 1):
            if along[order[k]] - along[order[k - 1]] > 1e-9:
                area = spread(sums[k]) + spread(sums[n] - sums[k])
                if area < best:
                    angle, count, best = t, k, area
    return angle, count, whole - best
