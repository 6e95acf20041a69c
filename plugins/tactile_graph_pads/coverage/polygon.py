"""Exact area of a simple polygon on each element of a grid, by edge integrals.

The area on an element is the sum over the polygon's edges, taken with the direction they run
in, of the integral of the edge's height above the element's lower line, clipped to the element.
No clipped polygon is ever built, so corners that are not convex need no care.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from tactile_graph.compiled import compiled_twin_of

Area = NDArray[np.float64]


def _reference(xy_cm: Area, pitch_cm: float, element_cm: float, rows: int, columns: int) -> Area:
    """Return the area of the polygon on each element, in cm^2, shape (rows, columns).

    Parameters
    ----------
    xy_cm : ndarray of float64, shape (N, 2)
        Corners in order, either way round; element (0, 0) has its top left corner in the origin.
    pitch_cm, element_cm : float
        Distance of the elements and their side.
    rows, columns : int
        Size of the grid.

    Notes
    -----
    Areas below 1e-13 of an element are rounding and come out as 0.
    """
    top = (np.arange(rows) * pitch_cm)[:, None]
    left = (np.arange(columns) * pitch_cm)[None, :]
    areas = np.zeros((rows, columns))
    for (xa, ya), (xb, yb) in zip(xy_cm, np.roll(xy_cm, -1, axis=0), strict=True):
        if xa == xb:
            continue
        u = np.clip(left, min(xa, xb), max(xa, xb))
        v = np.clip(left + element_cm, min(xa, xb), max(xa, xb))
        yu, yv = ya + (u - xa) / (xb - xa) * (yb - ya), ya + (v - xa) / (xb - xa) * (yb - ya)
        low, high = np.minimum(yu, yv) - top, np.maximum(yu, yv) - top
        c0, c1 = np.clip(low, 0.0, element_cm), np.clip(high, 0.0, element_cm)
        rise = high - low
        above = np.maximum(high - np.maximum(low, element_cm), 0.0)
        with np.errstate(invalid="ignore", divide="ignore"):
            mean = (0.5 * (c1 - c0) * (c1 + c0) + above * element_cm) / rise
        mean = np.where(rise > 0.0, mean, c0)
        areas += np.sign(xb - xa) * (v - u) * mean
    areas = np.abs(areas)
    full = element_cm**2
    areas[areas < 1e-13 * full] = 0.0
    return np.asarray(np.minimum(areas, full))


@compiled_twin_of(_reference)
def polygon_areas(  # noqa: D103 - the pair's docstring is the reference's
    xy_cm: Area, pitch_cm: float, element_cm: float, rows: int, columns: int
) -> Area:
    areas = np.zeros((rows, columns))
    n = xy_cm.shape[0]
    for i in range(n):
        j = i + 1 if i + 1 < n else 0
        xa, ya, xb, yb = xy_cm[i, 0], xy_cm[i, 1], xy_cm[j, 0], xy_cm[j, 1]
        if xa == xb:
            continue
        sign = 1.0 if xb > xa else -1.0
        x_low, x_high = min(xa, xb), max(xa, xb)
        slope = (yb - ya) / (xb - xa)
        first = max(0, int((x_low - element_cm) / pitch_cm))
        for c in range(first, columns):
            left = c * pitch_cm
            if left >= x_high:
                break
            u, v = max(left, x_low), min(left + element_cm, x_high)
            if v <= u:
                continue
            width = sign * (v - u)
            yu, yv = ya + (u - xa) * slope, ya + (v - xa) * slope
            y_low, y_high = min(yu, yv), max(yu, yv)
            for r in range(rows):
                top = r * pitch_cm
                if y_high <= top:
                    break
                low, high = y_low - top, y_high - top
                if low >= element_cm:
                    areas[r, c] += width * element_cm
                elif low >= 0.0 and high <= element_cm:
                    areas[r, c] += width * 0.5 * (low + high)
                else:
                    c0 = max(low, 0.0)
                    c1 = min(high, element_cm)
                    above = max(high - element_cm, 0.0)
                    total = 0.5 * (c1 - c0) * (c1 + c0) + above * element_cm
                    areas[r, c] += width * total / (high - low)
    full = element_cm**2
    for r in range(rows):
        for c in range(columns):
            area = abs(areas[r, c])
            areas[r, c] = 0.0 if area < 1e-13 * full else min(area, full)
    return areas
