"""Whether a polygon is the hull of points, decided in whole numbers."""

from __future__ import annotations

import math
from fractions import Fraction

import numpy as np
from numpy.typing import NDArray

Values = NDArray[np.float64]
Place = tuple[Fraction, Fraction]


def hull_error(xy: Values, corners: Values) -> tuple[float, str]:
    """Return how far a point lies outside the polygon, in cm, and what is wrong with it otherwise.

    The corners must be among the points, and turn counter-clockwise as seen at each; both are
    decided without rounding.

    Parameters
    ----------
    xy : ndarray, shape (N, 2)
    corners : ndarray, shape (K, 2)
    """
    points, ring = _exact(xy), _exact(corners)
    reach = max(max(abs(x), abs(y)) for x, y in points)
    slack = reach / 2**50
    for corner in set(ring) - set(points):
        if all(max(abs(corner[0] - x), abs(corner[1] - y)) > slack / 4 for x, y in points):
            return 0.0, "a corner is none of the points"
    n = len(ring)
    if n != len(set(ring)):
        return 0.0, "a corner comes twice"
    for k in range(n if n > 2 else 0):
        if _turn(ring[k - 2], ring[k - 1], ring[k]) <= 0:
            return 0.0, "not strictly convex, or clockwise"
    return max((_outside(ring, p) for p in points), default=0.0), ""


def _exact(xy: Values) -> list[Place]:
    return [(Fraction(float(x)), Fraction(float(y))) for x, y in xy]


def _turn(a: Place, b: Place, c: Place) -> Fraction:
    """Return a number above 0 for a turn counter-clockwise as seen, y running down."""
    return (a[1] - c[1]) * (b[0] - c[0]) - (a[0] - c[0]) * (b[1] - c[1])


def _outside(ring: list[Place], p: Place) -> float:
    """Return how far a point is outside a convex polygon, a line or a point; 0 inside."""
    n = len(ring)
    if n == 1:
        return _length(ring[0][0] - p[0], ring[0][1] - p[1])
    worst = 0.0
    for k in range(n):
        a, b = ring[k - 1], ring[k]
        area = -_turn(a, b, p)
        if n == 2:
            area = abs(area)
        if area > 0:
            dx, dy = b[0] - a[0], b[1] - a[1]
            along = ((p[0] - a[0]) * dx + (p[1] - a[1]) * dy) / (dx * dx + dy * dy)
            beyond = n == 2 and not 0 <= along <= 1
            worst = max(worst, math.inf if beyond else _ratio(area, dx, dy))
    return worst


def _ratio(area: Fraction, dx: Fraction, dy: Fraction) -> float:
    """Return area over length, exact but for the last rounding, at any size."""
    # area**2 / length**2 is a fraction; its root needs no more than doubles once in range.
    square = area * area / (dx * dx + dy * dy)
    return _root(square)


def _length(dx: Fraction, dy: Fraction) -> float:
    return _root(dx * dx + dy * dy)


def _root(square: Fraction) -> float:
    if square == 0:
        return 0.0
    shift = (square.numerator.bit_length() - square.denominator.bit_length()) // 2
    return math.ldexp(math.sqrt(square / Fraction(4) ** shift), shift)
