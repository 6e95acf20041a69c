"""What share of each element along its rim an outline covers: exact, and of no other element."""

from __future__ import annotations

import math
from typing import TypeAlias

import numpy as np

from tactile_graph.compiled import compiled_as_is
from tactile_graph_likelihood.geometry.covered import SLIVER, Box
from tactile_graph_likelihood.geometry.outlines import Values
from tactile_graph_likelihood.large_pads.rims import Runs

Line: TypeAlias = tuple[float, float, float, float, float]

SHORT = 0.1  # radians of an arc up to which its angle is a sum of powers of its sine


@compiled_as_is
def rim_shares(
    numbers: Values, xy: Values, grid: Values, box: Box, runs: Runs, shares: Values
) -> None:
    """Write the share of each element of the rim that an outline covers, row by row.

    Parameters
    ----------
    numbers, xy
        The outline, as `rims.drawn_as` gives it.
    grid, box
        As in `covered.covered`.
    runs : ndarray of int64, shape (rows, 4)
        As `rims.runs_of` gives them, of this outline or one nearby.
    shares : ndarray, shape (N,)
        Written: 0 to 1, of each row's left part and then its right one.
    """
    if xy.shape[0] == 0:
        _round_areas(numbers, grid, box, runs, shares)
    else:
        _polygon_areas(xy, grid, box, runs, shares)
    whole = 1.0 / (grid[3] * grid[3])
    for k in range(shares.shape[0]):
        share = abs(shares[k]) * whole
        if share > 1.0 - SLIVER:
            shares[k] = 1.0
        else:
            shares[k] = share if share > SLIVER else 0.0


@compiled_as_is
def _round_areas(numbers: Values, grid: Values, box: Box, runs: Runs, areas: Values) -> None:
    """Write areas as `coverage_ellipse.ellipse_areas` has them."""
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
    """Write areas with their sign, as `coverage_polygon.polygon_areas` sums them."""
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
