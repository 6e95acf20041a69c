"""What wires are made of, as machine code hands them from one step to the next.

Steps that offer a linked form (`tactile_graph.steps.Linked`) take and give these in place of the
wires themselves: nothing that Python must make stands between two of them.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from tactile_graph.wires.image import Mask, packed_mask
from tactile_graph.wires.points import Points, quick_points
from tactile_graph.wires.shapes import Polygon, quick_polygon


class MaskParts(NamedTuple):
    """A mask of at most 64 columns, by its rows.

    Attributes
    ----------
    words : ndarray of uint64, shape (rows,)
        Bit c is column c; higher ones are 0.
    columns : int
    pitch_x, pitch_y, x0, y0 : float
        Pitch and origin in cm.
    count : int
        Number of cells that are on.
    """

    words: NDArray[np.uint64]
    columns: int
    pitch_x: float
    pitch_y: float
    x0: float
    y0: float
    count: int  # type: ignore[assignment]  # of cells, where a tuple counts its items


class PointsParts(NamedTuple):
    """Positions in cm, shape (N, 2)."""

    xy_cm: NDArray[np.float64]


class PolygonParts(NamedTuple):
    """A polygon, by its corners."""

    points: PointsParts


def mask_of(
    words: NDArray[np.uint64],
    columns: int,
    pitch_x: float,
    pitch_y: float,
    x0: float,
    y0: float,
    count: int,
) -> Mask:
    """Return the mask that `MaskParts` are of."""
    return packed_mask(words, columns, (pitch_x, pitch_y), (x0, y0), count)


def points_of(xy_cm: NDArray[np.float64]) -> Points:
    """Return the points that `PointsParts` are of."""
    return quick_points(xy_cm)


def polygon_of(points: PointsParts) -> Polygon:
    """Return the polygon that `PolygonParts` are of."""
    return quick_polygon(points.xy_cm)
