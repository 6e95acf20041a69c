"""Step ``contours``: the closed lines around an object's cells."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from tactile_graph.wires import Mask, Polygon

Corner = tuple[int, int]
Ways = dict[Corner, list[Corner]]
"""From each corner of a cell the steps (down, right) that lead on."""


def contours(mask: Mask) -> tuple[Polygon, ...]:
    """Return the closed contours of a mask along the borders of its cells.

    Parameters
    ----------
    mask : Mask
        Cells of objects; beyond the pad's rim nothing is.

    Returns
    -------
    tuple of Polygon
        Corners only. Outer contours run counter-clockwise as seen, those of holes clockwise;
        by their first corner in reading order. Cells that touch at a corner have contours of
        their own.
    """
    ways = _ways(mask.values)
    found: list[Polygon] = []
    for start in sorted(ways):
        while start in ways:  # twice where two cells touch there at their corners
            found.append(_polygon(_walked(ways, start), mask))
    return tuple(found)


def _walked(ways: Ways, start: Corner) -> list[Corner]:
    """Return the corners of the contour from a start, whose steps are taken out of the ways."""
    i, j = start
    heading, corners = (0, 0), []
    while True:
        here = ways[i, j]
        # Where two cells touch at a corner the way turns back around its own cell.
        step = max(here, key=lambda s: s[1] * heading[0] - s[0] * heading[1])
        here.remove(step)
        if not here:
            del ways[i, j]
        if step != heading:
            corners.append((i, j))
        heading = step
        i, j = i + step[0], j + step[1]
        if (i, j) == start:
            return corners


def _ways(on: NDArray[np.bool_]) -> Ways:
    """Return from each corner of a cell the steps (down, right) along borders, inside on the left.

    Down and right as drawn: with the inside on the left the outer contour runs counter-clockwise
    as seen.
    """
    p = np.pad(on, 1)
    ways: Ways = {}
    up = np.argwhere(p[1:, 1:-1] & ~p[:-1, 1:-1])  # the cell below the border is on: go left
    for i, j in up.tolist():
        ways.setdefault((i, j + 1), []).append((0, -1))
    for i, j in np.argwhere(p[:-1, 1:-1] & ~p[1:, 1:-1]).tolist():  # above: go right
        ways.setdefault((i, j), []).append((0, 1))
    for i, j in np.argwhere(p[1:-1, 1:] & ~p[1:-1, :-1]).tolist():  # right of it: go down
        ways.setdefault((i, j), []).append((1, 0))
    for i, j in np.argwhere(p[1:-1, :-1] & ~p[1:-1, 1:]).tolist():  # left of it: go up
        ways.setdefault((i + 1, j), []).append((-1, 0))
    return ways


def _polygon(corners: list[tuple[int, int]], mask: Mask) -> Polygon:
    row_column = np.array(corners, np.float64)
    return Polygon(np.asarray(mask.origin_cm) + row_column[:, ::-1] * np.asarray(mask.pitch_cm))
