"""What all hulls share: from points to a finished ``Polygon``, whatever the algorithm between."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import TypeAlias

import numpy as np
from numpy.typing import NDArray

from tactile_graph.compiled import compiled_later
from tactile_graph.errors import Degenerate
from tactile_graph.wires import Polygon, quick_polygon
from tactile_graph_hull.turn_of_points import LARGEST, SMALLEST

Corners: TypeAlias = Callable[[NDArray[np.float64], float], NDArray[np.float64]]

DOUBLE = np.dtype(np.float64)
EPS = 2.0**-52


def hull_polygon(xy_cm: NDArray[np.float64], corners: Corners, rounding_ulps: float) -> Polygon:
    """Return the hull that ``corners`` finds.

    Parameters
    ----------
    xy_cm : ndarray of float64, shape (N, 2)
        The points.
    corners : callable
        ``corners(xy, ulps)`` gives the hull's corners, shape (K, 2), counter-clockwise as seen
        from the lowest (x, y) on; none at all where it cannot be exact (see `in_range`).
    rounding_ulps : float
        See `hull`.

    Raises
    ------
    Degenerate
        If there are no points, or some are not finite.
    """
    xy, flags = xy_cm, xy_cm.flags
    if xy.dtype is not DOUBLE or flags.writeable or not flags.c_contiguous:
        xy = as_points(np.ascontiguousarray(xy_cm, dtype=np.float64))
    if xy.ndim != 2:
        raise ValueError(f"points must be of shape (N, 2), got {xy.shape}")
    found = corners(xy, rounding_ulps)
    if len(found) == 0:
        found = _out_of_range(xy, corners, rounding_ulps)
    return quick_polygon(found)


def _out_of_range(
    xy: NDArray[np.float64], corners: Corners, rounding_ulps: float
) -> NDArray[np.float64]:
    """Return the corners of points of any size, by a power of two brought into range."""
    if len(xy) == 0:
        raise Degenerate("0 points: a hull needs at least one")
    bad = len(xy) - int(np.isfinite(xy).all(axis=1).sum())
    if bad:
        raise Degenerate(f"{bad} of {len(xy)} points are not finite: no hull")
    _, exponent = math.frexp(float(np.abs(xy).max()))
    shift = exponent - 479
    scaled = np.ldexp(xy, -shift)
    # Beside the largest coordinate these are 270 decimal places down: far below its rounding.
    scaled[np.abs(scaled) < SMALLEST] = 0.0
    return np.ldexp(corners(as_points(scaled), rounding_ulps), shift)


def as_points(xy: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return the array as `Points` hold it, read-only: others have the corners compiled anew."""
    if xy.flags.writeable:
        xy = xy.view()
        xy.setflags(write=False)
    return xy


@compiled_later
def in_range(xy: NDArray[np.float64]) -> bool:
    """Return whether there are points, all finite and of a size `turn` is exact for."""
    for i in range(xy.shape[0]):
        for k in range(2):
            size = abs(xy[i, k])
            if size != 0.0 and not SMALLEST <= size <= LARGEST:
                return False
    return bool(xy.shape[0] > 0)


@compiled_later
def finished(corners: NDArray[np.float64], ulps: float) -> NDArray[np.float64]:
    """Return an exact hull's corners without those that only rounding makes stick out.

    Corners further than ``ulps`` units in the last place of the largest coordinate from the
    line through the kept ones stay. Two corners far apart are kept in any case and the two
    chains between them are thinned on their own, so that the answer depends on the hull alone.
    """
    n = corners.shape[0]
    if n < 3 or ulps == 0.0:
        return corners
    largest = 0.0
    for i in range(n):
        largest = max(largest, abs(corners[i, 0]), abs(corners[i, 1]))
    limit = ulps * EPS * largest
    first = _farthest(corners, 0)
    second = _farthest(corners, first)
    kept = np.zeros(n, dtype=np.bool_)
    _thin(corners, first, second, limit, kept)
    _thin(corners, second, first, limit, kept)
    return _from_lowest(corners, kept)


@compiled_later
def _farthest(corners: NDArray[np.float64], start: int) -> int:
    """Return the corner farthest from ``start``."""
    best, largest = start, -1.0
    for i in range(corners.shape[0]):
        dx, dy = corners[i, 0] - corners[start, 0], corners[i, 1] - corners[start, 1]
        if dx * dx + dy * dy > largest:
            best, largest = i, dx * dx + dy * dy
    return best


@compiled_later
def _thin(
    corners: NDArray[np.float64], start: int, end: int, limit: float, kept: NDArray[np.bool_]
) -> None:
    """Mark the corners to keep from ``start`` (kept) to ``end`` (left to the other chain)."""
    n = corners.shape[0]
    last, widest = start, (start + 1) % n  # on a convex chain the widest only moves on
    kept[start] = True
    before, k = widest, (widest + 1) % n
    while before != end:
        x, y = corners[last, 0], corners[last, 1]
        dx, dy = corners[k, 0] - x, corners[k, 1] - y
        # Distance from the line last -> k, times the length of that line.
        distance = abs(dx * (corners[widest, 1] - y) - dy * (corners[widest, 0] - x))
        while widest != before:
            following = (widest + 1) % n
            further = abs(dx * (corners[following, 1] - y) - dy * (corners[following, 0] - x))
            if further < distance:
                break
            widest, distance = following, further
        if distance > limit * math.sqrt(dx * dx + dy * dy):
            last, widest = before, k
            kept[before] = True
        before, k = k, (k + 1) % n


@compiled_later
def _from_lowest(corners: NDArray[np.float64], kept: NDArray[np.bool_]) -> NDArray[np.float64]:
    """Return the kept corners, the one of the lowest x, then the lowest y, first."""
    n = corners.shape[0]
    lowest, count = -1, 0
    for i in range(n):
        if kept[i]:
            count += 1
            if (
                lowest < 0
                or corners[i, 0] < corners[lowest, 0]
                or (corners[i, 0] == corners[lowest, 0] and corners[i, 1] < corners[lowest, 1])
            ):
                lowest = i
    if count == n:
        return corners
    chosen = np.empty((count, 2))
    k = lowest
    for i in range(count):
        chosen[i, 0], chosen[i, 1] = corners[k, 0], corners[k, 1]
        k = (k + 1) % n
        while not kept[k]:
            k = (k + 1) % n
    return chosen
