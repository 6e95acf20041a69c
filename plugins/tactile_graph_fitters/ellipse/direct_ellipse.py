"""The direct ellipse fit as one equation in one unknown: no matrix is decomposed."""

from __future__ import annotations

import math
from typing import TypeAlias

import numpy as np
from numpy.typing import NDArray

from tactile_graph.compiled import compiled_later
from tactile_graph_fitters.circle.principal_axes import OK, Frame, into_frame
from tactile_graph_fitters.ellipse.nearest_on_ellipse import distances

Values: TypeAlias = NDArray[np.float64]
Found: TypeAlias = tuple[int, float, float, float, float, float, float, int]
"""Status, centre x and y, half axes, angle of the first as seen, rms, rounds."""
Linear: TypeAlias = tuple[float, float, float, float, float]
Quadratics: TypeAlias = tuple[
    tuple[float, float], Linear,
    tuple[float, float, float, float], tuple[float, float, float, float]
]  # fmt: skip

FEW_PLACES, OTHER_CONIC, FLAT = range(7, 10)
"""What else can come of an ellipse, beside what `principal_axes` has."""

FLATTEST = 1e-6
NOTHING = 1e-29  # of the squared quadratics: what rounding leaves of them
PLACES = 5  # an ellipse has five numbers


@compiled_later
def above(square: float, least: float) -> float:
    """Return a sum of squares, or 0 where it is but what rounding left of larger ones."""
    return square if square > least else 0.0


@compiled_later
def quadratics(uv: Values) -> Quadratics:
    """Return what the direct fit needs to know of framed points.

    The points are scaled to a mean square of 1 along u and along v. Their z = (u u + v v) / 2,
    w = (u u - v v) / 2 and r = u v are taken less what a constant, u and v explain of them; w and r
    are turned into each other until they are uncorrelated.

    Returns
    -------
    scales : tuple of float
        Root mean squares of the points' u and v.
    linear : tuple of float
        Means of u u u, u u v, u v v, v v v and u v of the scaled points.
    turn : tuple of float
        Cosine and sine of the turn of (w, r), and the mean squares of the two then.
    fit : tuple of float
        Mean square of z; its regression on w and r, and the mean square that this leaves.
    """
    n = uv.shape[1]
    uu = vv = 0.0
    for i in range(n):
        uu += uv[0, i] * uv[0, i]
        vv += uv[1, i] * uv[1, i]
    scales = math.sqrt(uu / n), math.sqrt(vv / n)
    by_u, by_v = 1.0 / scales[0], 1.0 / scales[1]
    uuu = uuv = uvv = vvv = both = 0.0
    for i in range(n):
        u, v = uv[0, i] * by_u, uv[1, i] * by_v
        uuu += u * u * u
        uuv += u * u * v
        uvv += u * v * v
        vvv += v * v * v
        both += u * v
    linear = uuu / n, uuv / n, uvv / n, vvv / n, both / n
    left = np.empty((3, n))
    cos, sin = _left(uv, (by_u, by_v), linear, left)
    z, w, r = left[0], left[1], left[2]
    zz = ww = rr = zw = zr = 0.0
    for i in range(n):
        wi, ri = w[i] * cos + r[i] * sin, r[i] * cos - w[i] * sin
        w[i], r[i] = wi, ri
        zz += z[i] * z[i]
        ww += wi * wi
        rr += ri * ri
        zw += z[i] * wi
        zr += z[i] * ri
    z_u, z_v = 0.5 * (linear[0] + linear[2]), 0.5 * (linear[1] + linear[3])
    least = NOTHING * 4.0 * (zz + n * (1.0 + z_u * z_u + z_v * z_v))
    ww, rr = above(ww, least), above(rr, least)
    on_w = zw / ww if ww > 0.0 else 0.0
    on_r = zr / rr if rr > 0.0 else 0.0
    off = 0.0
    for i in range(n):
        rest = z[i] - on_w * w[i] - on_r * r[i]
        off += rest * rest
    return scales, linear, (cos, sin, ww / n, rr / n), (zz / n, on_w, on_r, above(off, least) / n)


@compiled_later
def _left(uv: Values, by: tuple[float, float], linear: Linear, left: Values) -> tuple[float, float]:
    """Write z, w and r less what is linear in them; return the turn that parts w and r.

    ``by`` scales u and v; ``left``, shape (3, N), takes z, w and r.
    """
    (by_u, by_v), (z, w, r) = by, (left[0], left[1], left[2])
    uuu, uuv, uvv, vvv, both = linear
    z_u, z_v, w_u, w_v = 0.5 * (uuu + uvv), 0.5 * (uuv + vvv), 0.5 * (uuu - uvv), 0.5 * (uuv - vvv)
    ww = wr = rr = 0.0
    for i in range(uv.shape[1]):
        u, v = uv[0, i] * by_u, uv[1, i] * by_v
        z[i] = 0.5 * (u * u + v * v) - 1.0 - z_u * u - z_v * v
        wi = 0.5 * (u * u - v * v) - w_u * u - w_v * v
        ri = u * v - both - uuv * u - uvv * v
        w[i], r[i] = wi, ri
        ww += wi * wi
        wr += wi * ri
        rr += ri * ri
    turn = 0.5 * math.atan2(2.0 * wr, ww - rr)
    return math.cos(turn), math.sin(turn)


