"""How the share of an element that an outline covers grows with the outline's numbers, exactly.

A side that moves outwards by a hair adds the hair times its length within the element.
"""

from __future__ import annotations

import math

from tactile_graph.compiled import compiled_as_is
from tactile_graph_likelihood.geometry.covered import Box, covered_by
from tactile_graph_likelihood.geometry.outlines import (
    DISC,
    ELLIPSE,
    OVAL,
    RECTANGLE,
    Values,
    unknowns,
)
from tactile_graph_likelihood.geometry.oval import to_oval

Slopes = tuple[float, float, float, float, float]
"""Along each of an outline's numbers, 0 where it has fewer."""

LEAST_SLOPE = 1e-12
"""Of a side along an axis: what is less is divided by as if it were this."""


@compiled_as_is
def has_slopes(kind: int) -> bool:
    """Return whether `covered_with_slopes` knows an outline's kind."""
    return kind in (DISC, ELLIPSE, OVAL, RECTANGLE)


@compiled_as_is
def covered_with_slopes(kind: int, p: Values, grid: Values, box: Box, slopes: Values) -> Values:
    """Return `covered.covered` of an outline that has slopes, and add them, along each number.

    Parameters
    ----------
    kind, p, grid, box
        As in `covered.covered`.
    slopes : ndarray, shape (K, rows, columns)
        Added to.
    """
    share = covered_by(kind, 0, p, grid, grid[3], box)
    soft = grid[4]
    _add_slopes(kind, p, grid, grid[3], box, share, 1.0 - soft, slopes)
    if soft > 0.0:
        element = grid[3] + 2.0 * grid[5]
        wide = covered_by(kind, 0, p, grid, element, box)
        _add_slopes(kind, p, grid, element, box, wide, soft, slopes)
        share = (1.0 - soft) * share + soft * wide
    return share


@compiled_as_is
def _add_slopes(
    kind: int, p: Values, grid: Values, element: float, box: Box, share: Values, weight: float,
    slopes: Values,
) -> None:  # fmt: skip
    """Add the slopes of the shares of elements of a side, times a weight."""
    more = 0.5 * (element - grid[3])
    left, top = grid[0] + box[1] * grid[2] - more, grid[1] + box[0] * grid[2] - more
    scale, numbers, oval = weight / (element * element), unknowns(kind, 0), p
    if kind == ELLIPSE:
        oval = p.copy()
        to_oval(oval)
    for i in range(box[2]):
        for j in range(box[3]):
            if not 0.0 < share[i, j] < 1.0:
                continue
            x, y = left + j * grid[2] - p[0], top + i * grid[2] - p[1]
            if kind == DISC:
                found = _of_disc(p[2], x, y, element, share[i, j])
            elif kind == OVAL:
                found = _of_oval(p, x, y, element, share[i, j])
            elif kind == ELLIPSE:
                found = _of_ellipse(p, _of_oval(oval, x, y, element, share[i, j]))
            else:
                found = _of_rectangle(p, x, y, element)
            for k in range(numbers):
                slopes[k, i, j] += scale * found[k]


@compiled_as_is
def _of_disc(r: float, x: float, y: float, element: float, share: float) -> Slopes:
    """Return the slopes of the disc's area on an element whose corner is at (x, y) from the centre.

    By the lengths of the element's sides within the disc; the radius' by Euler's theorem, as the
    area is homogeneous in all lengths.
    """
    right, bottom = x + element, y + element
    at_left = _within(r, x, y, bottom)
    at_right = _within(r, right, y, bottom)
    at_top = _within(r, y, x, right)
    at_bottom = _within(r, bottom, x, right)
    rest = x * at_left - right * at_right + y * at_top - bottom * at_bottom
    wider = (2.0 * share * element * element + rest) / r
    return at_left - at_right, at_top - at_bottom, wider, 0.0, 0.0


@compiled_as_is
def _within(r: float, line: float, first: float, last: float) -> float:
    """Return the length of a line, so far off the centre, within the disc, from first to last."""
    half = math.sqrt(max(r * r - line * line, 0.0))
    return max(min(last, half) - max(first, -half), 0.0)


