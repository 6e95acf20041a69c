"""Shared by the hulls' tests: random sets of every awkward kind, and an exact hull to compare."""

from __future__ import annotations

from fractions import Fraction

import numpy as np

from tactile_graph.wires import Points

KINDS = 9


def random_set(rng, kind):
    """Up to 40 points: lattices, floats, lines, circles, duplicates, offsets, odd scales."""
    n = int(rng.integers(1, 40))
    if kind == 0:
        xy = rng.integers(0, 6, (n, 2)).astype(float)
    elif kind == 1:
        xy = (rng.integers(0, 16, (n, 2)) + 0.5) * 0.65 + rng.random(2)
    elif kind == 2:
        xy = rng.random((n, 2))
    elif kind == 3:
        xy = rng.integers(0, 9, n)[:, None] * 0.1 * np.array([3.0, 0.7]) + 0.3
    elif kind == 4:
        angle = rng.random(n) * 7.0
        xy = np.column_stack([np.cos(angle), np.sin(angle)]) * 100.0 + 1e6
    elif kind == 5:
        xy = rng.integers(0, 16, (n, 2)) * 0.1 @ np.array([[0.6, 0.8], [-0.8, 0.6]]) + 5.0
    elif kind == 6:
        xy = rng.standard_normal((n, 2)) * 10.0 ** rng.integers(-12, 12)
        xy = xy[rng.integers(0, n, n)]
    elif kind == 7:
        xy = np.round(rng.random((n, 2)), 1) * np.array([1.0, 1e-9]) + 1e3
    else:  # neighbouring doubles around the diagonal, where rounding decides if anything does
        xy = 0.5 + rng.integers(0, 12, (n, 2)) * 2.0**-53
    # Never written to, as a step's points are: arrays that may be are compiled for once more.
    return Points(np.ascontiguousarray(xy)).xy_cm


def exact_turn(a, b, c):
    """The sense of a -> b -> c as seen (y runs down), in fractions."""
    (ax, ay), (bx, by), (cx, cy) = ([Fraction(v) for v in p] for p in (a, b, c))
    cross = (bx - ax) * (cy - ay) - (by - ay) * (cx - ax)
    return (cross < 0) - (cross > 0)


def exact_hull(xy):
    """Corners of the exact hull by gift wrapping in fractions: slow, and in another way."""
    points = sorted({(float(x), float(y)) for x, y in xy})
    corners = [points[0]]
    while len(points) > 1:
        last, best = corners[-1], None
        for p in points:
            if p == last:
                continue
            turn = 0 if best is None else exact_turn(last, best, p)
            if best is None or turn < 0 or (turn == 0 and _further(last, p, best)):
                best = p
        if best == corners[0]:
            break
        corners.append(best)
    return np.array(corners)


def _further(start, p, q):
    def squared(r):
        return sum((Fraction(v) - Fraction(s)) ** 2 for v, s in zip(r, start, strict=True))

    return squared(p) > squared(q)