@compiled_later
def least_bend(
    ww: float, rr: float, zz: float, on_w: float, on_r: float, off: float
) -> tuple[float, float]:
    """Return what of w and r the direct fit takes off z; the arguments as `quadratics` has them.

    The fit's eigenvalue is the greatest root lambda of
    lambda (1 - on_w**2 ww / (ww + lambda) - on_r**2 rr / (rr + lambda)) = off, whose left side is
    convex: Newton's method comes down to it from zz or a nearer bound.
    """
    bent = 1.0 - on_w * on_w - on_r * on_r
    value = off / bent if off < bent * zz else zz
    by_w, by_r = on_w, on_r
    for _ in range(60):
        if value > 0.0:
            by_w, by_r = on_w * (ww / (ww + value)), on_r * (rr / (rr + value))
        slope = 1.0 - by_w * by_w - by_r * by_r
        if not slope > 0.0:
            break
        following = value - (value * (1.0 - on_w * by_w - on_r * by_r) - off) / slope
        if not 0.0 <= following < value:
            break
        value = following
    return by_w, by_r


@compiled_later
def direct_shape(uv: Values) -> tuple[int, float, float, float, float, float]:
    """Return a status, and centre (u, v), half axes and angle of the direct fit to framed points.

    The conic is z + q w + s r + a linear part, whose 4 A C - B**2 is 1 - q**2 - s**2: it is
    an ellipse inside the unit circle of (q, s), and the fit is the least mean square over that.
    Every affine map of the points maps the ellipse alike, so scaling costs nothing.
    """
    (along, across), (uuu, uuv, uvv, vvv, both), (cos, sin, ww, rr), (zz, on_w, on_r, off) = (
        quadratics(uv)
    )
    by_w, by_r = least_bend(ww, rr, zz, on_w, on_r, off)
    bent = 1.0 - by_w * by_w - by_r * by_r
    if not bent > 4.0 * FLATTEST * FLATTEST:  # a parabola, or a pair of lines
        return OTHER_CONIC, 0.0, 0.0, 0.0, 0.0, 0.0
    if off == 0.0 and (ww == 0.0 or rr == 0.0):  # there are other conics through all points
        return FEW_PLACES, 0.0, 0.0, 0.0, 0.0, 0.0
    q, s = by_r * sin - by_w * cos, -by_w * sin - by_r * cos
    d = -0.5 * (uuu + uvv + q * (uuu - uvv)) - s * uuv
    e = -0.5 * (uuv + vvv + q * (uuv - vvv)) - s * uvv
    u, v = (s * e - (1.0 - q) * d) / bent, (s * d - (1.0 + q) * e) / bent
    # Of the centre: the mean of the quadratic part about it, so always > 0.
    level = 1.0 + s * both + 0.5 * ((1.0 + q) * u * u + (1.0 - q) * v * v) + s * u * v
    a, b, c = 0.5 * (1.0 + q) / along**2, s / (along * across), 0.5 * (1.0 - q) / across**2
    large = 0.5 * (a + c) + 0.5 * math.hypot(a - c, b)
    small = 0.25 * bent / (along * across) ** 2 / large  # without cancellation
    first, second = math.sqrt(level / small), math.sqrt(level / large)
    if not second > FLATTEST * first:
        return FLAT, 0.0, 0.0, 0.0, 0.0, 0.0
    return OK, along * u, across * v, first, second, 0.5 * math.atan2(-b, c - a)


@compiled_later
def ellipse_frame(xy: Values) -> tuple[int, Values, Frame]:
    """Return what `into_frame` does, but that points at fewer than 5 places are refused."""
    status, uv, frame = into_frame(xy)
    if status != OK:
        return status, uv, frame
    places = np.empty((PLACES, 2))
    found = 0
    for i in range(xy.shape[0]):
        known = False
        for k in range(found):
            known |= places[k, 0] == xy[i, 0] and places[k, 1] == xy[i, 1]
        if not known:
            places[found, 0], places[found, 1] = xy[i, 0], xy[i, 1]
            found += 1
            if found == PLACES:
                return OK, uv, frame
    return FEW_PLACES, uv, frame


@compiled_later
def in_pad(
    frame: Frame, ellipse: tuple[float, float, float, float, float], rms: float, rounds: int
) -> Found:
    """Return in pad coordinates an ellipse found in the frame of `ellipse_frame`.

    ``ellipse`` is its centre (u, v), its half axes and the angle of the first.
    """
    x, y, unit, cos, sin = frame
    u, v, a, b, angle = ellipse
    # v runs as y does, down, in the frame: as seen its angles run the other way.
    seen = -(angle + math.atan2(sin, cos))
    x, y = x + unit * (u * cos - v * sin), y + unit * (u * sin + v * cos)
    return OK, x, y, unit * a, unit * b, seen, unit * rms, rounds


@compiled_later
def direct_fit(xy: Values) -> Found:
    """Return the direct ellipse of points, shape (N, 2), in cm, and 0 rounds."""
    status, uv, frame = ellipse_frame(xy)
    if status != OK:
        return status, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0
    status, u, v, a, b, angle = direct_shape(uv)
    if status != OK:
        return status, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0
    off = distances(uv, u, v, a, b, angle)
    total = 0.0
    for i in range(off.shape[0]):
        total += off[i] * off[i]
    return in_pad(frame, (u, v, a, b, angle), math.sqrt(total / off.shape[0]), 0)
