"""Fits as roots of equations that sum over points, solved and differentiated to 50 digits.

Where F(a, x) = sum over points of f(a, x_i) = 0 defines the answer a, Newton's method finds it
and the implicit function theorem says how it moves with each coordinate: da = -F_a^-1 F_x dx.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import lru_cache
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

DIGITS = 100  # to work with, so that 50 are right: slopes by differences have half of them
ROUNDS = 30
STEP = 1e-45  # of differences
SETTLED = 1e-50

Vector = list[Any]


@dataclass(frozen=True)
class Fit:
    """A fit by its equations, in a frame where the points have an extent of about 1.

    Parameters
    ----------
    term : callable
        ``term(a, x, y, n)`` gives one of n points' part of the equations.
    shape : callable
        ``shape(a)`` gives x, y, then lengths, then at most one angle (counter-clockwise in
        (x, y), y down) of the answer.
    start : callable
        ``start(shape, xy)`` gives unknowns near the answer of a shape.
    cost : callable
        ``cost(a, points)`` gives what is least at the answer: there are other roots.
    angled : bool
        Whether the last part of the shape is an angle.
    summed : callable, optional
        ``summed(points)`` gives what gives the equations of unknowns, where sums over the points
        that hang on no unknown are taken once.
    """

    term: Callable[[Vector, Any, Any, int], Vector]
    shape: Callable[[Vector], Vector]
    start: Callable[[Vector, Sequence[tuple[Any, Any]]], Vector]
    cost: Callable[[Vector, Sequence[tuple[Any, Any]]], Any]
    angled: bool = False
    summed: Callable[[Sequence[tuple[Any, Any]]], Callable[[Vector], Vector]] | None = None


class Solved(NamedTuple):
    """The right answer, and how it moves with the points.

    Parameters
    ----------
    shape : list of mpf
        x, y, then lengths in cm, then at most one angle, counter-clockwise in (x, y), y down.
    moves : ndarray
        For each part the sum of the sizes of its derivatives by all coordinates; for the angle
        by coordinates in units of ``unit_cm``.
    unit_cm : mpf
    angled : bool
        Whether the last part is an angle.
    """

    shape: Vector
    moves: NDArray[np.float64]
    unit_cm: Any
    angled: bool


def solve(fit: Fit, xy: NDArray[np.float64], starts: Sequence[Vector]) -> Solved | None:
    """Return the answer for points, shape (N, 2): the best of those the starts lead to.

    Parameters
    ----------
    fit : Fit
    xy : ndarray, shape (N, 2)
    starts : sequence of lists
        Shapes in cm, such as ``Fit.shape`` gives.
    """
    from mpmath import mp

    points_cm = np.asarray(xy, dtype=np.float64).tobytes()
    with mp.workdps(DIGITS):
        a = _best(fit, points_cm, starts)
        framed = _points(points_cm)
        return None if a is None or framed is None else _answer(fit, *framed, a)


def shape_of(fit: Fit, xy: NDArray[np.float64], starts: Sequence[Vector]) -> Vector | None:
    """Return the shape alone of what `solve` returns, in less time.

    Parameters
    ----------
    fit, xy, starts
        As of `solve`.
    """
    from mpmath import mp

    points_cm = np.asarray(xy, dtype=np.float64).tobytes()
    with mp.workdps(DIGITS):
        a = _best(fit, points_cm, starts)
        framed = _points(points_cm)
        return None if a is None or framed is None else _placed(fit, fit.shape(a), *framed[1:])


def _best(fit: Fit, points_cm: bytes, starts: Sequence[Vector]) -> Vector | None:
    """Return the unknowns of the best answer that the starts lead to."""
    if _points(points_cm) is None:
        return None
    found = [_rooted(fit, points_cm, tuple(start)) for start in starts]
    roots = [root for root in found if root is not None]
    return min(roots, key=lambda r: r[0])[1] if roots else None


@lru_cache(maxsize=64)
def _points(points_cm: bytes) -> tuple[Sequence[tuple[Any, Any]], Any, Any, Any] | None:
    """Return points in their frame, its middle and its unit; None where all are in one place."""
    from mpmath import mpf

    raw = [(mpf(x), mpf(y)) for x, y in np.frombuffer(points_cm).reshape(-1, 2).tolist()]
    x0, y0 = (sum(p[k] for p in raw) / len(raw) for k in (0, 1))
    unit = max(max(abs(x - x0), abs(y - y0)) for x, y in raw)
    if not unit > 0:
        return None
    return [((x - x0) / unit, (y - y0) / unit) for x, y in raw], x0, y0, unit


@lru_cache(maxsize=1024)
def _rooted(fit: Fit, points_cm: bytes, start: tuple[Any, ...]) -> tuple[Any, Vector] | None:
    """Return a root and its cost, if a start leads to one.

    It is remembered: of the same points several steps ask for the same fit.
    """
    from mpmath import mpf

    framed = _points(points_cm)
    assert framed is not None
    points, x0, y0, unit = framed
    shape = _framed(fit, [mpf(v) for v in start], x0, y0, unit)
    try:
        a = _root(fit, points, fit.start(shape, points))
    except (ZeroDivisionError, ValueError):
        return None
    return None if a is None else (fit.cost(a, points), a)


def _framed(fit: Fit, shape: Vector, x0: Any, y0: Any, unit: Any) -> Vector:
    last = len(shape) - 1 if fit.angled else len(shape)
    middle = [v / unit for v in shape[2:last]]
    return [(shape[0] - x0) / unit, (shape[1] - y0) / unit, *middle, *shape[last:]]


def _placed(fit: Fit, shape: Vector, x0: Any, y0: Any, unit: Any) -> Vector:
    last = len(shape) - 1 if fit.angled else len(shape)
    placed = [shape[0] * unit + x0, shape[1] * unit + y0, *(v * unit for v in shape[2:last])]
    return [*placed, *shape[last:]]


def _equations(fit: Fit, points: Sequence[tuple[Any, Any]]) -> Callable[[Vector], Vector]:
    if fit.summed is not None:
        return fit.summed(points)
    n = len(points)

    def total(a: Vector) -> Vector:
        parts = [fit.term(a, x, y, n) for x, y in points]
        return [sum(column) for column in zip(*parts, strict=True)]

    return total


def products(rows: Sequence[Vector]) -> list[Vector]:
    """Return the sums of all products of two numbers of a row."""
    size = range(len(rows[0]))
    return [[sum(row[i] * row[k] for row in rows) for k in size] for i in size]


def times(square: Sequence[Vector], a: Sequence[Any]) -> Vector:
    """Return a matrix times numbers."""
    return [sum(v * number for v, number in zip(row, a, strict=True)) for row in square]


def _slopes(of: Callable[[Vector], Vector], a: Vector) -> tuple[Vector, Any]:
    """Return a function's value and its matrix of derivatives, by differences."""
    from mpmath import matrix, mpf

    here = of(a)
    slopes = matrix(len(here), len(a))
    for k in range(len(a)):
        h = mpf(STEP) * max(abs(a[k]), mpf(1) / 1000)
        there = of([*a[:k], a[k] + h, *a[k + 1 :]])
        for i in range(len(here)):
            slopes[i, k] = (there[i] - here[i]) / h
    return here, slopes


