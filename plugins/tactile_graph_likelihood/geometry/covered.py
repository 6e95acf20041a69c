"""How much of each element of a window an outline covers, exactly."""

from __future__ import annotations

import math

from tactile_graph.compiled import compiled_as_is
from tactile_graph_likelihood.geometry.disc_areas import disc_areas
from tactile_graph_likelihood.geometry.outlines import (
    DISC,
    ELLIPSE,
    OVAL,
    Values,
    bounds,
    corners_of,
)
from tactile_graph_likelihood.geometry.oval import as_ellipse
from tactile_graph_pads.coverage.ellipse import ellipse_areas
from tactile_graph_pads.coverage.polygon import polygon_areas

Box = tuple[int, int, int, int]
"""First row, first column, rows and columns of a window of elements."""

SLIVER = 1e-12  # of an element: rounding, not coverage


@compiled_as_is
def window(
    kind: int, corners: int, p: Values, grid: Values, rows: int, columns: int, margin: float
) -> Box:
    """Return the elements that an outline, widened by ``margin`` cm, may cover.

    Parameters
    ----------
    kind, corners, p : int, int, ndarray
        The outline, as in `outlines`.
    grid : ndarray, shape (4,)
        Left and top edge of the first element, pitch, side of an element; in cm.
    rows, columns : int
        Of the whole image.
    margin : float
        By how much the outline is widened, in cm.
    """
    left, top, right, bottom = bounds(kind, corners, p)
    pitch = grid[2]
    # Elements whose far edge lies beyond the near side, up to those whose near edge lies before
    # the far side. A reach far outside must not overflow a whole number.
    r0 = min(max((top - margin - grid[1] - grid[3]) / pitch, -1.0), float(rows))
    r1 = min(max((bottom + margin - grid[1]) / pitch, -1.0), rows - 1.0)
    c0 = min(max((left - margin - grid[0] - grid[3]) / pitch, -1.0), float(columns))
    c1 = min(max((right + margin - grid[0]) / pitch, -1.0), columns - 1.0)
    first_row, first_column = max(math.floor(r0) + 1, 0), max(math.floor(c0) + 1, 0)
    height, width = math.floor(r1) + 1 - first_row, math.floor(c1) + 1 - first_column
    return first_row, first_column, max(height, 0), max(width, 0)


@compiled_as_is
def covered(kind: int, corners: int, p: Values, grid: Values, box: Box) -> Values:
    """Return the share of each element of a window that an outline covers, 0 to 1.

    Parameters
    ----------
    kind, corners, p, grid
        As in `window`.
    box : tuple of int
        First row, first column, rows and columns.

    Returns
    -------
    ndarray, shape (rows, columns)
    """
    shares = covered_by(kind, corners, p, grid, grid[3], box)
    if grid[4] > 0.0:
        wide = covered_by(kind, corners, p, grid, grid[3] + 2.0 * grid[5], box)
        shares = (1.0 - grid[4]) * shares + grid[4] * wide
    return shares


@compiled_as_is
def covered_by(
    kind: int, corners: int, p: Values, grid: Values, element: float, box: Box
) -> Values:
    """Return the exact share of elements of a side, centred where the grid's own are."""
    r0, c0, rows, columns = box
    pitch, more = grid[2], 0.5 * (element - grid[3])
    left, top = grid[0] + c0 * pitch - more, grid[1] + r0 * pitch - more
    if kind == DISC:
        areas = disc_areas(p[0] - left, p[1] - top, p[2], pitch, element, rows, columns)
    elif kind in (ELLIPSE, OVAL):
        if kind == OVAL:
            p = as_ellipse(p)
        areas = ellipse_areas(
            p[0] - left, p[1] - top, p[2], p[3], p[4], pitch, element, rows, columns
        )
    else:
        xy = corners_of(kind, corners, p)
        for k in range(xy.shape[0]):
            xy[k, 0] -= left
            xy[k, 1] -= top
        areas = polygon_areas(xy, pitch, element, rows, columns)
    whole = 1.0 / (element * element)
    for i in range(rows):
        for j in range(columns):
            share = areas[i, j] * whole
            if share > 1.0 - SLIVER:
                areas[i, j] = 1.0
            else:
                areas[i, j] = share if share > SLIVER else 0.0
    return areas
