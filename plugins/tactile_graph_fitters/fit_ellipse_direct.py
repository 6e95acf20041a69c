"""``fit_ellipse_direct``: the algebraic ellipse of Fitzgibbon, made stable by Halíř and Flusser."""

from __future__ import annotations

import math
from typing import TypeAlias

import numpy as np
from numpy.typing import NDArray

from tactile_graph.errors import Degenerate
from tactile_graph.wires import Points
from tactile_graph_fitters.fitted_ellipse import FittedEllipse, in_order
from tactile_graph_fitters.nearest_on_ellipse import distances
from tactile_graph_fitters.principal import NOT_FINITE, OK, OUT_OF_RANGE, Frame, into_frame

Values: TypeAlias = NDArray[np.float64]
Shape: TypeAlias = tuple[float, float, float, float, float]
"""Centre (u, v), the half axes, and the angle of the first, counter-clockwise in (u, v)."""

FLATTEST = 1e-6


def fit_ellipse_direct(points: Points) -> FittedEllipse:
    """Return the ellipse of least squared conic values, the solution of a small eigenproblem.

    Parameters
    ----------
    points : Points
        At least 5 distinct ones, not on a line or two.

    Returns
    -------
    FittedEllipse
        Its ``rms_cm`` is of geometric distances, not of what is minimised.

    Raises
    ------
    Degenerate
        If there are fewer than 5 distinct points, some are not finite, or they lie on a line, on
        two lines, or on a parabola or hyperbola so that no ellipse is left.

    Notes
    -----
    Minimises the sum of (A u**2 + B u v + C v**2 + D u + E v + F)**2 with 4 A C - B**2 = 1, which
    only ellipses meet; points scaled and on main axes. A conic's value grows faster
    outwards than inwards: on noisy short arcs the ellipse comes out too small and too flat.
    Source: Fitzgibbon, Pilu and Fisher 1999, 10.1109/34.765658; Halíř and Flusser 1998, Numerically
    stable direct least squares fitting of ellipses, WSCG.
    """
    xy = np.ascontiguousarray(points.xy_cm, dtype=np.float64)
    uv, frame = framed(xy)
    u, v, a, b, angle = direct_shape(uv)
    off = distances(uv, u, v, a, b, angle)
    rms = math.sqrt(float(off @ off) / len(off))
    return in_pad((u, v, a, b, angle), frame, rms, len(xy), 0)


def framed(xy: Values) -> tuple[Values, Frame]:
    """Return the points (u, v), shape (2, N), centred, scaled and on main axes; the way back.

    Raises
    ------
    Degenerate
        If there are fewer than 5 distinct points, some are not finite, or all are on a line.
    """
    n = len(xy)
    points = "1 point" if n == 1 else f"{n} points"
    status, uv, frame = into_frame(xy)
    if status == OUT_OF_RANGE:  # their squares are no numbers: by a power of two brought nearer 1
        _, exponent = math.frexp(float(np.abs(xy).max()))
        status, uv, (x, y, unit, cos, sin) = into_frame(np.ldexp(xy, -exponent))
        if status == OK:
            x, y, unit = (math.ldexp(v, exponent) for v in (x, y, unit))
            frame = (x, y, unit, cos, sin)
    if status == NOT_FINITE:
        bad = n - int(np.isfinite(xy).all(axis=1).sum())
        raise Degenerate(f"{bad} of {points} not finite: no ellipse fits")
    if status != OK or len(np.unique(xy, axis=0)) < 5:
        raise Degenerate(f"{points}: an ellipse needs at least 5 distinct ones, not on one line")
    return uv, frame


def in_pad(shape: Shape, frame: Frame, rms: float, n: int, rounds: int) -> FittedEllipse:
    """Return an ellipse found in the frame of `framed` in pad coordinates.

    Raises
    ------
    Degenerate
        If a size of it is too large for a number.
    """
    (u, v, a, b, angle), (x, y, unit, cos, sin) = shape, frame
    # v runs as y does, down, in the frame: as seen its angles run the other way.
    seen = -(angle + math.atan2(sin, cos))
    x, y = x + unit * (u * cos - v * sin), y + unit * (u * sin + v * cos)
    if not math.isfinite(x + y + unit * (a + b)):
        raise Degenerate(f"{n} points: their ellipse is too large for a number")
    return in_order(x, y, unit * a, unit * b, seen, unit * rms, n, rounds)


def direct_shape(uv: Values) -> Shape:
    """Return centre, half axes and angle of the direct fit to framed points.

    Raises
    ------
    Degenerate
        If no ellipse is left.
    """
    u, v = uv
    quadratic = np.stack([u * u, u * v, v * v])
    linear = np.stack([u, v, np.ones_like(u)])
    s1, s2, s3 = quadratic @ quadratic.T, quadratic @ linear.T, linear @ linear.T
    back = -np.linalg.solve(s3, s2.T)
    reduced = s1 + s2 @ back
    reduced = np.stack([0.5 * reduced[2], -reduced[1], 0.5 * reduced[0]])
    values, vectors = np.linalg.eig(reduced)
    found = np.real(vectors)
    bent = 4.0 * found[0] * found[2] - found[1] ** 2
    bent[np.abs(np.imag(values)) > 1e-8 * np.abs(values)] = -1.0
    if not (bent > 0.0).any():
        raise Degenerate(f"{len(u)} points: no ellipse is near them, but another conic")
    # Several only by rounding, where the points are on an ellipse: the one they are on.
    first = found[:, np.where(bent > 0.0, np.abs(values), np.inf).argmin()]
    return _shape(*first.tolist(), *(back @ first).tolist())


def _shape(a: float, b: float, c: float, d: float, e: float, f: float) -> Shape:
    """Return centre, half axes and angle of a conic a u u + b u v + c v v + d u + e v + f = 0."""
    det = 4.0 * a * c - b * b
    u, v = (b * e - 2.0 * c * d) / det, (b * d - 2.0 * a * e) / det
    level = -(f + 0.5 * (d * u + e * v))
    middle, off = 0.5 * (a + c), 0.5 * math.hypot(a - c, b)
    large = middle + math.copysign(off, middle)
    small = 0.25 * det / large  # the other eigenvalue, without cancellation
    if not (level / large > 0.0 and level / small > 0.0):
        raise Degenerate("the points lie on no ellipse, but on a conic without a real outline")
    first, second = math.sqrt(level / small), math.sqrt(level / large)
    if not second > FLATTEST * first:
        raise Degenerate("the points lie nearly on one line: no ellipse fits")
    # Main axis of the form's smaller eigenvalue.
    angle = 0.5 * math.atan2(-b, c - a) if middle > 0.0 else 0.5 * math.atan2(b, a - c)
    return u, v, first, second, angle
