"""Shared by the ellipse fits' tests: point sets of every kind."""

from __future__ import annotations

import numpy as np

from helpers_rectangles import turned
from tactile_graph.wires import Points

WELL = ("outline", "arc", "exact", "flat", "far", "cells", "blob")
DEGENERATE = (
    "line", "near line", "parallel lines", "crossing lines", "parabola", "hyperbola", "places",
    "repeated", "grid", "five", "thin cluster",
)  # fmt: skip


def oval(rng, n, degrees=360.0, ratio=(0.2, 1.0), noise=0.0):
    """Points of an ellipse of 4 to 7 cm, anywhere, on an arc."""
    a = rng.uniform(4, 7)
    b = a * rng.uniform(*ratio)
    t = rng.uniform(0, 2 * np.pi) + np.radians(degrees) * rng.random(n)
    xy = turned(np.column_stack([a * np.cos(t), b * np.sin(t)]), rng.uniform(-3, 3))
    return xy + rng.uniform(-12, 12, 2) + rng.normal(0, noise, (n, 2))


def anywhere(rng, u, v):
    """Points turned and moved, in half of the cases: what is level has other rounding."""
    xy = np.column_stack([u, v])
    return turned(xy, rng.uniform(-3, 3)) + rng.uniform(-5, 5, 2) if rng.random() < 0.5 else xy


def cells(rng, broken=0.0):
    """Centres of the boundary's elements of an oval on 16 by 16, a share of which is broken."""
    x, y = np.meshgrid(*[(np.arange(16) + 0.5) * 1.3] * 2)
    cos, sin = np.cos(angle := rng.uniform(0, np.pi)), np.sin(angle)
    x0, y0 = rng.uniform(7, 13, 2)
    u, v = (x - x0) * cos + (y - y0) * sin, (y - y0) * cos - (x - x0) * sin
    on = (u / rng.uniform(4, 8)) ** 2 + (v / rng.uniform(3, 6)) ** 2 < 1
    on = np.pad(on & (rng.random(on.shape) >= broken), 1)
    inner = on[:-2, 1:-1] & on[2:, 1:-1] & on[1:-1, :-2] & on[1:-1, 2:]
    edge = on[1:-1, 1:-1] & ~inner
    return np.column_stack([x[edge], y[edge]])


def drawn(kind, seed):
    """Points, shape (N, 2), of a kind."""
    rng = np.random.default_rng([seed, *kind.encode()])
    n = int(rng.integers(6, 60))
    t = np.linspace(-1.0, 1.0, n)
    match kind:
        case "outline":
            xy = oval(rng, n + 6, noise=10 ** rng.uniform(-6, -0.5))
        case "arc":
            xy = oval(rng, n + 20, rng.uniform(150, 360), noise=10 ** rng.uniform(-6, -1.5))
        case "exact":
            xy = oval(rng, n + 6)
        case "flat":
            xy = oval(rng, n + 20, ratio=(0.01, 0.1), noise=1e-5)
        case "far":
            xy = 10 ** rng.uniform(-9, 9) * (oval(rng, n + 20, noise=0.05) + rng.uniform(-1e5, 1e5))
        case "cells":
            xy = cells(rng)
        case "broken":
            xy = cells(rng, broken=0.08)
        case "blob":
            xy = rng.normal(0, 2, (n + 20, 2))
        case "line":
            xy = np.column_stack([t, [0.0, 1.0, 3.0][seed % 3] * t + rng.normal()])[:: (-1) ** seed]
        case "near line":
            flat = oval(rng, n, noise=0.05)
            xy = (flat - flat.mean(axis=0)) * (1.0, 10.0 ** -rng.integers(8, 16))
        case "parallel lines":
            xy = anywhere(rng, rng.uniform(-2, 2, n), rng.uniform(0.2, 2) * (np.arange(n) % 2))
        case "crossing lines":
            slope = rng.uniform(0.3, 2) * np.where(np.arange(n) % 2, 1, -1)
            xy = anywhere(rng, u := rng.uniform(-2, 2, n), slope * u)
        case "parabola":
            xy = anywhere(rng, t, rng.uniform(0.1, 2) * t * t)
        case "hyperbola":
            xy = anywhere(rng, np.cosh(2 * t), rng.uniform(0.3, 2) * np.sinh(2 * t))
        case "places":
            xy = rng.normal(0, 3, (int(rng.integers(1, 5)), 2))
            xy = xy[rng.integers(0, len(xy), n)]
        case "repeated":
            xy = np.repeat(oval(rng, int(rng.integers(3, 9))), 3, axis=0)
        case "grid":
            xy = rng.integers(-2, 3, (n, 2)).astype(float)
        case "five":
            xy = rng.normal(0, 2, (5, 2))
        case "thin cluster":
            xy = np.array([[-1.0, -1], [1, -1], [1, 1], [-1, 1]])[rng.integers(0, 4, n)]
            xy = anywhere(rng, *(xy + rng.normal(0, 1e-6, xy.shape)).T)
    # Never written to, as a step's points are: arrays that may be are compiled for once more.
    return Points(np.ascontiguousarray(xy, dtype=np.float64)).xy_cm
