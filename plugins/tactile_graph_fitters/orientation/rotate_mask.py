"""``rotate_mask``: a mask turned about a footprint's centre, cell by cell and rounded."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from tactile_graph.compiled import compiled_later
from tactile_graph.errors import Degenerate
from tactile_graph.wires import Mask
from tactile_graph_fitters.orientation.orientation import Orientation, require_finite

MOST_CELLS = 1 << 24
"""Of a turned mask."""


def rotate_mask(mask: Mask, axis: Orientation) -> Mask:
    """Return the mask turned about the axis' centre so that the axis lies along x.

    Parameters
    ----------
    mask : Mask
        The finer the better: each cell may move by half a cell both ways.
    axis : Orientation
        Its centre stays where it is; as seen, everything turns clockwise by its angle.

    Returns
    -------
    Mask
        Of the same pitch, that of square cells as large where they are not square, just large
        enough for the cells that are on, one of its cells centred on the axis' centre. It is in pad
        coordinates but for the turn; what is found in it is turned back with the same ``axis``, as
        `fit_ellipse_origin` does.

    Raises
    ------
    Degenerate
        If no cell is on, the axis is not finite, or the turned mask would take over 2**24 cells:
        those very far from square turn into endless ones.

    Notes
    -----
    Thesis 4.3.8, figures 4.30 and 4.31: positions less the centroid are turned and rounded to
    whole cells. Some cells are hit by two, so that up to about a sixth inside stay void; `close`
    with ``cross3`` fills them.
    """
    (x, y), (px, py) = mask.origin_cm, mask.pitch_cm
    pitch = px if px == py else math.sqrt(px * py)
    require_finite(axis)
    values, left, top = rotated(
        np.ascontiguousarray(mask.values),
        (axis.x_cm - x) / px - 0.5,
        (axis.y_cm - y) / py - 0.5,
        math.cos(axis.angle_rad),
        math.sin(axis.angle_rad),
        px / pitch,
        py / pitch,
    )
    if values.size == 0:
        if mask.values.any():
            raise Degenerate(f"turned, cells of {px:g} by {py:g} cm would be too many for a mask")
        raise Degenerate("no cell is on: nothing to turn")
    return Mask(
        values, (pitch, pitch), (axis.x_cm + (left - 0.5) * pitch, axis.y_cm + (top - 0.5) * pitch)
    )


Rotated = tuple[NDArray[np.bool_], int, int]


@compiled_later
def rotated(
    values: NDArray[np.bool_],
    column: float,
    row: float,
    cos: float,
    sin: float,
    width: float,
    height: float,
) -> Rotated:
    """Return the turned cells and the place of the first, in cells right and down of the centre.

    No cells where none is on, or where they would be more than `MOST_CELLS`.

    ``column`` and ``row`` are those of the centre, ``width`` and ``height`` the cells' over the
    turned cells' pitch.
    """
    rows, columns = values.shape
    first, last = rows, -1
    left, right, top, bottom = 1 << 60, -(1 << 60), 1 << 60, -(1 << 60)
    ends = np.empty((rows, 2), np.int64)
    for i in range(rows):
        low, high = columns, -1
        for j in range(columns):
            if values[i, j]:
                low = min(low, j)
                high = j
        ends[i, 0], ends[i, 1] = low, high
        if high < 0:
            continue
        first, last = min(first, i), i
        dy = (i - row) * height
        # A row's turned cells lie between those of its ends.
        for j in (low, high):
            dx = (j - column) * width
            u = math.floor((dx * cos - dy * sin) + 0.5)
            v = math.floor((dx * sin + dy * cos) + 0.5)
            left, right = min(left, u), max(right, u)
            top, bottom = min(top, v), max(bottom, v)
    # Of floats: the product of two whole numbers may be too large for one.
    if last < 0 or (bottom - top + 1.0) * (right - left + 1.0) > MOST_CELLS:
        return np.zeros((0, 0), np.bool_), 0, 0
    out = np.zeros((bottom - top + 1, right - left + 1), np.bool_)
    for i in range(first, last + 1):
        dy = (i - row) * height
        for j in range(ends[i, 0], ends[i, 1] + 1):
            if values[i, j]:
                dx = (j - column) * width
                u = math.floor((dx * cos - dy * sin) + 0.5)
                v = math.floor((dx * sin + dy * cos) + 0.5)
                out[v - top, u - left] = True
    return out, left, top
