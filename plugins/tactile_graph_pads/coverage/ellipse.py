"""Exact area of an ellipse (or disc) on each element of a grid, in closed form.

The area of the ellipse below a horizontal line, within a vertical strip, has an elementary
primitive. Each row of elements has two lines and each column one strip, so a whole grid needs
only six arc tangents a row or column; an element's area is the difference of its two lines.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from tactile_graph.compiled import compiled_later, compiled_twin_of

Area = NDArray[np.float64]


def _reference(
    x_cm: float,
    y_cm: float,
    semi_major_cm: float,
    semi_minor_cm: float,
    angle_rad: float,
    pitch_cm: float,
    element_cm: float,
    rows: int,
    columns: int,
) -> Area:
    """Return the area of the ellipse on each element, in cm^2, shape (rows, columns).

    Parameters
    ----------
    x_cm, y_cm : float
        Centre of the ellipse; element (0, 0) has its top left corner in the origin.
    semi_major_cm, semi_minor_cm : float
        Half axes.
    angle_rad : float
        Direction of the first half axis, counter-clockwise as seen (y runs down).
    pitch_cm, element_cm : float
        Distance of the elements and their side.
    rows, columns : int
        Size of the grid.

    Notes
    -----
    With A the half width, the ellipse at x is ``m x -+ k sqrt(A^2 - x^2)``, and the primitive of
    the root is ``P(x) = (x sqrt(A^2 - x^2) + A^2 asin(x / A)) / 2``. Accurate to about 1e-15 of
    the square of the larger of axis and pad; elements clear of the ellipse get exactly 0.
    """
    a, b = semi_major_cm, semi_minor_cm
    if a <= 0.0 or b <= 0.0:
        return np.zeros((rows, columns))
    cos, sin = math.cos(angle_rad), -math.sin(angle_rad)
    A = math.hypot(a * cos, b * sin)
    B = math.hypot(a * sin, b * cos)
    m = (a - b) * (a + b) * cos * sin / A**2
    k = a * b / A**2

    def primitive(x: Area) -> Area:
        root = np.sqrt(np.maximum((A - x) * (A + x), 0.0))
        return np.asarray(0.5 * (x * root + A**2 * np.arctan2(x, root)))

    top = np.arange(rows) * pitch_cm - y_cm
    lines = np.stack([top, top + element_cm])[:, :, None]
    left = np.arange(columns) * pitch_cm - x_cm
    x0, x1 = np.clip(left, -A, A), np.clip(left + element_cm, -A, A)
    crossed = np.abs(lines) < B
    half = k * np.sqrt(np.where(crossed, (B - lines) * (B + lines), 0.0))
    start = np.where(crossed, np.clip((m * lines - half) * (A / B) ** 2, -A, A), A)
    end = np.where(crossed, np.clip((m * lines + half) * (A / B) ** 2, -A, A), A)
    left_below = np.where(crossed, lines > -m * A, lines > 0.0)
    right_below = crossed & (lines > m * A)
    c0, c1 = np.clip(x0, start, end), np.clip(x1, start, end)
    whole_left = primitive(np.minimum(x1, start)) - primitive(np.minimum(x0, start))
    whole_right = primitive(np.maximum(x1, end)) - primitive(np.maximum(x0, end))
    below = lines * (c1 - c0) - 0.5 * m * (c1 - c0) * (c1 + c0)
    below += k * (primitive(c1) - primitive(c0))
    below += 2.0 * k * (left_below * whole_left + right_below * whole_right)
    return np.asarray(np.clip(below[1] - below[0], 0.0, element_cm**2))


@compiled_later
def primitive(x: float, radius: float) -> float:
    """Return the area under a half circle from its middle to x, |x| <= radius."""
    root = math.sqrt((radius - x) * (radius + x))
    if abs(x) < root:
        angle = math.asin(x / radius)
    else:
        angle = math.copysign(0.5 * math.pi - math.asin(root / radius), x)
    return 0.5 * (x * root + radius * radius * angle)


class _Conic(NamedTuple):
    """An ellipse about the origin as the notes of `ellipse_areas` name it; B is its half height.

    ``stretch`` is (A / B)**2.
    """

    A: float
    B: float
    m: float
    k: float
    stretch: float


class _Strip(NamedTuple):
    """A vertical strip from x = u to v, and the primitive at both."""

    u: float
    v: float
    P0: float
    P1: float


@compiled_later
def _line(h: float, conic: _Conic, line: Area) -> None:
    """Write a horizontal line's height, half length, start, end and the primitive at both."""
    A, B, m, k, stretch = conic
    line[0], line[1], line[2], line[3] = h, 0.0, A, A
    if -B < h < B:
        half = k * math.sqrt((B - h) * (B + h))
        line[1] = half
        line[2] = min(max((m * h - half) * stretch, -A), A)
        line[3] = min(max((m * h + half) * stretch, -A), A)
        line[4], line[5] = primitive(line[2], A), primitive(line[3], A)


