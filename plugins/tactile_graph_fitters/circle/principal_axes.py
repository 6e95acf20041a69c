"""The frame every circle is fitted in: points centred, scaled and turned to their main axes.

There nothing overflows, an offset of the pad costs no digits, and the two parts of a short arc
that differ most in size, along and across, are kept apart.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from tactile_graph.compiled import compiled_later

OK, TOO_FEW, NOT_FINITE, OUT_OF_RANGE, ALL_EQUAL, ONE_LINE, NOT_SETTLED = range(7)
"""What can come of a fit; words for each are in `why`."""

LARGEST, SMALLEST = 1e150, 1e-150  # sizes whose squares are still numbers
EPS = 2.0**-52

Frame = tuple[float, float, float, float, float]
"""Centre x, y, scale, cosine and sine: (x, y) = centre + scale * (u cos - v sin, u sin + v cos)."""


@compiled_later
def bounds(xy: NDArray[np.float64]) -> tuple[int, float, float, float, float]:
    """Return a status, the middle (x, y) of the points, half their extent, their largest size."""
    n = xy.shape[0]
    if n < 3:
        return TOO_FEW, 0.0, 0.0, 0.0, 0.0
    x_low = x_high = xy[0, 0]
    y_low = y_high = xy[0, 1]
    finite = True
    for i in range(n):
        x, y = xy[i, 0], xy[i, 1]
        finite &= abs(x) + abs(y) < np.inf or (math.isfinite(x) and math.isfinite(y))
        x_low, x_high = min(x_low, x), max(x_high, x)
        y_low, y_high = min(y_low, y), max(y_high, y)
    if not finite:
        return NOT_FINITE, 0.0, 0.0, 0.0, 0.0
    largest = max(-x_low, x_high, -y_low, y_high)
    if largest > LARGEST or 0.0 < largest < SMALLEST:
        return OUT_OF_RANGE, 0.0, 0.0, 0.0, 0.0
    half = max(x_high - x_low, y_high - y_low) / 2.0
    status = OK if half > 0.0 else ALL_EQUAL
    return status, (x_low + x_high) / 2.0, (y_low + y_high) / 2.0, half, largest


@compiled_later
def turned(
    xy: NDArray[np.float64], x: float, y: float, half: float
) -> tuple[NDArray[np.float64], float, float, float, float]:
    """Return the points along (u) and across (v) their main axis; their mean; cosine and sine."""
    n = xy.shape[0]
    uv = np.empty((2, n))
    mean_x = mean_y = 0.0
    for i in range(n):
        uv[0, i], uv[1, i] = (xy[i, 0] - x) / half, (xy[i, 1] - y) / half
        mean_x += uv[0, i]
        mean_y += uv[1, i]
    mean_x /= n
    mean_y /= n
    s_xx = s_xy = s_yy = 0.0
    for i in range(n):
        dx, dy = uv[0, i] - mean_x, uv[1, i] - mean_y
        s_xx += dx * dx
        s_xy += dx * dy
        s_yy += dy * dy
    angle = 0.5 * math.atan2(2.0 * s_xy, s_xx - s_yy)
    cos, sin = math.cos(angle), math.sin(angle)
    for i in range(n):
        dx, dy = uv[0, i] - mean_x, uv[1, i] - mean_y
        uv[0, i], uv[1, i] = dx * cos + dy * sin, dy * cos - dx * sin
    return uv, mean_x, mean_y, cos, sin


@compiled_later
def into_frame(xy: NDArray[np.float64]) -> tuple[int, NDArray[np.float64], Frame]:
    """Return a status, the points' (u, v), shape (2, N), and the frame that leads back.

    Points are in one line if none is further from it than rounding has put it: two units in the
    last place of the largest coordinate.
    """
    status, x, y, half, largest = bounds(xy)
    if status != OK:
        return status, np.empty((2, 0)), (x, y, 1.0, 1.0, 0.0)
    uv, mean_x, mean_y, cos, sin = turned(xy, x, y, half)
    limit = (2.0 * largest / half + 4.0) * EPS
    status = ONE_LINE
    for i in range(uv.shape[1]):
        if abs(uv[1, i]) > limit:
            status = OK
            break
    return status, uv, (x + half * mean_x, y + half * mean_y, half, cos, sin)
