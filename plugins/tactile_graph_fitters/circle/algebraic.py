"""Algebraic circles in closed form: Kåsa, Taubin and hyper, which differ in one number."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from tactile_graph.compiled import compiled_later
from tactile_graph_fitters.circle.principal_axes import OK, Frame, into_frame

KASA, TAUBIN, HYPER = range(3)

Moments = tuple[float, float, float, float, float]


@compiled_later
def moments(uv: NDArray[np.float64]) -> Moments:
    """Return the means of u u, v v, u w, v w and w w, where w is u u + v v less its mean."""
    n = uv.shape[1]
    uu = vv = 0.0
    for i in range(n):
        uu += uv[0, i] * uv[0, i]
        vv += uv[1, i] * uv[1, i]
    uu /= n
    vv /= n
    uw = vw = ww = 0.0
    for i in range(n):
        u, v = uv[0, i], uv[1, i]
        w = u * u + v * v - (uu + vv)
        uw += u * w
        vw += v * w
        ww += w * w
    return uu, vv, uw / n, vw / n, ww / n


@compiled_later
def algebraic_circle(uv: NDArray[np.float64], method: int) -> tuple[float, float, float]:
    """Return centre (u, v) and radius of an algebraic fit to centred points on main axes.

    On main axes the mean of u v is 0 and the normal equations fall apart: the centre is
    (uw / (uu - eta) / 2, vw / (vv - eta) / 2), with eta = 0 for Kåsa's fit and the least root
    of a cubic (Taubin) or quartic (hyper) for the others. Source: N. Chernov 2010, Circular and
    Linear Regression, sections 5.5, 5.7 and 7.5; Newton's method from 0 finds that root.
    """
    uu, vv, uw, vw, ww = moments(uv)
    z, both = uu + vv, uu * vv
    eta = 0.0
    if method != KASA:
        a0 = uw * uw * vv + vw * vw * uu - ww * both
        a1 = ww * z + 4.0 * both * z - uw * uw - vw * vw
        # ww + z z is the mean of (u u + v v)**2, Mzz in the source.
        a2, a3, a4 = -3.0 * z * z - (ww + z * z), 4.0 * z, 0.0
        if method == HYPER:
            a2, a3, a4 = a2 + 4.0 * both, 0.0, 4.0
        value = a0
        for _ in range(50):
            slope = a1 + eta * (2.0 * a2 + eta * (3.0 * a3 + eta * 4.0 * a4))
            following = eta - value / slope if slope != 0.0 else np.inf
            # Past the least root or at rounding's floor Newton turns back: keep what it had.
            if not math.isfinite(following) or following <= eta or following >= vv:
                break
            new_value = a0 + following * (a1 + following * (a2 + following * (a3 + following * a4)))
            if abs(new_value) >= abs(value):
                break
            eta, value = following, new_value
    u, v = 0.5 * uw / (uu - eta), 0.5 * vw / (vv - eta)
    spread = z - 2.0 * eta if method == HYPER else z
    return u, v, math.sqrt(u * u + v * v + max(spread, 0.0))


@compiled_later
def distance_from_circle(uv: NDArray[np.float64], u: float, v: float, radius: float) -> float:
    """Return the root mean square of the points' distances from a circle."""
    total = 0.0
    centre = math.hypot(u, v)
    for i in range(uv.shape[1]):
        x, y = uv[0, i], uv[1, i]
        size = math.hypot(x - u, y - v) + centre
        # Distance less ``centre``: written so that a huge circle costs no digits.
        beyond = (x * x + y * y - 2.0 * (u * x + v * y)) / size if size > 0.0 else 0.0
        off = beyond + (centre - radius)
        total += off * off
    return math.sqrt(total / uv.shape[1])


@compiled_later
def back(
    frame: Frame, u: float, v: float, radius: float, rms: float
) -> tuple[float, float, float, float]:
    """Return centre (x, y), radius and rms in cm of a circle in the frame of `into_frame`."""
    x, y, scale, cos, sin = frame
    return (
        x + scale * (u * cos - v * sin),
        y + scale * (u * sin + v * cos),
        scale * radius,
        scale * rms,
    )


@compiled_later
def algebraic_fit(
    xy: NDArray[np.float64], method: int
) -> tuple[int, float, float, float, float, int]:
    """Return status, centre (x, y), radius and rms in cm, and 0 iterations."""
    status, uv, frame = into_frame(xy)
    if status != OK:
        return status, 0.0, 0.0, 0.0, 0.0, 0
    u, v, radius = algebraic_circle(uv, method)
    rms = distance_from_circle(uv, u, v, radius)
    x, y, radius, rms = back(frame, u, v, radius, rms)
    return status, x, y, radius, rms, 0
