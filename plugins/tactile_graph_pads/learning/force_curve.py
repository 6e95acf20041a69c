"""A rising law from readings to grams, from whole objects of known weight."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
LEAST_FRAMES = 6
LEAST_SPAN = 1.5
"""Heaviest over lightest weight from which on a law, and not one factor, can be told."""
MOST_KNOTS = 10


class ForceCurve(NamedTuple):
    """Points (reading, grams) of a law that never falls, and how well it weighs what it was not
    made from: ``found_g`` beside ``true_g`` of each frame, held out in turn with its block. The
    first point has 0 g: what reads less is noise."""

    points: tuple[tuple[float, float], ...]
    found_g: Array
    true_g: Array

    @property
    def off_percent(self) -> float:
        """Median error of a held-out weight."""
        return float(100.0 * np.median(np.abs(self.found_g / self.true_g - 1.0)))


def force_curve(readings: Array, weight_g: Array, shows_from: float) -> ForceCurve | None:
    """Return the law whose grams, summed over each frame, come nearest its weight.

    Parameters
    ----------
    readings : ndarray, shape (frames, elements)
        Above the offset.
    weight_g : ndarray, shape (frames,)
        NaN where nobody knows it.
    shows_from : float
        Readings below are 0 g.

    Returns
    -------
    ForceCurve or None
        None where too few weights are known, or they are too much alike.

    Notes
    -----
    A sum of rises that are not negative is linear in them: a non-negative least squares problem
    (Lawson and Hanson 1974) of the relative errors of weight, as in ``calibrate --fit sums``.
    """
    known = np.isfinite(weight_g) & (weight_g > 0.0) & (readings > shows_from).any(axis=1)
    weights = weight_g[known]
    if known.sum() < LEAST_FRAMES or weights.max() < LEAST_SPAN * weights.min():
        return None
    seen = readings[known]
    nodes = _nodes(seen, shows_from)
    if len(nodes) < 2:
        return None
    block = np.arange(len(seen)) % min(5, len(seen))
    found = np.empty(len(seen))
    for k in range(int(block.max()) + 1):
        out = block == k
        grams = _fitted(seen[~out], weights[~out], nodes)
        found[out] = np.interp(seen[out], nodes, grams).sum(axis=1)
    grams = _fitted(seen, weights, nodes)
    if grams[-1] <= 0.0:
        return None
    points = tuple(zip(nodes.tolist(), grams.tolist(), strict=True))
    return ForceCurve(points, found, weights)


def _nodes(seen: Array, shows_from: float) -> Array:
    """Return readings, rising, at which the law bends: rounded up as they are written."""
    shown = seen[seen > shows_from]
    inner = np.quantile(shown, np.linspace(0.0, 1.0, MOST_KNOTS + 1))
    return np.unique([_rounded_up(float(x)) for x in (shows_from, *inner)])


def _rounded_up(reading: float) -> float:
    """Return a reading with 6 digits, none below it: a law reads nothing past its last point."""
    rounded = float(f"{reading:.6g}")
    if rounded >= reading:
        return rounded
    return float(f"{rounded + 10.0 ** (math.floor(math.log10(reading)) - 5):.6g}")


def _fitted(seen: Array, weight_g: Array, nodes: Array) -> Array:
    from scipy.optimize import nnls

    rises = np.clip((seen[:, :, None] - nodes[:-1]) / np.diff(nodes), 0.0, 1.0).sum(axis=1)
    found = nnls(rises / weight_g[:, None], np.ones(len(weight_g)))[0]
    return np.append(0.0, np.cumsum(found))
