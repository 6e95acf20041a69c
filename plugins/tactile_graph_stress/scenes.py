"""Points, masks and images to begin with, all drawn from a seed."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

Values = NDArray[np.float64]

TILT_RAD = math.radians(25.0)
CENTRE = (10.4, 9.1)


def arc(degrees: float, n: int = 24, radius: float = 4.5) -> Values:
    """Return points on an arc around `CENTRE`, shape (n, 2)."""
    t = math.radians(40.0) + np.linspace(0.0, math.radians(degrees), n, endpoint=degrees < 360.0)
    return np.column_stack([CENTRE[0] + radius * np.cos(t), CENTRE[1] - radius * np.sin(t)])


def ellipse(aspect: float = 1.6, degrees: float = 360.0, n: int = 24) -> Values:
    """Return points on an ellipse of half axes 5 and 5 / aspect, tilted, around `CENTRE`."""
    t = math.radians(7.0) + np.linspace(0.0, math.radians(degrees), n, endpoint=degrees < 360.0)
    return _placed(np.column_stack([5.0 * np.cos(t), 5.0 / aspect * np.sin(t)]))


def rectangle(aspect: float = 1.8, n: int = 40) -> Values:
    """Return points on the outline of a rectangle of length 8, corners among them."""
    length, breadth = 8.0, 8.0 / aspect
    per_side = n // 4
    t = np.arange(per_side) / per_side - 0.5
    one = np.ones(per_side)
    u = np.concatenate([length * t, 0.5 * length * one, -length * t, -0.5 * length * one])
    v = np.concatenate([-0.5 * breadth * one, breadth * t, 0.5 * breadth * one, -breadth * t])
    return _placed(np.column_stack([u, v]))


def cloud(rng: np.random.Generator, aspect: float = 1.6, n: int = 60) -> Values:
    """Return points all over an ellipse."""
    r, t = 5.0 * np.sqrt(rng.random(n)), 2.0 * math.pi * rng.random(n)
    return _placed(np.column_stack([r * np.cos(t), r / aspect * np.sin(t)]))


def _placed(uv: Values) -> Values:
    cos, sin = math.cos(TILT_RAD), math.sin(TILT_RAD)
    # Counter-clockwise as seen, with y running down.
    turned = uv @ np.array([[cos, -sin], [sin, cos]])
    return np.asarray(turned * (1.0, 1.0) + CENTRE)


def noisy(xy: Values, rng: np.random.Generator, sigma: float = 0.05) -> Values:
    """Return points with noise of standard deviation ``sigma``."""
    return np.asarray(xy + sigma * rng.standard_normal(xy.shape))


def blob(rows: int = 16, columns: int = 16, aspect: float = 2.0) -> NDArray[np.bool_]:
    """Return the cells of a tilted ellipse."""
    y, x = np.mgrid[0:rows, 0:columns]
    dx, dy = x - 0.5 * columns + 0.3, y - 0.5 * rows + 0.7
    cos, sin = math.cos(TILT_RAD), math.sin(TILT_RAD)
    u, v = dx * cos - dy * sin, dx * sin + dy * cos
    half = 0.4 * min(rows, columns)
    return np.asarray((u / half) ** 2 + (v * aspect / half) ** 2 <= 1.0)


def load(rng: np.random.Generator, rows: int = 8, columns: int = 8) -> Values:
    """Return a block on an empty pad, with noise, in volts of 0 to about 0.2."""
    values = 0.002 * rng.random((rows, columns))
    values[rows // 4 : -(rows // 4) or None, columns // 4 : -(columns // 4) or None] += 0.15
    return np.asarray(values + 0.02 * rng.random((rows, columns)))