@compiled_later
def _below(line: Area, conic: _Conic, strip: _Strip) -> float:
    """Return the area of the ellipse below a line and within a strip."""
    A, B, m, k, _ = conic
    u, v, P0, P1 = strip
    h, s, e = line[0], line[2], line[3]
    if h <= -B:
        return 0.0
    if h >= B:
        return 2.0 * k * (P1 - P0)
    below = 0.0
    if u < s and h > -m * A:
        below += 2.0 * k * ((P1 if v < s else line[4]) - P0)
    if v > e and h > m * A:
        below += 2.0 * k * (P1 - (P0 if u > e else line[5]))
    if v > s and u < e:
        a, Pa = (u, P0) if u > s else (s, line[4])
        b, Pb = (v, P1) if v < e else (e, line[5])
        below += (b - a) * (h - 0.5 * m * (b + a)) + k * (Pb - Pa)
    return below


@compiled_twin_of(_reference)
def ellipse_areas(  # noqa: D103 - the pair's docstring is the reference's
    x_cm: float,
    y_cm: float,
    semi_major_cm: float,
    semi_minor_cm: float,
    angle_rad: float,
    pitch_cm: float,
    element_cm: float,
    rows: int,
    columns: int,
) -> Area:
    areas = np.zeros((rows, columns))
    a, b = semi_major_cm, semi_minor_cm
    if a <= 0.0 or b <= 0.0:
        return areas
    cos, sin = math.cos(angle_rad), -math.sin(angle_rad)
    A = math.sqrt(a * cos * (a * cos) + b * sin * (b * sin))
    B = math.sqrt(a * sin * (a * sin) + b * cos * (b * cos))
    m = (a - b) * (a + b) * cos * sin / (A * A)
    k = a * b / (A * A)
    stretch = A * A / (B * B)
    conic, full = _Conic(A, B, m, k, stretch), element_cm * element_cm
    first = max(math.floor(max((x_cm - A - element_cm) / pitch_cm, -1.0)) + 1, 0)
    last = min(math.ceil(min((x_cm + A) / pitch_cm, float(columns))), columns)
    strips = np.empty((4, columns))  # left, right, and the primitive there
    for c in range(first, last):
        left = c * pitch_cm - x_cm
        strips[0, c], strips[1, c] = min(max(left, -A), A), min(max(left + element_cm, -A), A)
        strips[2, c], strips[3, c] = primitive(strips[0, c], A), primitive(strips[1, c], A)
    low, high = np.empty(6), np.empty(6)  # a row's lines: height, half length, start, end, ...
    for r in range(rows):
        top = r * pitch_cm - y_cm
        if top + element_cm <= -B or top >= B:
            continue
        _line(top, conic, low)
        _line(top + element_cm, conic, high)
        # elements between both lines' ends are covered whole, the outline being convex
        inner = max(math.ceil((x_cm + max(low[2], high[2])) / pitch_cm), first)
        outer = math.floor((x_cm + min(low[3], high[3]) - element_cm) / pitch_cm) + 1
        outer = min(outer, last) if low[1] > 0.0 and high[1] > 0.0 else inner
        # no farther than the row's arcs reach, or the ellipse's own ends where the row has them
        left = -A if top < -m * A < top + element_cm else min(low[2], high[2])
        right = max(low[3] if low[1] > 0.0 else -A, high[3] if high[1] > 0.0 else -A)
        right = A if top < m * A < top + element_cm else right
        c = max(math.floor((x_cm + left - element_cm) / pitch_cm) + 1, first)
        end = min(math.ceil((x_cm + right) / pitch_cm), last)
        while c < end:
            if inner <= c < outer:
                areas[r, c:outer] = full
                c = outer
                continue
            strip = _Strip(strips[0, c], strips[1, c], strips[2, c], strips[3, c])
            area = _below(high, conic, strip) - _below(low, conic, strip)
            areas[r, c] = min(max(area, 0.0), full)
            c += 1
    return areas
