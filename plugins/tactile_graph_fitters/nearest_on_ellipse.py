"""How far points are from an ellipse, and where on it the nearest point is."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from tactile_graph.compiled import compiled_as_is

Values = NDArray[np.float64]


@compiled_as_is
def _first_quadrant(a: float, b: float, px: float, py: float) -> tuple[float, float]:
    """Return the nearest point for a >= b and a point with coordinates >= 0."""
    if py <= 1e-300 or py <= 1e-15 * b:
        # On the major axis: below the centre of curvature's reach the foot leaves the axis.
        reach = a * a - b * b
        if a * px < reach:
            cos = a * px / reach
            return a * cos, b * math.sqrt(max(0.0, 1.0 - cos * cos))
        return a, 0.0
    ratio = (a / b) ** 2
    zx, zy = px / a, py / b
    # s = t / b**2 + 1 > 0; the foot is (ratio px / (s + ratio - 1), py / s).
    # Below its root: each term alone is less than both, and s + ratio - 1 more than s. The margin
    # is what the difference may lose by rounding.
    more = ratio - 1.0
    both = math.sqrt(ratio * zx * ratio * zx + zy * zy)
    s = max(zy, both - more - 2e-15 * both)
    for _ in range(100):
        f, g = ratio * zx / (s + more), zy / s
        value = f * f + g * g - 1.0
        fall = -2.0 * (f * f / (s + more) + g * g / s)
        following = s - value / fall
        if not following > s * (1.0 + 4e-16):
            break
        s = following
    return ratio * px / (s + more), py / s


@compiled_as_is
def nearest(a: float, b: float, x: float, y: float) -> tuple[float, float]:
    """Return the point nearest to (x, y) of the ellipse with half axes a along x and b along y.

    Solves (a x / (t + a**2))**2 + (b y / (t + b**2))**2 = 1 for its greatest root, in the first
    quadrant and scaled by the smaller half axis, by Newton's method from below, where
    the left side is convex and falling; safe for points on the axes and in the centre. Source:
    D. Eberly 2013, Distance from a point to an ellipse.
    """
    if a < b:
        fy, fx = _first_quadrant(b, a, abs(y), abs(x))
    else:
        fx, fy = _first_quadrant(a, b, abs(x), abs(y))
    return math.copysign(fx, x), math.copysign(fy, y)


@compiled_as_is
def distances(uv: Values, u: float, v: float, a: float, b: float, angle: float) -> Values:
    """Return the signed distances of points of shape (2, N) from an ellipse, > 0 outside."""
    n = uv.shape[1]
    cos, sin = math.cos(angle), math.sin(angle)
    off = np.empty(n)
    for i in range(n):
        du, dv = uv[0, i] - u, uv[1, i] - v
        x, y = du * cos + dv * sin, dv * cos - du * sin
        fx, fy = nearest(a, b, x, y)
        distance = math.hypot(x - fx, y - fy)
        off[i] = distance if (x / a) ** 2 + (y / b) ** 2 > 1.0 else -distance
    return off
