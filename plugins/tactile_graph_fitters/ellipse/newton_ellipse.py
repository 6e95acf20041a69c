"""The geometric ellipse fit by Newton's method on the ellipse and all nearest points together."""

from __future__ import annotations

import math
from typing import TypeAlias

import numpy as np
from numpy.typing import NDArray

from tactile_graph.compiled import compiled_later
from tactile_graph_fitters.circle.principal_axes import EPS
from tactile_graph_fitters.ellipse.ellipse_equations import reduced
from tactile_graph_fitters.ellipse.nearest_on_ellipse import along_axes, feet

Values: TypeAlias = NDArray[np.float64]

FIRST_STEP = 0.1  # of the half axes' sum; from farther away another minimum may be nearer
SHRINKS = 0.25  # steps to no more than this of the one before, for the same reason
LAST_STEP = 1e-9  # of the half axes' sum, and the next one would be below rounding
EVEN = 1e-12  # of the points' number: the least pivot of equations that have an answer


@compiled_later
def solved(normal: Values, slope: Values, least: float, step: Values) -> bool:
    """Write the solution of N step = -slope, N positive definite; return False if it is not."""
    for i in range(5):
        for k in range(i + 1):
            total = normal[i, k]
            for m in range(k):
                total -= normal[i, m] * normal[k, m]
            if i > k:
                normal[i, k] = total / normal[k, k]
            elif total > least:
                normal[i, i] = math.sqrt(total)
            else:
                return False
    for i in range(5):
        total = -slope[i]
        for m in range(i):
            total -= normal[i, m] * step[m]
        step[i] = total / normal[i, i]
    for i in range(4, -1, -1):
        total = step[i]
        for m in range(i + 1, 5):
            total -= normal[m, i] * step[m]
        step[i] = total / normal[i, i]
    return True


@compiled_later
def turned_feet(cs: Values, rows: Values, step: Values) -> None:
    """Move each nearest point's angle by what the five steps and its own slope take off it."""
    s_0, s_1, s_2, s_3, s_4 = step[0], step[1], step[2], step[3], step[4]
    for i in range(cs.shape[1]):
        c, s = cs[0, i], cs[1, i]
        half = -0.5 * (
            rows[5, i] * (
                rows[0, i] * s_0 + rows[1, i] * s_1 + rows[2, i] * s_2 + rows[3, i] * s_3
                + rows[4, i] * s_4
            )
            + rows[6, i]
        )  # fmt: skip
        size = 1.0 / (1.0 + half * half)
        cs[0, i] = ((1.0 - half * half) * c - 2.0 * half * s) * size
        cs[1, i] = ((1.0 - half * half) * s + 2.0 * half * c) * size


@compiled_later
def as_matrix(a: float, b: float, angle: float) -> tuple[float, float, float]:
    """Return M's entries for half axes and the angle of the first."""
    cos, sin = math.cos(angle), math.sin(angle)
    return a * cos * cos + b * sin * sin, (a - b) * cos * sin, a * sin * sin + b * cos * cos


@compiled_later
def newton(uv: Values, p: Values, rounds: int) -> tuple[float, int]:
    """Bring ``p`` to the minimum next to it; return the sum of squares and the rounds made.

    It does so only where every step is well defined and much smaller than the one before; else it
    returns 0 rounds and leaves ``p``, shape (5,): centre, half axes and angle of the first.
    """
    n = uv.shape[1]
    rows, small = np.empty((7, n)), np.empty((8, 5))
    normal, slope, step, ellipse = small[:5], small[5], small[6], small[7]
    ellipse[0], ellipse[1] = p[0], p[1]
    ellipse[2], ellipse[3], ellipse[4] = as_matrix(p[2], p[3], p[4])
    cs = feet(along_axes(uv, p[0], p[1], p[4]), p[2], p[3])
    cos, sin = math.cos(p[4]), math.sin(p[4])
    for i in range(n):
        c, s = cs[0, i], cs[1, i]
        cs[0, i], cs[1, i] = c * cos - s * sin, c * sin + s * cos
    first, last = np.inf, FIRST_STEP / SHRINKS * (ellipse[2] + ellipse[4])
    for k in range(1, rounds + 1):
        now = reduced(uv, ellipse, cs, rows, normal, slope)
        if not now < np.inf or not solved(normal, slope, EVEN * n, step):
            return 0.0, 0
        size = 0.0
        for m in range(5):
            ellipse[m] += step[m]
            size = max(size, abs(step[m]))
        turned_feet(cs, rows, step)
        m_uu, m_uv, m_vv = ellipse[2], ellipse[3], ellipse[4]
        extent = m_uu + m_vv
        if not (m_uu > 0.0 and m_uu * m_vv > m_uv * m_uv):
            return 0.0, 0
        if k == 1:
            first = now
        slower = not size <= SHRINKS * last
        # A step is to the one before as the square of what that was to the one before it.
        following = size * (size / last) ** 2 if k > 1 else size
        if size <= LAST_STEP * extent and (slower or following <= EPS * extent):
            total = _as_axes(uv, ellipse, cs, p, first)
            return total, k if total < np.inf else 0
        if slower:
            return 0.0, 0
        last = size
    return 0.0, 0


@compiled_later
def _as_axes(uv: Values, ellipse: Values, cs: Values, p: Values, most: float) -> float:
    """Write centre, half axes and angle, and return the sum of squares.

    It is infinite, and nothing written, if it is more than ``most`` or if a foot is not in its
    point's quadrant of the ellipse: then another place is nearer.
    """
    n = uv.shape[1]
    u, v, m_uu, m_uv, m_vv = ellipse[0], ellipse[1], ellipse[2], ellipse[3], ellipse[4]
    middle, half = 0.5 * (m_uu + m_vv), math.hypot(0.5 * (m_uu - m_vv), m_uv)
    a, b = middle + half, (m_uu * m_vv - m_uv * m_uv) / (middle + half)
    angle = 0.5 * math.atan2(2.0 * m_uv, m_uu - m_vv)
    cos, sin = math.cos(angle), math.sin(angle)
    total, wrong = 0.0, 0
    for i in range(n):
        c, s = cs[0, i], cs[1, i]
        du, dv = uv[0, i] - u, uv[1, i] - v
        off_u, off_v = du - m_uu * c - m_uv * s, dv - m_uv * c - m_vv * s
        total += off_u * off_u + off_v * off_v
        wrong += (c * cos + s * sin) * (du * cos + dv * sin) < -1e-9 * a
        wrong += (s * cos - c * sin) * (dv * cos - du * sin) < -1e-9 * a
    # A perfect fit's sum is all rounding.
    if wrong or not total <= most + 1e-12 * most + 1e-28 * n * a * a:
        return math.inf
    p[0], p[1], p[2], p[3], p[4] = u, v, a, b, angle
    return total
