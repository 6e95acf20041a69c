"""``hull``: the convex hull of points by a monotone chain, the fast default."""

from __future__ import annotations

from typing import Annotated

import numpy as np
from annotated_types import Ge
from numpy.typing import NDArray

from tactile_graph.compiled import compiled_later, compiled_twin_of
from tactile_graph.steps import Linked
from tactile_graph.wires import Points, Polygon
from tactile_graph.wires.parts import PointsParts, PolygonParts, polygon_of
from tactile_graph.wires.stacks import Answered, PointsStack, PolygonStack
from tactile_graph_hull.corners import finished, hull_polygon, in_range
from tactile_graph_hull.turn_of_points import turn


def hull(points: Points, *, rounding_ulps: Annotated[float, Ge(0)] = 8.0) -> Polygon:
    """Return the smallest convex polygon around the points.

    Parameters
    ----------
    points : Points
        At least one; duplicates and points in a line are welcome.
    rounding_ulps : float
        Corners that stick out by no more than so many units in the last place of the largest
        coordinate are taken for rounding and left out: cells in a slanting line are in one line
        although their positions in cm are rounded. 0 keeps every corner of the exact hull.

    Returns
    -------
    Polygon
        The corners, counter-clockwise as seen from the lowest x (of these the lowest y) on, none
        twice and none between its neighbours. All points equal: 1 corner; all in one line: 2.

    Raises
    ------
    Degenerate
        If there are no points, or some are not finite.

    Notes
    -----
    `hull_graham`, `hull_beneath_beyond` and `hull_qhull` give the same corners, bit by bit: all
    decide with exact arithmetic. Time is O(N) where the points come sorted by x, as
    `boundary_scan` gives them, else O(N log N). Source: A. M. Andrew 1979,
    10.1016/0020-0190(79)90072-3; thesis 3.1.4.
    """
    return hull_polygon(points.xy_cm, chain_corners.direct, float(rounding_ulps))


def hull_stacked(points: PointsStack, *, rounding_ulps: float) -> Answered:
    """Return the hulls of several frames' points; those without, or out of range, are not done."""
    xy, starts = np.empty(points.xy_cm.shape), np.empty(len(points.starts), np.int64)
    corners_each.call(points.xy_cm, points.starts, rounding_ulps, xy, starts)
    return Answered(PolygonStack(xy[: starts[-1]], starts), np.diff(starts) > 0)


def hull_linked(*, rounding_ulps: float) -> Linked:
    """Return the form for points as machine code hands them on."""
    return Linked(corners_of_parts, PolygonParts, polygon_of, (float(rounding_ulps),))


hull.stacked = hull_stacked  # type: ignore[attr-defined]
hull.linked = hull_linked  # type: ignore[attr-defined]


def _chain_corners(xy: NDArray[np.float64], ulps: float) -> NDArray[np.float64]:
    """Return the hull's corners, shape (K, 2); none if `turn` would not be exact."""
    sizes = np.abs(xy)
    if len(xy) == 0 or not (sizes <= 2.0**480).all() or (sizes[sizes > 0] < 2.0**-430).any():
        return xy[:0]
    ordered = xy[np.lexsort((xy[:, 1], xy[:, 0]))] + 0.0
    new_x = np.flatnonzero(np.diff(ordered[:, 0], prepend=-np.inf))
    top = ordered[new_x].tolist()  # as seen: y runs down, so the first of an x is its uppermost
    bottom = ordered[np.append(new_x[1:], len(ordered)) - 1].tolist()
    corners: list[list[float]] = []
    for chain in (bottom, top[::-1]):
        kept: list[list[float]] = []
        for p in chain:
            while len(kept) > 1 and turn.reference(*kept[-2], *kept[-1], *p) <= 0:
                kept.pop()
            kept.append(p)
        corners += kept[1:] if corners and corners[-1] == kept[0] else kept
    if len(corners) > 1 and corners[-1] == corners[0]:
        corners.pop()
    start = min(range(len(corners)), key=lambda k: corners[k])
    return finished.reference(np.array(corners[start:] + corners[:start]), ulps)


@compiled_twin_of(_chain_corners)
def chain_corners(xy: NDArray[np.float64], ulps: float) -> NDArray[np.float64]:
    """Do the same in loops, without sorting what is sorted."""
    if not in_range(xy):
        return np.empty((0, 2))
    n = xy.shape[0]
    ends = np.empty((n, 3))  # x, its least y, its greatest y
    m = _columns(xy, ends)
    chain = np.empty((2 * m + 1, 2))
    chain[0, 0], chain[0, 1] = ends[0, 0], ends[0, 1]
    size = 1 if ends[0, 2] > ends[0, 1] else 0  # the upper left corner starts, if there are two
    size = _add_chain(ends, 0, m, 2, chain, size)
    if ends[m - 1, 2] == ends[m - 1, 1]:
        size -= 1  # the last corner below is the first one above
    size = _add_chain(ends, m - 1, -1, 1, chain, size)
    if size > 1:
        size -= 1  # back at the start
    return finished(chain[:size], ulps)


@compiled_later
def corners_of_parts(points: PointsParts, ulps: float) -> tuple[bool, PolygonParts]:
    """Do the same to the parts of points; not where there are no corners."""
    corners = chain_corners(points.xy_cm, ulps)
    return corners.shape[0] > 0, PolygonParts(PointsParts(corners))


@compiled_later
def _columns(xy: NDArray[np.float64], ends: NDArray[np.float64]) -> int:
    """Write each x with its least and greatest y, by rising x; return how many there are."""
    n = xy.shape[0]
    ordered = True
    for i in range(1, n):
        ordered &= xy[i, 0] >= xy[i - 1, 0]
    order = np.empty(0, dtype=np.int64) if ordered else np.argsort(xy[:, 0])
    m = 0
    for i in range(n):
        k = i if ordered else order[i]
        x, y = xy[k, 0] + 0.0, xy[k, 1] + 0.0  # + 0.0 turns -0.0 into 0.0
        if m > 0 and ends[m - 1, 0] == x:
            ends[m - 1, 1] = min(ends[m - 1, 1], y)
            ends[m - 1, 2] = max(ends[m - 1, 2], y)
        else:
            ends[m, 0], ends[m, 1], ends[m, 2] = x, y, y
            m += 1
    return m


@compiled_later
def _add_chain(
    ends: NDArray[np.float64],
    start: int,
    stop: int,
    side: int,
    chain: NDArray[np.float64],
    size: int,
) -> int:
    """Add one side's corners behind the first ``size`` of ``chain``; return the new size."""
    first = size
    for i in range(start, stop, 1 if stop > start else -1):
        x, y = ends[i, 0], ends[i, side]
        while size - first > 1 and (
            turn(
                chain[size - 2, 0],
                chain[size - 2, 1],
                chain[size - 1, 0],
                chain[size - 1, 1],
                x,
                y,
            )
            <= 0
        ):
            size -= 1
        chain[size, 0], chain[size, 1] = x, y
        size += 1
    return size


@compiled_later
def corners_each(xy, starts, ulps, out, out_starts):  # type: ignore[no-untyped-def]
    """Write the corners of several frames' hulls one behind the other, and where each starts."""
    n = 0
    out_starts[0] = 0
    for k in range(starts.shape[0] - 1):
        corners = chain_corners(xy[starts[k] : starts[k + 1]], ulps)
        for i in range(corners.shape[0]):
            out[n, 0], out[n, 1] = corners[i, 0], corners[i, 1]
            n += 1
        out_starts[k + 1] = n
