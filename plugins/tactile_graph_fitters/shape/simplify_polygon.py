"""``simplify_polygon``: a polygon of few corners from one of many, such as a hull of cells."""

from __future__ import annotations

import math
from typing import Annotated, TypeAlias

import numpy as np
from annotated_types import Ge, Gt
from numpy.typing import NDArray

from tactile_graph.compiled import compiled_later
from tactile_graph.errors import Degenerate
from tactile_graph.wires import Polygon

Values: TypeAlias = NDArray[np.float64]
Indices: TypeAlias = NDArray[np.int64]

NEARER = 1e-5  # share of a triangle's size by which nearer corners go first
MIRRORED = 1e-3  # of that, between mirror images
BEYOND = 1.0 + 1e-9  # what is larger by less is as large
TOLD_APART = 2.0**36  # parts of a size; closer ones are equal but for rounding
PARALLEL = 0.17  # sine of the angle (10 degrees) below which two sides' lines are not crossed


class SimplifyPolygon:
    """Return a polygon of few corners that keeps close to one of many.

    Parameters
    ----------
    corners : int, optional
        How many corners to keep.
    tolerance_cm : float, optional
        Instead: corners go as long as each is no further from the line between its neighbours.
    refine : bool
        Whether each side then becomes the line of least squares through the part of the outline
        it stands for, with corners where neighbouring sides meet; otherwise the corners kept are
        some of those given.

    Raises
    ------
    ValueError
        Unless exactly one of ``corners`` and ``tolerance_cm`` is given.

    Notes
    -----
    The corner whose triangle with its neighbours is smallest goes first (Visvalingam and Whyatt
    1993, 10.1179/000870493786962263), which alone would make a convex polygon smaller; with
    ``refine`` it keeps its size. Sides that come out nearly parallel to their neighbours keep the
    given corner between them.
    """

    stateless = True

    def __init__(
        self,
        *,
        corners: Annotated[int | None, Ge(3)] = None,
        tolerance_cm: Annotated[float | None, Gt(0)] = None,
        refine: bool = True,
    ) -> None:
        if (corners is None) == (tolerance_cm is None):
            got = "neither" if corners is None else "both"
            raise ValueError(f"exactly one of corners and tolerance_cm must be given, got {got}")
        self._corners, self._tolerance, self._refine = corners, tolerance_cm, refine

    def __call__(self, polygon: Polygon) -> Polygon:
        """Return the simplified polygon.

        Raises
        ------
        Degenerate
            If the polygon has fewer corners than asked for (than 3, with ``tolerance_cm``), or one
            that is not finite.
        """
        xy = polygon.xy_cm
        least = self._corners or 3
        if len(xy) < least:
            raise Degenerate(
                f"the polygon has {len(xy)} corners, fewer than the {least} it is to keep"
            )
        xy = np.ascontiguousarray(xy, dtype=np.float64)
        if not np.isfinite(xy).all():
            raise Degenerate("a corner of the polygon is not finite")
        kept = np.arange(len(xy))
        tolerance = -1.0 if self._tolerance is None else self._tolerance
        kept = kept[: thinned(xy, kept, len(xy), least, tolerance)]
        return Polygon(met(xy, kept) if self._refine else xy[kept])


@compiled_later
def thinned(xy: Values, kept: Indices, count: int, least: int, tolerance_cm: float) -> int:
    """Take out of the first ``count`` of ``kept`` the corners that go; return how many are left.

    With a tolerance of 0 or more only corners no further than that from the line between their
    neighbours go. Outlines of cells are full of equal triangles: of these that of the corner
    nearest to the middle goes, not the first, which depends on how the pad is held. A tree of the
    smaller of every two triangles finds the next corner, so that the time grows with the corners as
    sorting them would.
    """
    leaves = 1
    while leaves < count:
        leaves *= 2
    tree = np.empty(2 * leaves)
    ring = np.empty((2, count), np.int64)  # the corner before and the one after; -1 once it is gone
    outer = _outer(xy, kept, count)
    for k in range(leaves):
        tree[leaves + k] = np.inf
    for k in range(count):
        ring[0, k], ring[1, k] = (k - 1 if k else count - 1), (k + 1) % count
    for k in range(count):
        tree[leaves + k] = _size(triangle(xy, kept, ring, k, tolerance_cm), outer[k])
    for node in range(leaves - 1, 0, -1):
        tree[node] = min(tree[2 * node], tree[2 * node + 1])
    left = count
    while left > least and tree[1] < np.inf:
        node = 1
        while node < leaves:  # of equal ones the first
            node = 2 * node if tree[2 * node] <= tree[2 * node + 1] else 2 * node + 1
        gone = node - leaves
        before, after = ring[0, gone], ring[1, gone]
        ring[1, before], ring[0, after], ring[0, gone] = after, before, -1
        left -= 1
        for turn in range(3):
            k = before if turn == 0 else after if turn == 1 else gone
            node = leaves + k
            tree[node] = np.inf
            if k != gone:
                tree[node] = _size(triangle(xy, kept, ring, k, tolerance_cm), outer[k])
            while node > 1:
                node //= 2
                tree[node] = min(tree[2 * node], tree[2 * node + 1])
    n = 0
    for k in range(count):
        if ring[0, k] >= 0:
            kept[n] = kept[k]
            n += 1
    return n