def _root(fit: Fit, points: Sequence[tuple[Any, Any]], a: Vector) -> Vector | None:
    """Return the unknowns at which the equations hold, by damped steps of Newton's method."""
    from mpmath import lu_solve, matrix, norm

    before, equations = None, _equations(fit, points)
    for _ in range(ROUNDS):
        value, slopes = _slopes(equations, a)
        step = lu_solve(slopes, matrix(value))
        size, extent = norm(step), norm(matrix(a))
        if size > extent:  # far away: no more than as far as everything is large
            step = step * (extent / size)
        a = [v - step[k] for k, v in enumerate(a)]
        if size <= SETTLED * extent:
            return a
        if before is not None and size > 1e6 * before:
            return None
        before = size
    return None


def _answer(
    fit: Fit, points: Sequence[tuple[Any, Any]], x0: Any, y0: Any, unit: Any, a: Vector
) -> Solved:
    from mpmath import lu_solve, matrix, mpf

    n = len(points)
    _, by_unknown = _slopes(_equations(fit, points), a)
    shape, by_shape = _slopes(fit.shape, a)
    columns = matrix(len(a), 2 * n)
    h = mpf(STEP)
    for i, (x, y) in enumerate(points):
        here = fit.term(a, x, y, n)
        for k, there in enumerate((fit.term(a, x + h, y, n), fit.term(a, x, y + h, n))):
            for row in range(len(a)):
                columns[row, 2 * i + k] = (there[row] - here[row]) / h
    moves = np.zeros(len(shape))
    inverse = _inverse(by_unknown, lu_solve)
    total = by_shape * inverse * columns
    for row in range(len(shape)):
        moves[row] = float(sum(abs(total[row, k]) for k in range(2 * n)))
    return Solved(_placed(fit, shape, x0, y0, unit), moves, unit, fit.angled)


def _inverse(square: Any, lu_solve: Any) -> Any:
    from mpmath import matrix

    n = square.rows
    out = matrix(n, n)
    for k in range(n):
        unit = matrix(n, 1)
        unit[k] = 1
        column = lu_solve(square, unit)
        for i in range(n):
            out[i, k] = column[i]
    return out
