"""Sets of touched elements that may be an outline each: pieces cut straight where they are empty.

A set of elements whose ellipse of the same moments is much larger than those of its two halves is
no single convex outline. No likelihood is asked; it is where a search begins.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from tactile_graph_likelihood.geometry.outlines import Values
from tactile_graph_likelihood.several.partings import OWN, across

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
    x, y = piece.column[piece.order].astype(float), piece.row[piece.order].astype(float)
    sums = np.cumsum(np.stack([np.ones_like(x), x, y, x * x, x * y, y * y], axis=-1), axis=1)
    every, first = sums[0, -1], sums[:, least - 1 : n - least]
    along = np.take_along_axis(piece.along, piece.order, axis=1)
    apart = along[:, least : n - least + 1] - along[:, least - 1 : n - least] > 1e-9
    area = np.where(apart, ground(first) + ground(every - first), np.inf)
    angle, k = np.unravel_index(int(area.argmin()), area.shape)
    its = piece.order[angle, : int(k) + least]
    half[piece.row[its], piece.column[its]] = True
    return float(ground(every) - area[angle, k]), half


def ground(sums: Values) -> Values:
    """Return areas of the ellipses that have the moments of some elements, in elements.

    From sums over them along the last axis: number, x, y, xx, xy and yy.
    """
    n, x, y, xx, xy, yy = np.moveaxis(sums, -1, 0)
    across_x, across_y = xx / n - (x / n) ** 2 + OWN, yy / n - (y / n) ** 2 + OWN
    both = xy / n - x * y / (n * n)
    area: Values = np.sqrt(np.maximum(across_x * across_y - both * both, OWN * OWN))
    return 4.0 * np.pi * area