@compiled_as_is
def _of_oval(p: Values, x: float, y: float, element: float, share: float) -> Slopes:
    """Return the same of an oval.

    It is the unit disc under a symmetric matrix S that is linear in its three last numbers. Where S
    grows by D a point of the rim moves by ``D S^-1`` times its place, and by Gauss' theorem the
    area by what that field's divergence makes of it, less what leaves by the sides within.
    """
    right, bottom = x + element, y + element
    a, b, c = p[2] + p[3], -p[4], p[2] - p[3]
    det = a * c - b * b
    wide, high, tilt = a * a + b * b, b * b + c * c, b * (a + c)
    l0, l1 = _chord(wide, tilt, det, x, y, bottom)
    r0, r1 = _chord(wide, tilt, det, right, y, bottom)
    t0, t1 = _chord(high, tilt, det, y, x, right)
    b0, b1 = _chord(high, tilt, det, bottom, x, right)
    at_left, at_right, at_top, at_bottom = l1 - l0, r1 - r0, t1 - t0, b1 - b0
    area = share * element * element
    xx = area - right * at_right + x * at_left
    yy = area - bottom * at_bottom + y * at_top
    xy = 0.5 * ((l1 + l0) * at_left - (r1 + r0) * at_right)
    yx = 0.5 * ((t1 + t0) * at_top - (b1 + b0) * at_bottom)
    by_first, by_second = (c * xx - b * xy) / det, (a * yy - b * yx) / det
    across = (b * (xx + yy) - a * xy - c * yx) / det
    return (
        at_left - at_right,
        at_top - at_bottom,
        by_first + by_second,
        by_first - by_second,
        across,
    )


@compiled_as_is
def _of_ellipse(p: Values, of_oval: Slopes) -> Slopes:
    """Return slopes along half axes and angle, from those along the oval's numbers."""
    right, down, wider, along, across = of_oval
    cos, sin = math.cos(2.0 * p[4]), math.sin(2.0 * p[4])
    longer, turned = along * cos + across * sin, across * cos - along * sin
    return right, down, 0.5 * (wider + longer), 0.5 * (wider - longer), (p[2] - p[3]) * turned


@compiled_as_is
def _chord(
    wide: float, tilt: float, det: float, line: float, first: float, last: float
) -> tuple[float, float]:
    """Return where a line, so far off the centre, enters and leaves an oval between two places.

    ``wide`` is the squared half extent across the line; both are the same where it stays outside.
    """
    inside = wide - line * line
    if inside <= 0.0:
        return first, first
    middle, half = tilt * line / wide, abs(det) * math.sqrt(inside) / wide
    start, end = max(first, middle - half), min(last, middle + half)
    return start, max(end, start)


@compiled_as_is
def _of_rectangle(p: Values, x: float, y: float, element: float) -> Slopes:
    """Return the same of a rectangle: each side's length on the element, times how it moves."""
    cos, sin, half = math.cos(p[4]), math.sin(p[4]), 0.5 * element
    mid_x, mid_y = x + half, y + half
    reach = half * (abs(cos) + abs(sin))
    by_x = by_y = by_first = by_second = by_turn = 0.0
    for side in range(4):
        first_axis, way = side < 2, 1.0 - 2.0 * (side % 2)
        nx, ny = (cos, -sin) if first_axis else (-sin, -cos)
        far, along = (way * p[2], p[3]) if first_axis else (way * p[3], p[2])
        if abs(nx * mid_x + ny * mid_y - far) >= reach:
            continue
        tx, ty = (-sin, -cos) if first_axis else (cos, -sin)
        tx = math.copysign(max(abs(tx), LEAST_SLOPE), tx)
        ty = math.copysign(max(abs(ty), LEAST_SLOPE), ty)
        a, b = (mid_x - far * nx) / tx, (mid_y - far * ny) / ty
        wide, high = half / abs(tx), half / abs(ty)
        start, end = max(-along, a - wide, b - high), min(along, a + wide, b + high)
        length = max(end - start, 0.0)
        by_x += way * nx * length
        by_y += way * ny * length
        if first_axis:
            by_first += length
            by_turn -= 0.5 * way * (start + end) * length
        else:
            by_second += length
            by_turn += 0.5 * way * (start + end) * length
    return by_x, by_y, by_first, by_second, by_turn
