"""The ellipse fits' equations: the geometric one and the direct one of Fitzgibbon."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from typing import Any

from tactile_graph_stress.references.stationary import Fit, Vector, products, times

Points = Sequence[tuple[Any, Any]]
SETTLED = 1e-55
"""A step of Newton's method after which 100 digits are right: each step doubles them."""


def _geometric(p: Vector, x: Any, y: Any, n: int) -> Vector:
    """Return one point's part of half the gradient of the sum of squared distances."""
    from mpmath import cos_sin

    cos, sin = cos_sin(p[4])
    dx, dy = x - p[0], y - p[1]
    u, v = dx * cos + dy * sin, dy * cos - dx * sin
    a, b = p[2], p[3]
    c, s = cos_sin(_foot(a, b, u, v))
    ru, rv = u - a * c, v - b * s
    return [rv * sin - ru * cos, -ru * sin - rv * cos, -ru * c, -rv * s, ru * v - rv * u]


def _foot(a: Any, b: Any, u: Any, v: Any) -> Any:
    """Return the parameter of the nearest point: found in doubles, settled in all digits."""
    from mpmath import mpf

    fa, fb, fu, fv = float(a), float(b), float(u), float(v)
    starts = [math.atan2(fv / fb, fu / fa), math.atan2(fv * fa, fu * fb)]
    starts += [k * math.pi / 8 for k in range(16)]
    best = min(starts, key=lambda t: math.hypot(fu - fa * math.cos(t), fv - fb * math.sin(t)))
    near = _settled(best, fa * fu, fb * fv, fa * fa - fb * fb, 0.01, 1e-14)
    return _settled(mpf(near), a * u, b * v, a * a - b * b, mpf(1) / 100, SETTLED)


def _settled(t: Any, au: Any, bv: Any, far: Any, otherwise: Any, enough: float) -> Any:
    """Return the parameter of the nearest point by Newton's method, in the digits it is given in.

    Steps are ``otherwise`` where there is no minimum near, and end below ``enough``.
    """
    from mpmath import cos_sin

    for _ in range(60):
        c, s = (math.cos(t), math.sin(t)) if isinstance(t, float) else cos_sin(t)
        slope = au * s - bv * c - far * s * c
        bend = au * c + bv * s - far * (c * c - s * s)
        step = slope / bend if bend > 0 else otherwise
        t -= step
        if abs(step) < enough:
            break
    return t


def _direct(p: Vector, x: Any, y: Any, n: int) -> Vector:
    """Return one point's part of S A = eta C A, with the first and third of A adding to 1."""
    a, b, c, d, e, f, eta = p
    w = (x * x, x * y, y * y, x, y, 1)
    off = a * w[0] + b * w[1] + c * w[2] + d * x + e * y + f
    share = eta / n
    bound = (2 * c * share, -b * share, 2 * a * share, 0, 0, 0)
    return [*(off * w[k] - bound[k] for k in range(6)), (a + c - 1) / n]


def _direct_summed(points: Points) -> Callable[[Vector], Vector]:
    sums = products([[x * x, x * y, y * y, x, y, 1] for x, y in points])

    def total(p: Vector) -> Vector:
        a, b, c, _, _, _, eta = p
        bound = [2 * c * eta, -b * eta, 2 * a * eta, 0, 0, 0]
        found = times(sums, p[:6])
        return [*(one - limit for one, limit in zip(found, bound, strict=True)), a + c - 1]

    return total


def _of_conic(p: Vector) -> Vector:
    """Return centre, half axes (the longer first) and its angle."""
    from mpmath import atan2, sqrt

    a, b, c, d, e, f = p[:6]
    det = 4 * a * c - b * b
    x, y = (b * e - 2 * c * d) / det, (b * d - 2 * a * e) / det
    level = -(f + (d * x + e * y) / 2)
    off = sqrt((a - c) ** 2 + b * b) / 2
    large, small = (a + c) / 2 + off, (a + c) / 2 - off
    return [x, y, sqrt(level / small), sqrt(level / large), atan2(-b, c - a) / 2]


def _as_conic(shape: Vector, points: Points) -> Vector:
    from mpmath import cos_sin

    x, y, first, second, angle = shape
    cos, sin = cos_sin(angle)
    p, q = 1 / (first * first), 1 / (second * second)
    a, b, c = p * cos * cos + q * sin * sin, 2 * (p - q) * sin * cos, p * sin * sin + q * cos * cos
    d, e = -(2 * a * x + b * y), -(b * x + 2 * c * y)
    f = a * x * x + b * x * y + c * y * y - 1
    conic = [v / (a + c) for v in (a, b, c, d, e, f)]
    off = sum(
        (conic[0] * u * u + conic[1] * u * v + conic[2] * v * v + conic[3] * u + conic[4] * v
         + conic[5]) ** 2 for u, v in points)  # fmt: skip
    return [*conic, off / (4 * conic[0] * conic[2] - conic[1] ** 2)]


def _only(p: Vector, points: Points) -> int:
    """Return the same of every root: each search starts at one answer only."""
    return 0


GEOMETRIC = Fit(_geometric, list, lambda shape, points: list(shape), _only, angled=True)
DIRECT = Fit(_direct, _of_conic, _as_conic, _only, angled=True, summed=_direct_summed)
