"""``hull_graham``: the convex hull of points by Graham's scan."""

from __future__ import annotations

from functools import cmp_to_key
from typing import Annotated

import numpy as np
from annotated_types import Ge
from numpy.typing import NDArray

from tactile_graph.compiled import compiled_later, compiled_twin_of
from tactile_graph.wires import Points, Polygon
from tactile_graph_hull.corners import finished, hull_polygon, in_range
from tactile_graph_hull.turn_of_points import turn


def hull_graham(points: Points, *, rounding_ulps: Annotated[float, Ge(0)] = 8.0) -> Polygon:
    """Return the smallest convex polygon around the points, by sorting them around a corner.

    Parameters
    ----------
    points : Points
        At least one; duplicates and points in a line are welcome.
    rounding_ulps : float
        As in `hull`.

    Returns
    -------
    Polygon
        The same corners in the same order as `hull` gives.

    Raises
    ------
    Degenerate
        If there are no points, or some are not finite.

    Notes
    -----
    The points are sorted by angle around the leftmost one instead of around an inner point as in
    thesis 3.1.4: an inner point is not representable exactly, a corner is, and no point can fall
    on it from all sides. O(N log N). Source: R. L. Graham 1972, 10.1016/0020-0190(72)90045-2.
    """
    return hull_polygon(points.xy_cm, graham_corners, rounding_ulps)


def _graham_corners(xy: NDArray[np.float64], ulps: float) -> NDArray[np.float64]:
    """Return the hull's corners, shape (K, 2); none if `turn` would not be exact."""
    if not in_range.reference(xy):
        return xy[:0]
    points: list[tuple[float, float]] = [(x, y) for x, y in (xy + 0.0).tolist()]
    pivot = min(points)

    def before(a: tuple[float, float], b: tuple[float, float]) -> int:
        return -turn.reference(pivot[0], pivot[1], a[0], a[1], b[0], b[1]) or (1 if a > b else -1)

    others = [p for p in points if p != pivot]
    kept = [pivot]
    for p in sorted(others, key=cmp_to_key(before)):
        while len(kept) > 1 and turn.reference(*kept[-2], *kept[-1], *p) <= 0:
            kept.pop()
        kept.append(p)
    return finished.reference(np.array(kept), ulps)


@compiled_twin_of(_graham_corners)
def graham_corners(xy: NDArray[np.float64], ulps: float) -> NDArray[np.float64]:
    """Do the same in loops."""
    if not in_range(xy):
        return np.empty((0, 2))
    n = xy.shape[0]
    pivot = 0
    for i in range(1, n):
        if _lower(xy, i, pivot):
            pivot = i
    order = _sorted_around(xy, pivot)
    kept = np.empty(n, dtype=np.int64)
    kept[0] = pivot
    size = 1
    for k in range(n):
        p = order[k]
        if xy[p, 0] == xy[pivot, 0] and xy[p, 1] == xy[pivot, 1]:
            continue
        while size > 1 and _turn_of(xy, kept[size - 2], kept[size - 1], p) <= 0:
            size -= 1
        kept[size] = p
        size += 1
    return finished(xy[kept[:size]] + 0.0, ulps)


@compiled_later
def _turn_of(xy: NDArray[np.float64], a: int, b: int, c: int) -> int:
    return turn(xy[a, 0], xy[a, 1], xy[b, 0], xy[b, 1], xy[c, 0], xy[c, 1])


@compiled_later
def _lower(xy: NDArray[np.float64], i: int, k: int) -> bool:
    """Return whether point i has the lower x, or at the same x the lower y."""
    return bool(xy[i, 0] < xy[k, 0] or (xy[i, 0] == xy[k, 0] and xy[i, 1] < xy[k, 1]))


@compiled_later
def _sorted_around(xy: NDArray[np.float64], pivot: int) -> NDArray[np.int64]:
    """Return the points' numbers counter-clockwise around the pivot, the nearer first."""
    n = xy.shape[0]
    order, merged = np.arange(n), np.empty(n, dtype=np.int64)
    width = 1
    while width < n:  # merge sort: it asks for the fewest exact turns, and is stable
        for low in range(0, n, 2 * width):
            middle, high = min(low + width, n), min(low + 2 * width, n)
            i, j = low, middle
            for k in range(low, high):
                take_first = j >= high
                if i < middle and j < high:
                    sense = _turn_of(xy, pivot, order[i], order[j])
                    take_first = sense > 0 or (sense == 0 and not _lower(xy, order[j], order[i]))
                if take_first:
                    merged[k] = order[i]
                    i += 1
                else:
                    merged[k] = order[j]
                    j += 1
        order, merged = merged, order
        width *= 2
    return order
