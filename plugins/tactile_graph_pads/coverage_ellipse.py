"""Exact area of an ellipse (or disc) on each element of a grid, in closed form.

The area of the ellipse below a horizontal line, within a vertical strip, has an elementary
primitive. Each row of elements has two lines and each column one strip, so a whole grid needs
only six arc tangents a row or column; an element's area is the difference of its two lines.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from tactile_graph.compiled import compiled_twin_of

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
    A = math.hypot(a * cos, b * sin)
    B = math.hypot(a * sin, b * cos)
    m = (a - b) * (a + b) * cos * sin / A**2
    k = a * b / A**2
    stretch = (A / B) ** 2
    x0, x1 = np.empty(columns), np.empty(columns)
    P0, P1 = np.empty(columns), np.empty(columns)
    first, last = columns, 0
    for c in range(columns):
        left = c * pitch_cm - x_cm
        if left + element_cm <= -A or left >= A:
            continue
        first, last = min(first, c), c + 1
        x0[c], x1[c] = max(left, -A), min(left + element_cm, A)
        root = math.sqrt((A - x0[c]) * (A + x0[c]))
        P0[c] = 0.5 * (x0[c] * root + A**2 * math.atan2(x0[c], root))
        root = math.sqrt((A - x1[c]) * (A + x1[c]))
        P1[c] = 0.5 * (x1[c] * root + A**2 * math.atan2(x1[c], root))
    for r in range(rows):
        top = r * pitch_cm - y_cm
        if top + element_cm <= -B or top >= B:
            continue
        for side in range(2):
            h = top + side * element_cm
            if h <= -B:
                continue
            sign = 2.0 * side - 1.0
            if h >= B:
                for c in range(first, last):
                    areas[r, c] += sign * 2.0 * k * (P1[c] - P0[c])
                continue
            half = k * math.sqrt((B - h) * (B + h))
            s = min(max((m * h - half) * stretch, -A), A)
            e = min(max((m * h + half) * stretch, -A), A)
            root = math.sqrt((A - s) * (A + s))
            Ps = 0.5 * (s * root + A**2 * math.atan2(s, root))
            root = math.sqrt((A - e) * (A + e))
            Pe = 0.5 * (e * root + A**2 * math.atan2(e, root))
            left_below = h > -m * A
            right_below = h > m * A
            for c in range(first, last):
                u, v = x0[c], x1[c]
                below = 0.0
                if u < s and left_below:
                    below += 2.0 * k * ((P1[c] if v < s else Ps) - P0[c])
                if v > e and right_below:
                    below += 2.0 * k * (P1[c] - (P0[c] if u > e else Pe))
                if v > s and u < e:
                    c0, Pc0 = (u, P0[c]) if u > s else (s, Ps)
                    c1, Pc1 = (v, P1[c]) if v < e else (e, Pe)
                    below += (c1 - c0) * (h - 0.5 * m * (c1 + c0)) + k * (Pc1 - Pc0)
                areas[r, c] += sign * below
    full = element_cm**2
    for r in range(rows):
        for c in range(first, last):
            areas[r, c] = min(max(areas[r, c], 0.0), full)
    return areas
