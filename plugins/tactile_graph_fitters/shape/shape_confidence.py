"""How sure it is what an outline is of: a logistic regression on how far shapes are off it."""

from __future__ import annotations

import math
from typing import Literal, TypeAlias

import numpy as np
from numpy.typing import NDArray

from tactile_graph_fitters.shape.shape_fits import FEWEST_CORNERS

Values: TypeAlias = NDArray[np.float64]
Kind = Literal["disc", "ellipse", "rectangle", "polygon"]

KINDS: tuple[Kind, ...] = ("disc", "ellipse", "rectangle", "polygon")
MOST_CORNERS = 6
"""Polygons of 3 to so many corners are looked at."""
FLOOR_CELLS2 = 0.01  # squared distance, in cells, below which nearer is not better
CEILING_CELLS2 = 5.0  # taken for a shape that cannot be fitted
USUAL_CELLS = 20.0  # length of an outline

# Rows: constant, ln of the outline's length over `USUAL_CELLS`, ln of the mean squared distances
# from disc, ellipse, rectangle and polygons of 3 to 6 corners. Columns as `KINDS`. Fitted by
# ``benchmarks/shape_confidence.py --fit``.
WEIGHTS = np.array([
    (3.697, 1.739, -3.384, -2.052),
    (0.330, -2.324, 1.230, 0.765),
    (-1.698, 1.810, 1.550, -1.661),
    (0.825, -1.782, -0.190, 1.147),
    (-0.557, 0.865, -1.438, 1.130),
    (-0.180, 0.267, 0.230, -0.317),
    (0.223, 0.105, -0.434, 0.106),
    (0.275, 0.127, -0.275, -0.127),
    (1.164, -0.011, 0.007, -1.160),
])  # fmt: skip


def features(length_cm: float, mean_squares_cm2: Values, cell_cm: float) -> Values:
    """Return what the regression is on, shape (9,).

    Parameters
    ----------
    length_cm : float
        Of the outline.
    mean_squares_cm2 : ndarray, shape (at least `MOST_CORNERS` + 1,)
        From `shape_fits`.
    cell_cm : float
        Pitch of the elements that were read.

    Notes
    -----
    A hull of fewer corners than a polygon is its own polygon of that many.
    """
    out = np.empty(4 + MOST_CORNERS - 1)
    out[0], out[1] = 1.0, math.log(length_cm / cell_cm / USUAL_CELLS)
    area, last = cell_cm * cell_cm, math.inf
    for row in range(MOST_CORNERS + 1):
        mean_square = float(mean_squares_cm2[row])
        if row > FEWEST_CORNERS and mean_square == math.inf:
            mean_square = last
        last = mean_square
        out[2 + row] = math.log(min(mean_square / area, CEILING_CELLS2) + FLOOR_CELLS2)
    return out


def confidences(found: Values, temperature: float = 1.0) -> list[float]:
    """Return the confidence of each of `KINDS`; they sum to 1.

    Parameters
    ----------
    found : ndarray, shape (9,)
        From `features`.
    temperature : float
        What the logarithms of all confidences are divided by.
    """
    scores = (found @ WEIGHTS / temperature).tolist()
    best = max(scores)
    weights = [math.exp(score - best) for score in scores]
    total = sum(weights)
    return [weight / total for weight in weights]
