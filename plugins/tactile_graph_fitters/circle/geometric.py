"""The geometric circle fit: Levenberg and Marquardt's iteration on the centre alone."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from tactile_graph.compiled import compiled_later
from tactile_graph.wires.parts import PointsParts
from tactile_graph_fitters.circle.algebraic import HYPER, algebraic_circle, back
from tactile_graph_fitters.circle.fitted_circle import CircleParts
from tactile_graph_fitters.circle.principal_axes import EPS, NOT_SETTLED, OK, ONE_LINE, into_frame

STEP = 1e-10  # of the radius: Newton squares it once more, to below rounding
FLAT = 1e3  # radii beyond so many extents of the points are checked against a straight line
REACH = 2.0  # no point is further from the middle, in half extents
ROUNDS = 200

Slopes = tuple[float, float, float, float, float, float, float, float, float, float]


@compiled_later
def slopes(uv: NDArray[np.float64], a: float, b: float) -> Slopes:
    """Return what the sum of squares F does around the centre (a, b), per point.

    With the distances d of the points from the centre, the best radius is their mean, and
    F = mean (d - mean d)**2 depends on the centre alone.

    Returns
    -------
    tuple of float
        Mean of d, the best radius; F; half the gradient (u, v); half the Gauss-Newton matrix
        (uu, uv, vv); what the distances' second derivatives add to it (uu, uv, vv).
    """
    n = uv.shape[1]
    centre = math.sqrt(a * a + b * b)
    to_a, to_b = (a / centre, b / centre) if centre > 0.0 else (0.0, 0.0)
    # Each mean is taken around a first value, which keeps its digits.
    s_e = s_c = s_s = s_ee = s_ec = s_es = s_cc = s_cs = s_ss = 0.0
    w_ss = w_cs = w_cc = w_all_ss = w_all_cs = w_all_cc = 0.0
    e_0 = c_0 = s_0 = 0.0
    for i in range(n):
        u, v = uv[0, i], uv[1, i]
        du, dv = u - a, v - b
        d = math.sqrt(du * du + dv * dv)
        inverse = 1.0 / d if d > 0.0 else 0.0
        size = d + centre
        e = (u * u + v * v - 2.0 * (a * u + b * v)) / size if size > 0.0 else 0.0
        cos, sin = -du * inverse, -dv * inverse
        c, s = -(u + to_a * e) * inverse, -(v + to_b * e) * inverse
        if i == 0:
            e_0, c_0, s_0 = e, c, s
        e -= e_0
        c -= c_0
        s -= s_0
        s_e += e
        s_c += c
        s_s += s
        s_ee += e * e
        s_ec += e * c
        s_es += e * s
        s_cc += c * c
        s_cs += c * s
        s_ss += s * s
        w_ss += e * inverse * sin * sin
        w_cs += e * inverse * cos * sin
        w_cc += e * inverse * cos * cos
        w_all_ss += inverse * sin * sin
        w_all_cs += inverse * cos * sin
        w_all_cc += inverse * cos * cos
    m_e, m_c, m_s = s_e / n, s_c / n, s_s / n
    return (
        centre + e_0 + m_e,
        max(s_ee / n - m_e * m_e, 0.0),
        s_ec / n - m_e * m_c,
        s_es / n - m_e * m_s,
        s_cc / n - m_c * m_c,
        s_cs / n - m_c * m_s,
        s_ss / n - m_s * m_s,
        (w_ss - m_e * w_all_ss) / n,
        (m_e * w_all_cs - w_cs) / n,
        (w_cc - m_e * w_all_cc) / n,
    )


@compiled_later
def step_of(now: Slopes, damping: float) -> tuple[float, float, float, bool]:
    """Return the step of the centre, the decrease of F promised, whether F curves up all round.

    The full second derivative is used where F curves up, else Gauss and Newton's part of it.
    """
    _, _, g_u, g_v, uu, uv, vv, bend_uu, bend_uv, bend_vv = now
    h_uu, h_uv, h_vv = uu + bend_uu, uv + bend_uv, vv + bend_vv
    upward = h_uu > 0.0 and h_uu * h_vv - h_uv * h_uv > EPS * h_uu * abs(h_vv)
    if not upward:
        h_uu, h_uv, h_vv = uu, uv, vv
    h_uu += damping * uu
    h_vv += damping * vv
    det = h_uu * h_vv - h_uv * h_uv
    if not det > 0.0:
        return 0.0, 0.0, 0.0, upward
    du, dv = (h_uv * g_v - h_vv * g_u) / det, (h_uv * g_u - h_uu * g_v) / det
    return du, dv, -(g_u * du + g_v * dv), upward


@compiled_later
def refined(
    uv: NDArray[np.float64], a: float, b: float
) -> tuple[int, float, float, float, float, int]:
    """Return status, centre (u, v), radius, rms and iterations of the geometric fit."""
    line = 0.0
    for i in range(uv.shape[1]):
        line += uv[1, i] * uv[1, i]
    line /= uv.shape[1]
    now = slopes(uv, a, b)
    damping = 0.0
    kicked = undamped = False
    for rounds in range(1, ROUNDS + 1):
        radius = now[0]
        du, dv, promised, upward = step_of(now, damping)
        # What rounding of the distances does to F; they differ by no more than the points do.
        reach = min(radius, REACH)
        floor = EPS * (5.0 * now[1] + 8.0 * reach * math.sqrt(now[1]) + 16.0 * EPS * reach**2)
        if promised <= floor and damping > 0.0:
            if undamped:
                return OK, a, b, radius, math.sqrt(now[1]), rounds
            damping, undamped = 0.0, True
            continue
        if promised <= floor and not upward and not kicked:
            # Level but no minimum, as in the middle of two equal rows: the way down is across.
            b, kicked = b + 0.5, True
            now = slopes(uv, a, b)
            continue
        new = slopes(uv, a + du, b + dv)
        if new[1] > now[1] + floor and promised > floor:
            damping = max(4.0 * damping, 1e-3)
            continue
        # At the floor F is too coarse to judge by, but Newton's step is still the better centre.
        a, b, now, radius = a + du, b + dv, new, new[0]
        damping, undamped = 0.1 * damping if damping > 1e-6 else 0.0, False
        if radius > FLAT and now[1] > (1.0 - 1e-6) * line:
            return ONE_LINE, a, b, radius, 0.0, 0
        if promised <= floor or math.sqrt(du * du + dv * dv) <= STEP * radius:
            return OK, a, b, radius, math.sqrt(now[1]), rounds
    return NOT_SETTLED, a, b, now[0], 0.0, ROUNDS


@compiled_later
def geometric_fit(xy: NDArray[np.float64]) -> tuple[int, float, float, float, float, int]:
    """Return status, centre (x, y), radius and rms in cm, iterations."""
    status, uv, frame = into_frame(xy)
    if status != OK:
        return status, 0.0, 0.0, 0.0, 0.0, 0
    a, b, _ = algebraic_circle(uv, HYPER)
    status, a, b, radius, rms, rounds = refined(uv, a, b)
    x, y, radius, rms = back(frame, a, b, radius, rms)
    return status, x, y, radius, rms, rounds


@compiled_later
def geometric_fit_of_parts(points: PointsParts) -> tuple[bool, CircleParts]:
    """Do the same to the parts of points; not where there is no circle."""
    status, x, y, radius, rms, rounds = geometric_fit(points.xy_cm)
    return status == OK, CircleParts(x, y, radius, rms, points.xy_cm.shape[0], rounds)


@compiled_later
def geometric_fit_each(xy, starts, numbers, counts):  # type: ignore[no-untyped-def]
    """Fit several frames' points; write centre, radius and rms, and status, points, iterations."""
    for k in range(starts.shape[0] - 1):
        status, x, y, radius, rms, rounds = geometric_fit(xy[starts[k] : starts[k + 1]])
        numbers[k, 0], numbers[k, 1], numbers[k, 2], numbers[k, 3] = x, y, radius, rms
        counts[k, 0], counts[k, 1], counts[k, 2] = status, starts[k + 1] - starts[k], rounds
