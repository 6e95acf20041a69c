"""How far points are from an ellipse, and where on it the nearest point is."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from tactile_graph.compiled import compiled_later, compiled_twin_of

Values = NDArray[np.float64]

STEPS = 4  # of Newton's method for all points at once, before each is looked at
NEAR_FOOT = 1e-7  # a step beyond which a foot is looked for again: its square is below rounding


@compiled_later
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


@compiled_later
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


def _feet(xy: Values, a: float, b: float) -> Values:
    """Return the cosine and sine, shape (2, N), that lead to the ellipse's nearest points.

    Of points (x, y), shape (2, N), from its centre and along its half axes a and b; the nearest
    one is (a cos, b sin).
    """
    if a < b:
        return np.ascontiguousarray(_feet(xy[::-1], b, a)[::-1])
    zx, zy = np.abs(xy) / np.array([[a], [b]])
    ratio = (a / b) ** 2
    more = ratio - 1.0
    flat = zy <= max(1e-300 / b, 1e-15)
    zy = np.where(flat, 1.0, zy)  # those are found below
    both = np.hypot(ratio * zx, zy)
    s = np.maximum(zy, both - more - 2e-15 * both)
    for _ in range(100):
        f, g = ratio * zx / (s + more), zy / s
        following = s + 0.5 * (f * f + g * g - 1.0) / (f * f / (s + more) + g * g / s)
        moves = following > s * (1.0 + 4e-16)
        if not moves.any():
            break
        s = np.where(moves, following, s)
    reach = a - b * (b / a)
    cos = np.where(flat & (a * zx < reach), a * zx / reach if reach > 0.0 else 1.0, 1.0)
    found = np.where(flat, (cos, np.sqrt(1.0 - cos * cos)), (ratio * zx / (s + more), zy / s))
    return np.copysign(found, xy)


@compiled_twin_of(_feet)
def feet(xy: Values, a: float, b: float) -> Values:
    """Do the same: on the angle of all points at once, and as before for those still in doubt.

    A foot where the distance has its minimum in the point's own quadrant is the nearest.
    """
    n = xy.shape[1]
    cs = np.empty((2, n))
    for i in range(n):
        c, s = xy[0, i] / a, xy[1, i] / b
        size = math.sqrt(c * c + s * s)
        cs[0, i], cs[1, i] = c / size, s / size
    for _ in range(STEPS):
        for i in range(n):
            c, s = cs[0, i], cs[1, i]
            x, y, ac, bs, ass, bc = xy[0, i], xy[1, i], a * c, b * s, a * s, b * c
            slope = (x - ac) * ass - (y - bs) * bc
            bend = ass * ass + bc * bc + (x - ac) * ac + (y - bs) * bs
            half = -0.5 * slope / bend
            size = 1.0 / (1.0 + half * half)
            cs[0, i] = ((1.0 - half * half) * c - 2.0 * half * s) * size
            cs[1, i] = ((1.0 - half * half) * s + 2.0 * half * c) * size
    for i in range(n):
        c, s, x, y = cs[0, i], cs[1, i], xy[0, i], xy[1, i]
        ac, bs, ass, bc = a * c, b * s, a * s, b * c
        slope = (x - ac) * ass - (y - bs) * bc
        speed = ass * ass + bc * bc
        bend = speed + (x - ac) * ac + (y - bs) * bs
        sure = c * x >= 0.0 and s * y >= 0.0 and bend > 0.01 * speed
        if not (sure and abs(slope) <= NEAR_FOOT * bend):
            fx, fy = nearest(a, b, x, y)
            cs[0, i], cs[1, i] = fx / a, fy / b
    return cs


@compiled_later
def along_axes(uv: Values, u: float, v: float, angle: float) -> Values:
    """Return points, shape (2, N), from a centre, along and across an angle."""
    cos, sin = math.cos(angle), math.sin(angle)
    xy = np.empty(uv.shape)
    for i in range(uv.shape[1]):
        du, dv = uv[0, i] - u, uv[1, i] - v
        xy[0, i], xy[1, i] = du * cos + dv * sin, dv * cos - du * sin
    return xy


@compiled_later
def distances(uv: Values, u: float, v: float, a: float, b: float, angle: float) -> Values:
    """Return the signed distances of points of shape (2, N) from an ellipse, > 0 outside."""
    xy = along_axes(uv, u, v, angle)
    cs = feet(xy, a, b)
    off = np.empty(uv.shape[1])
    for i in range(uv.shape[1]):
        c, s = cs[0, i], cs[1, i]
        # Along the outward normal, so that an error of the foot counts by its square.
        off[i] = ((xy[0, i] - a * c) * (b * c) + (xy[1, i] - b * s) * (a * s)) / math.sqrt(
            a * s * a * s + b * c * b * c
        )
    return off
