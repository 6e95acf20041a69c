"""``hull_beneath_beyond``: the convex hull by adding points one by one, as the thesis' program."""

from __future__ import annotations

from typing import Annotated, NamedTuple

import numpy as np
from annotated_types import Ge
from numpy.typing import NDArray

from tactile_graph.compiled import compiled_later
from tactile_graph.wires import Points, Polygon
from tactile_graph_hull.corners import finished, hull_polygon, in_range
from tactile_graph_hull.turn_of_points import turn

Whole = NDArray[np.int64]


class _Ring(NamedTuple):
    """A hull that grows: a ring of points, and for each of its edges the points beyond it.

    An edge bears the number of the point it starts at. ``after`` and ``before`` lead from corner
    to corner; ``edge_of`` is the edge a point is beyond, ``first_of`` an edge's first such point
    and ``next_of`` the one behind a point; -1 for none.
    """

    xy: NDArray[np.float64]
    after: Whole
    before: Whole
    edge_of: Whole
    first_of: Whole
    next_of: Whole


def hull_beneath_beyond(points: Points, *, rounding_ulps: Annotated[float, Ge(0)] = 8.0) -> Polygon:
    """Return the smallest convex polygon around the points, grown by one point at a time.

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
    Points are taken in a shuffled order (the same one in every run). One that is beyond some
    edges replaces them by the two sides of its supporting cone; one beneath all edges is dropped.
    Each point not yet taken is kept with one edge it is beyond, as in Barber, Dobkin and
    Huhdanpaa, so that no point is tried against the whole hull: O(N log N) expected. Source:
    thesis appendix C; Preparata and Shamos 1985; Barber et al. 1996, 10.1145/235815.235821.
    """
    return hull_polygon(points.xy_cm, beneath_beyond_corners, rounding_ulps)


@compiled_later
def beneath_beyond_corners(xy: NDArray[np.float64], ulps: float) -> NDArray[np.float64]:
    """Return the hull's corners, shape (K, 2); none if `turn` would not be exact."""
    if not in_range(xy):
        return np.empty((0, 2))
    n = xy.shape[0]
    low, high = 0, 0
    for i in range(1, n):
        if xy[i, 0] < xy[low, 0] or (xy[i, 0] == xy[low, 0] and xy[i, 1] < xy[low, 1]):
            low = i
        if xy[i, 0] > xy[high, 0] or (xy[i, 0] == xy[high, 0] and xy[i, 1] > xy[high, 1]):
            high = i
    if xy[low, 0] == xy[high, 0] and xy[low, 1] == xy[high, 1]:
        return xy[low : low + 1] + 0.0
    after, before = np.full(n, -1), np.full(n, -1)
    after[low], before[low], after[high], before[high] = high, high, low, low
    edge_of, first_of, next_of = np.full(n, -1), np.full(n, -1), np.full(n, -1)
    hull = _Ring(xy, after, before, edge_of, first_of, next_of)
    order = _shuffled(n)
    for p in order:
        _give(hull, p, low, high)
    for p in order:
        if edge_of[p] >= 0:
            _add(hull, p)
    size = 1
    corner = after[low]
    while corner != low:
        size += 1
        corner = after[corner]
    ring = np.empty((size, 2))
    for k in range(size):
        ring[k, 0], ring[k, 1] = xy[corner, 0] + 0.0, xy[corner, 1] + 0.0
        corner = after[corner]
    return finished(ring, ulps)


@compiled_later
def _shuffled(n: int) -> NDArray[np.int64]:
    """Return 0 .. n - 1 in an order as good as random, always the same (Park-Miller numbers)."""
    order = np.arange(n)
    state = 20011
    for i in range(n - 1, 0, -1):
        state = state * 48271 % 2147483647
        k = state % (i + 1)
        order[i], order[k] = order[k], order[i]
    return order


@compiled_later
def _sense(xy: NDArray[np.float64], edge: int, end: int, p: int) -> int:
    """Return -1 if p is beyond the edge, 1 if beneath it, 0 if on its line."""
    return turn(xy[edge, 0], xy[edge, 1], xy[end, 0], xy[end, 1], xy[p, 0], xy[p, 1])


@compiled_later
def _give(hull: _Ring, p: int, one: int, other: int) -> None:
    """Put p on the list of the edge it is beyond; beneath both it is inside for good."""
    hull.edge_of[p] = -1
    for edge in (one, other):
        if _sense(hull.xy, edge, hull.after[edge], p) < 0:
            hull.edge_of[p] = edge
            hull.next_of[p] = hull.first_of[edge]
            hull.first_of[edge] = p
            return


@compiled_later
def _add(hull: _Ring, p: int) -> None:
    """Replace the edges p is beyond by the two sides of its supporting cone."""
    xy, after, before = hull.xy, hull.after, hull.before
    edge_of, first_of, next_of = hull.edge_of, hull.first_of, hull.next_of
    start, end = edge_of[p], after[edge_of[p]]
    # An edge on whose line p lies goes too: what was its corner is then between its neighbours.
    while _sense(xy, before[start], start, p) <= 0:
        start = before[start]
    while _sense(xy, end, after[end], p) <= 0:
        end = after[end]
    waiting = -1  # the points of the edges that go, in one list
    edge = start
    while edge != end:
        q = first_of[edge]
        first_of[edge] = -1
        while q >= 0:
            following = next_of[q]
            next_of[q] = waiting
            waiting = q
            q = following
        edge = after[edge]
    after[start], before[p], after[p], before[end] = p, start, end, p
    while waiting >= 0:
        following = next_of[waiting]
        if waiting != p:
            _give(hull, waiting, start, p)
        waiting = following
    edge_of[p] = -1