@compiled_later
def _outer(xy: Values, kept: Indices, count: int) -> Values:
    """Return how far out each kept corner lies, about 0 to 1, however the polygon is held.

    That is its distance from the mean of all corners, those kept being alike where the polygon is
    not. Between mirror images the furthest corner decides, then the one furthest to its side: of
    each the first, since others like it are mirror images themselves.
    """
    n = xy.shape[0]
    x = y = 0.0
    for k in range(n):
        x += xy[k, 0] / n
        y += xy[k, 1] / n
    reach, u, v = 0.0, 0.0, 0.0
    for k in range(n):
        dx, dy = xy[k, 0] - x, xy[k, 1] - y
        if math.hypot(dx, dy) > reach * BEYOND:
            reach, u, v = math.hypot(dx, dy), dx, dy
    out = np.zeros(count)
    if not 0.0 < reach < math.inf:
        return out
    u, v = u / reach, v / reach
    most, side = 0.0, 0.0
    for k in range(n):
        across = (xy[k, 1] - y) / reach * u - (xy[k, 0] - x) / reach * v
        if abs(across) > most * BEYOND + (BEYOND - 1.0):
            most, side = abs(across), math.copysign(1.0, across)
    for k in range(count):
        dx, dy = (xy[kept[k], 0] - x) / reach, (xy[kept[k], 1] - y) / reach
        along, across = dx * u + dy * v, side * (dy * u - dx * v)
        out[k] = math.hypot(dx, dy) + MIRRORED * (along + 0.5 * across)
    return out


@compiled_later
def _size(twice: float, outer: float) -> float:
    """Return a triangle's size, a little more for outer corners, equal ones to the last bit."""
    size = twice * (1.0 + NEARER * outer)
    if not 0.0 < size < math.inf:
        return twice
    part, power = math.frexp(size)
    return math.ldexp(math.floor(part * TOLD_APART + 0.5), power) / TOLD_APART


@compiled_later
def triangle(xy: Values, kept: Indices, ring: Indices, k: int, tolerance_cm: float) -> float:
    """Return twice the area of a corner's triangle with its neighbours; inf if it must not go."""
    a, b, c = kept[ring[0, k]], kept[k], kept[ring[1, k]]
    dx, dy = xy[c, 0] - xy[a, 0], xy[c, 1] - xy[a, 1]
    twice = abs(dx * (xy[b, 1] - xy[a, 1]) - dy * (xy[b, 0] - xy[a, 0]))
    if tolerance_cm >= 0.0:
        size = math.hypot(dx, dy)
        if size > 0.0 and twice / size > tolerance_cm:
            return math.inf
    return twice if twice < math.inf else math.inf  # a NaN, of corners beyond all numbers, stays


@compiled_later
def met(xy: Values, kept: Indices) -> Values:
    """Return where the lines through the outline's parts between kept corners meet."""
    n = kept.shape[0]
    lines = np.empty((n, 4))
    low, high = xy[0].copy(), xy[0].copy()
    for i in range(xy.shape[0]):
        for m in range(2):
            low[m], high[m] = min(low[m], xy[i, m]), max(high[m], xy[i, m])
    for k in range(n):
        line_through(xy, kept[k], kept[(k + 1) % n], lines[k])
    out = np.empty((n, 2))
    reach = 0.25 * max(high[0] - low[0], high[1] - low[1])
    for k in range(n):
        before = lines[k - 1 if k else n - 1]
        px, py, dx, dy = before[0], before[1], before[2], before[3]
        qx, qy, ex, ey = lines[k, 0], lines[k, 1], lines[k, 2], lines[k, 3]
        out[k, 0], out[k, 1] = xy[kept[k], 0], xy[kept[k], 1]
        cross = dx * ey - dy * ex
        if abs(cross) < PARALLEL:
            continue
        along = ((qx - px) * ey - (qy - py) * ex) / cross
        x, y = px + along * dx, py + along * dy
        if math.hypot(x - out[k, 0], y - out[k, 1]) <= reach:
            out[k, 0], out[k, 1] = x, y
    return out


@compiled_later
def line_through(xy: Values, start: int, end: int, line: Values) -> None:
    """Write a point of, and the direction of, the line nearest to the outline from start to end.

    Every point of the outline counts, not its corners: a side is its middle and, along itself, a
    twelfth of its square.
    """
    n = xy.shape[0]
    total = x = y = 0.0
    for k in range((end - start) % n):
        i, j = (start + k) % n, (start + k + 1) % n
        size = math.hypot(xy[j, 0] - xy[i, 0], xy[j, 1] - xy[i, 1])
        total += size
        x += 0.5 * size * (xy[i, 0] + xy[j, 0])
        y += 0.5 * size * (xy[i, 1] + xy[j, 1])
    x, y = x / total, y / total
    xx = xy_ = yy = 0.0
    for k in range((end - start) % n):
        i, j = (start + k) % n, (start + k + 1) % n
        dx, dy = xy[j, 0] - xy[i, 0], xy[j, 1] - xy[i, 1]
        size = math.hypot(dx, dy)
        u, v = 0.5 * (xy[i, 0] + xy[j, 0]) - x, 0.5 * (xy[i, 1] + xy[j, 1]) - y
        xx += size * (u * u + dx * dx / 12.0)
        xy_ += size * (u * v + dx * dy / 12.0)
        yy += size * (v * v + dy * dy / 12.0)
    angle = 0.5 * math.atan2(2.0 * xy_, xx - yy)
    line[0], line[1], line[2], line[3] = x, y, math.cos(angle), math.sin(angle)
