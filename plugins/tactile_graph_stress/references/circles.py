"""The circle fits' equations: the geometric one, Kåsa's, Taubin's and the hyper fit."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any

from tactile_graph_stress.references.stationary import Fit, Vector, products, times

Points = Sequence[tuple[Any, Any]]


def _geometric(a: Vector, x: Any, y: Any, n: int) -> Vector:
    """Return one point's part of half the gradient of sum (d - R)**2."""
    from mpmath import sqrt

    dx, dy = x - a[0], y - a[1]
    d = sqrt(dx * dx + dy * dy)
    off = d - a[2]
    return [-off * dx / d, -off * dy / d, -off]


def _kasa(a: Vector, x: Any, y: Any, n: int) -> Vector:
    off = x * x + y * y + a[0] * x + a[1] * y + a[2]
    return [off * x, off * y, off]


def _constrained(hyper: bool) -> Callable[[Vector, Any, Any, int], Vector]:
    """Return the equations (M - eta N) A = 0 with the first of A held at 1."""

    def term(a: Vector, x: Any, y: Any, n: int) -> Vector:
        b, c, d, eta = a
        z = x * x + y * y
        off = z + b * x + c * y + d
        if hyper:
            bound = (8 * z + 4 * (x * b + y * c) + 2 * d, 4 * x + b, 4 * y + c)
        else:
            bound = (4 * z + 2 * (x * b + y * c), 2 * x + b, 2 * y + c)
        rows = [off * row - eta * limit for row, limit in zip((z, x, y), bound, strict=True)]
        return [*rows, off - 2 * eta if hyper else off]

    return term


def _kasa_summed(points: Points) -> Callable[[Vector], Vector]:
    sums = products([[x * x + y * y, x, y, 1] for x, y in points])[1:]
    return lambda a: times(sums, [1, *a])


def _constrained_summed(hyper: bool) -> Callable[[Points], Callable[[Vector], Vector]]:
    def summed(points: Points) -> Callable[[Vector], Vector]:
        sums, n = products([[x * x + y * y, x, y, 1] for x, y in points]), len(points)
        z, x, y, _ = sums[3]

        def total(a: Vector) -> Vector:
            b, c, d, eta = a
            if hyper:
                middle = 8 * z + 4 * (x * b + y * c) + 2 * n * d
                bound = [middle, 4 * x + n * b, 4 * y + n * c, 2 * n]
            else:
                bound = [4 * z + 2 * (x * b + y * c), 2 * x + n * b, 2 * y + n * c, 0]
            found = times(sums, [1, b, c, d])
            return [one - eta * limit for one, limit in zip(found, bound, strict=True)]

        return total

    return summed


def _of_conic(a: Vector) -> Vector:
    from mpmath import sqrt

    x, y = -a[0] / 2, -a[1] / 2
    return [x, y, sqrt(x * x + y * y - a[2])]


def _as_conic(shape: Vector, points: Points) -> Vector:
    x, y, radius = shape
    return [-2 * x, -2 * y, x * x + y * y - radius * radius]


def _with_eta(shape: Vector, points: Points) -> Vector:
    """Return the conic and the multiplier that it would have."""
    b, c, d = _as_conic(shape, points)
    off = sum((x * x + y * y + b * x + c * y + d) ** 2 for x, y in points)
    bound = sum((2 * x + b) ** 2 + (2 * y + c) ** 2 for x, y in points)
    return [b, c, d, off / bound]


def _eta(a: Vector, points: Points) -> Any:
    """Return the multiplier, which is what the constrained fits make least; none is below 0."""
    from mpmath import inf

    return a[3] if a[3] >= 0 else inf


def _distances(a: Vector, points: Points) -> Any:
    from mpmath import hypot

    return sum((hypot(x - a[0], y - a[1]) - a[2]) ** 2 for x, y in points)


def _powers(a: Vector, points: Points) -> Any:
    return sum((x * x + y * y + a[0] * x + a[1] * y + a[2]) ** 2 for x, y in points)


GEOMETRIC = Fit(_geometric, list, lambda shape, points: list(shape), _distances)
KASA = Fit(_kasa, _of_conic, _as_conic, _powers, summed=_kasa_summed)
TAUBIN = Fit(_constrained(False), _of_conic, _with_eta, _eta,
             summed=_constrained_summed(False))  # fmt: skip
HYPER = Fit(_constrained(True), _of_conic, _with_eta, _eta, summed=_constrained_summed(True))
