"""Where an outline's rim runs through a grid, row by row, and what it covers there.

On a large pad most of what an outline covers it covers whole. A convex outline covers one run of
each row whole, and touches one that is a little longer: only the elements between the two ends
need geometry.
"""

from __future__ import annotations

import math
from typing import NamedTuple, TypeAlias

import numpy as np
from numpy.typing import NDArray

from tactile_graph.compiled import compiled_as_is
from tactile_graph_likelihood.geometry.covered import SLIVER, Box
from tactile_graph_likelihood.geometry.lengths import length
from tactile_graph_likelihood.geometry.outlines import DISC, ELLIPSE, OVAL, Values, corners_of
from tactile_graph_likelihood.geometry.oval import as_ellipse

Line: TypeAlias = tuple[float, float, float, float, float]
Runs: TypeAlias = NDArray[np.int64]
"""Of each row: first column touched, first covered whole, one past those, one past the touched."""

ROUNDING = 1e-9  # pitches by which runs are looked at too short, and the rim too wide
ROUND_NUMBERS = 7
SHORT = 0.1  # radians of an arc up to which its angle is a sum of powers of its sine


class Drawn(NamedTuple):
    """What a convex outline's chords follow from.

    Of a round one ``numbers``: centre x and y, half width, half height, slant, root and stretch,
    shape (7,), as in `coverage.ellipse`; of any other its corners ``xy``, shape (N, 2). The other
    is empty.
    """

    numbers: Values
    xy: Values


@compiled_as_is
def drawn_as(kind: int, corners: int, p: Values) -> Drawn:
    """Return what an outline's chords follow from."""
    if kind not in (DISC, ELLIPSE, OVAL):
        return Drawn(np.empty(0), corners_of(kind, corners, p))
    if kind == OVAL:
        p = as_ellipse(p)
    out = np.empty(ROUND_NUMBERS)
    out[0], out[1] = p[0], p[1]
    if kind == DISC:
        out[2] = out[3] = p[2]
        out[4], out[5], out[6] = 0.0, 1.0, 1.0
    else:
        cos, sin = math.cos(p[4]), -math.sin(p[4])
        wide, high = length(p[2] * cos, p[3] * sin), length(p[2] * sin, p[3] * cos)
        out[2], out[3] = wide, high
        out[4] = (p[2] - p[3]) * (p[2] + p[3]) * cos * sin / (wide * wide)
        out[5] = p[2] * p[3] / (wide * wide)
        out[6] = (wide / high) * (wide / high)
    return Drawn(out, np.empty((0, 2)))


@compiled_as_is
def _reach_of_round(
    numbers: Values, top: float, bottom: float
) -> tuple[float, float, float, float]:
    """Return how far a round outline reaches between two heights, and how far it does all over."""
    x, y, wide, high = numbers[0], numbers[1], numbers[2], numbers[3]
    slant, root, stretch = numbers[4], numbers[5], numbers[6]
    h0, h1 = max(top - y, -high), min(bottom - y, high)
    if h0 >= h1:
        return math.inf, -math.inf, math.inf, -math.inf
    half0 = root * math.sqrt(max((high - h0) * (high + h0), 0.0))
    half1 = root * math.sqrt(max((high - h1) * (high + h1), 0.0))
    left0, left1 = (slant * h0 - half0) * stretch, (slant * h1 - half1) * stretch
    right0, right1 = (slant * h0 + half0) * stretch, (slant * h1 + half1) * stretch
    at = slant * wide
    left = -wide if h0 < -at < h1 else min(left0, left1)
    right = wide if h0 < at < h1 else max(right0, right1)
    if top - y <= -high or bottom - y >= high:
        return x + left, x + right, math.inf, -math.inf
    return x + left, x + right, x + max(left0, left1), x + min(right0, right1)


@compiled_as_is
def _reach_of_polygon(xy: Values, top: float, bottom: float) -> tuple[float, float, float, float]:
    """Return the same for a convex polygon."""
    n = xy.shape[0]
    left0 = left1 = left = math.inf
    right0 = right1 = right = -math.inf
    for i in range(n):
        j = i + 1 if i + 1 < n else 0
        xa, ya, xb, yb = xy[i, 0], xy[i, 1], xy[j, 0], xy[j, 1]
        if top <= ya <= bottom:
            left, right = min(left, xa), max(right, xa)
        if ya == yb:
            continue
        low, high = min(ya, yb), max(ya, yb)
        slope = (xb - xa) / (yb - ya)
        if low <= top <= high:
            x = xa + (top - ya) * slope
            left0, right0 = min(left0, x), max(right0, x)
        if low <= bottom <= high:
            x = xa + (bottom - ya) * slope
            left1, right1 = min(left1, x), max(right1, x)
    left, right = min(left, left0, left1), max(right, right0, right1)
    if left0 > right0 or left1 > right1:
        return left, right, math.inf, -math.inf
    return left, right, max(left0, left1), min(right0, right1)


