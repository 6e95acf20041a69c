"""Newton's equations for the nearest ellipse, from the points and their angles on it.

An ellipse is its centre and a symmetric matrix M: its points are centre + M (cos, sin). They are
linear in these five numbers, and a circle, where axes have no direction, is no special place.
The angles of the points' nearest points are unknowns as well; as each of them matters for one
distance only, they are eliminated and five equations are left.
"""

from __future__ import annotations

import math
from typing import TypeAlias

import numpy as np
from numpy.typing import NDArray

from tactile_graph.compiled import compiled_later

Values: TypeAlias = NDArray[np.float64]


@compiled_later
def reduced(
    uv: Values, ellipse: Values, cs: Values, rows: Values, normal: Values, slope: Values
) -> float:
    """Write Newton's equations for the ellipse alone; return the sum of squares.

    Parameters
    ----------
    uv : ndarray, shape (2, N)
        The points.
    ellipse : ndarray, shape (5,)
        Centre u and v, and M's entries uu, uv, vv.
    cs : ndarray, shape (2, N)
        Cosine and sine of each nearest point's angle.
    rows : ndarray, shape (7, N)
        Out: second derivatives of half the squared distances by the angle and each of the five,
        one over those by the angle twice, and what the angles' own slopes take off them.
    normal : ndarray, shape (5, 5)
        Out: second derivatives of half the sum of squares; the lower triangle at least.
    slope : ndarray, shape (5,)
        Out: its gradient.

    Returns
    -------
    float
        Infinite if some point has no distance from the ellipse that is least near its angle.
    """
    n = uv.shape[1]
    total, s_c, s_s, s_cc, s_cs = _pulled(uv, ellipse, cs, rows, slope)
    for k in range(5):
        a_0 = a_1 = a_2 = a_3 = a_4 = 0.0
        for i in range(n):
            each = rows[k, i] * rows[5, i]
            a_0 += each * rows[0, i]
            a_1 += each * rows[1, i]
            a_2 += each * rows[2, i]
            a_3 += each * rows[3, i]
            a_4 += each * rows[4, i]
        normal[k, 0], normal[k, 1], normal[k, 2], normal[k, 3] = -a_0, -a_1, -a_2, -a_3
        normal[k, 4] = -a_4
    for k in (0, 1, 3):
        normal[k, k] += n
    normal[2, 0] += s_c
    normal[3, 1] += s_c
    normal[3, 0] += s_s
    normal[4, 1] += s_s
    normal[3, 2] += s_cs
    normal[4, 3] += s_cs
    normal[2, 2] += s_cc
    normal[4, 4] += n - s_cc
    return total


@compiled_later
def _pulled(
    uv: Values, ellipse: Values, cs: Values, rows: Values, slope: Values
) -> tuple[float, float, float, float, float]:
    """Write the rows and the slope; return the sum of squares, of c, s, c c and c s."""
    u, v, m_uu, m_uv, m_vv = ellipse[0], ellipse[1], ellipse[2], ellipse[3], ellipse[4]
    total = s_c = s_s = s_cc = s_cs = 0.0
    g_u = g_v = g_uu = g_uv = g_vv = 0.0
    wrong = 0
    for i in range(uv.shape[1]):
        c, s = cs[0, i], cs[1, i]
        on_u, on_v = m_uu * c + m_uv * s, m_uv * c + m_vv * s
        off_u, off_v = uv[0, i] - u - on_u, uv[1, i] - v - on_v
        t_u, t_v = m_uv * c - m_uu * s, m_vv * c - m_uv * s
        speed, inward = t_u * t_u + t_v * t_v, off_u * on_u + off_v * on_v
        wrong += not speed + inward > 0.0
        each, even = 1.0 / (speed + inward), 1.0 / speed
        aside = -(off_u * t_u + off_v * t_v) * each
        by_uu, by_uv, by_vv = -s * off_u, c * off_u - s * off_v, c * off_v
        h_uu, h_uv, h_vv = c * t_u, s * t_u + c * t_v, s * t_v
        rows[0, i], rows[1, i], rows[2, i] = t_u, t_v, h_uu - by_uu
        rows[3, i], rows[4, i], rows[5, i], rows[6, i] = h_uv - by_uv, h_vv - by_vv, each, aside
        # Along the normal; and the rest, which is all rounding at the end and nearly cancels.
        out, rest = (off_u * t_v - off_v * t_u) * even, aside * inward * even
        n_u, n_v = out * t_v, -out * t_u
        g_u += rest * t_u - n_u
        g_v += rest * t_v - n_v
        g_uu += rest * h_uu + aside * by_uu - c * n_u
        g_uv += rest * h_uv + aside * by_uv - s * n_u - c * n_v
        g_vv += rest * h_vv + aside * by_vv - s * n_v
        total += off_u * off_u + off_v * off_v
        s_c += c
        s_s += s
        s_cc += c * c
        s_cs += c * s
    slope[0], slope[1], slope[2], slope[3], slope[4] = g_u, g_v, g_uu, g_uv, g_vv
    return math.inf if wrong else total, s_c, s_s, s_cc, s_cs