@compiled_as_is
def runs_of(drawn: Drawn, grid: Values, box: Box, slack: float) -> Runs:
    """Return which elements of a window's rows an outline touches, and which it covers whole.

    Parameters
    ----------
    drawn : Drawn
    grid, box
        As in `covered.covered`.
    slack : float
        In cm: the runs hold for any outline whose edge lies within so much of this one's.

    Returns
    -------
    ndarray of int64, shape (rows, 4)
        Columns of the image: first touched, first covered whole, one past those, one past the
        touched.
    """
    row, column, rows, columns = box
    pitch, side, left = grid[2], grid[3], grid[0]
    slack += ROUNDING * pitch
    runs = np.empty((rows, 4), np.int64)
    end = column + columns
    for i in range(rows):
        top = grid[1] + (row + i) * pitch
        if drawn.xy.shape[0] == 0:
            reach = _reach_of_round(drawn.numbers, top - slack, top + side + slack)
        else:
            reach = _reach_of_polygon(drawn.xy, top - slack, top + side + slack)
        first = last = a = b = column
        if reach[0] <= reach[1]:
            from_left = (reach[0] - slack - side - left) / pitch
            to_right = (reach[1] + slack - left) / pitch
            first = math.floor(min(max(from_left, column - 1.0), end)) + 1
            last = math.ceil(max(min(to_right, float(end)), float(column)))
            last = max(first, last)
        if reach[2] <= reach[3]:
            from_left = (reach[2] + slack - left) / pitch
            to_right = (reach[3] - slack - side - left) / pitch
            a = math.ceil(max(min(from_left, float(end)), float(column)))
            b = math.floor(min(max(to_right, column - 1.0), end - 1.0)) + 1
        a = min(max(a, first), last)
        b = min(max(b, a), last)
        runs[i, 0], runs[i, 1], runs[i, 2], runs[i, 3] = first, a, b, last
    return runs


@compiled_as_is
def rim_count(runs: Runs) -> int:
    """Return how many elements are touched but not in the middle of their row."""
    count = 0
    for i in range(runs.shape[0]):
        count += runs[i, 1] - runs[i, 0] + runs[i, 3] - runs[i, 2]
    return count


@compiled_as_is
def rim_shares(drawn: Drawn, grid: Values, box: Box, runs: Runs, shares: Values) -> None:
    """Write the share of each element of the rim that an outline covers, row by row.

    Parameters
    ----------
    drawn : Drawn
    grid, box
        As in `covered.covered`.
    runs : ndarray of int64, shape (rows, 4)
        As `runs_of` gives them, of this outline or one nearby.
    shares : ndarray, shape (N,)
        Written: 0 to 1, of each row's left part and then its right one.
    """
    if drawn.xy.shape[0] == 0:
        _round_areas(drawn.numbers, grid, box, runs, shares)
    else:
        _polygon_areas(drawn.xy, grid, box, runs, shares)
    whole = 1.0 / (grid[3] * grid[3])
    for k in range(shares.shape[0]):
        share = abs(shares[k]) * whole
        if share > 1.0 - SLIVER:
            shares[k] = 1.0
        else:
            shares[k] = share if share > SLIVER else 0.0


@compiled_as_is
def _round_areas(numbers: Values, grid: Values, box: Box, runs: Runs, areas: Values) -> None:
    """Write areas as `ellipse_areas` has them."""
    wide, high = numbers[2], numbers[3]
    pitch, side = grid[2], grid[3]
    left, top = grid[0] + box[1] * pitch - numbers[0], grid[1] + box[0] * pitch - numbers[1]
    strips = np.empty((box[3], 4))
    for c in range(box[3]):
        a = min(max(left + c * pitch, -wide), wide)
        b = min(max(left + c * pitch + side, -wide), wide)
        strips[c, 0], strips[c, 1] = a, b
        strips[c, 2], strips[c, 3] = _height(a, wide), _height(b, wide)
    face = wide, high, numbers[4], 2.0 * numbers[5], 1.0 / (wide * wide)
    at, whole = 0, side * side
    for i in range(box[2]):
        if runs[i, 0] == runs[i, 3]:
            continue
        height = top + i * pitch
        low, up = _line(numbers, height), _line(numbers, height + side)
        for part in range(2):
            for column in range(runs[i, 2 * part], runs[i, 2 * part + 1]):
                c = column - box[1]
                strip = strips[c, 0], strips[c, 1], strips[c, 2], strips[c, 3]
                area = 0.0
                if strip[0] < strip[1] and height < high and height + side > -high:
                    area = _below(face, up, strip) - _below(face, low, strip)
                areas[at] = min(max(area, 0.0), whole)
                at += 1


@compiled_as_is
def _height(x: float, radius: float) -> float:
    """Return the height of a half circle at x."""
    return math.sqrt(max((radius - x) * (radius + x), 0.0))


@compiled_as_is
def _arc(a: float, at_a: float, b: float, at_b: float, squared: float, inverse: float) -> float:
    """Return half the area under a half circle between a and b, where its heights are given."""
    sine = (b * at_a - a * at_b) * inverse
    if abs(sine) < SHORT and a * b + at_a * at_b > 0.0:
        s = sine * sine
        # arc sine's series: the next term is 1e-14 of it
        more = s * (105.0 / 3456.0 + s * (945.0 / 42240.0 + s * (10395.0 / 599040.0)))
        angle = sine * (1.0 + s * (1.0 / 6.0 + s * (3.0 / 40.0 + s * (15.0 / 336.0 + more))))
    else:
        angle = math.atan2(b * at_a - a * at_b, a * b + at_a * at_b)
    return 0.25 * (b * at_b - a * at_a + squared * angle)


@compiled_as_is
def _line(numbers: Values, h: float) -> Line:
    """Return a horizontal line's height, start and end, and the half circle's height at both."""
    wide, high, slant, stretch = numbers[2], numbers[3], numbers[4], numbers[6]
    if not -high < h < high:
        return h, wide, wide, 0.0, 0.0
    half = numbers[5] * math.sqrt((high - h) * (high + h))
    start = min(max((slant * h - half) * stretch, -wide), wide)
    end = min(max((slant * h + half) * stretch, -wide), wide)
    at_end = _height(end, wide)
    return h, start, end, at_end if slant == 0.0 else _height(start, wide), at_end


@compiled_as_is
def _below(face: Line, line: Line, strip: tuple[float, float, float, float]) -> float:
    """Return the area of the outline below a line, within a strip."""
    wide, high, slant, double, inverse = face
    h, start, end, at_start, at_end = line
    u, v, at_u, at_v = strip
    squared = wide * wide
    if h <= -high:
        return 0.0
    if h >= high:
        return 2.0 * double * _arc(u, at_u, v, at_v, squared, inverse)
    below = 0.0
    if u < start and h > -slant * wide:
        b, at_b = (v, at_v) if v < start else (start, at_start)
        below += 2.0 * double * _arc(u, at_u, b, at_b, squared, inverse)
    if v > end and h > slant * wide:
        a, at_a = (u, at_u) if u > end else (end, at_end)
        below += 2.0 * double * _arc(a, at_a, v, at_v, squared, inverse)
    if v > start and u < end:
        a, at_a = (u, at_u) if u > start else (start, at_start)
        b, at_b = (v, at_v) if v < end else (end, at_end)
        below += (b - a) * (h - 0.5 * slant * (b + a))
        below += double * _arc(a, at_a, b, at_b, squared, inverse)
    return below


@compiled_as_is
def _polygon_areas(xy: Values, grid: Values, box: Box, runs: Runs, areas: Values) -> None:
    """Write areas with their sign, as `polygon_areas` sums them."""
    pitch, side = grid[2], grid[3]
    at = 0
    for i in range(box[2]):
        top = grid[1] + (box[0] + i) * pitch
        for part in range(2):
            for column in range(runs[i, 2 * part], runs[i, 2 * part + 1]):
                left = grid[0] + column * pitch
                areas[at] = _polygon_area(xy, left, top, side)
                at += 1


@compiled_as_is
def _polygon_area(xy: Values, left: float, top: float, side: float) -> float:
    """Return the area of a polygon on one element, by edge integrals."""
    n, area = xy.shape[0], 0.0
    for i in range(n):
        j = i + 1 if i + 1 < n else 0
        xa, xb = xy[i, 0] - left, xy[j, 0] - left
        u, v = max(min(xa, xb), 0.0), min(max(xa, xb), side)
        if v <= u:
            continue
        ya, yb = xy[i, 1] - top, xy[j, 1] - top
        if ya <= 0.0 and yb <= 0.0:
            continue
        width = v - u if xb > xa else u - v
        slope = (yb - ya) / (xb - xa)
        yu, yv = ya + (u - xa) * slope, ya + (v - xa) * slope
        low, high = min(yu, yv), max(yu, yv)
        if high <= 0.0:
            continue
        if low >= side:
            area += width * side
        elif low >= 0.0 and high <= side:
            area += width * 0.5 * (low + high)
        else:
            c0, c1 = max(low, 0.0), min(high, side)
            total = 0.5 * (c1 - c0) * (c1 + c0) + max(high - side, 0.0) * side
            area += width * total / (high - low)
    return area
