"""Shared by the rectangle and ellipse fits' tests: outlines, footprints, equivariant maps."""

from __future__ import annotations

import math

import numpy as np
from hypothesis import strategies as st

from tactile_graph.wires import Ellipse, Mask, Points, Rectangle

seeds = st.integers(0, 2**32 - 1)


def rectangle_xy(rectangle, n):
    """``n`` points evenly spread over the outline of a rectangle."""
    corners = rectangle.outline_cm()
    closed = np.vstack([corners, corners[:1]])
    along = np.concatenate([[0.0], np.cumsum(np.hypot(*np.diff(closed, axis=0).T))])
    at = (np.arange(n) + 0.5) * along[-1] / n
    return np.column_stack([np.interp(at, along, closed[:, k]) for k in (0, 1)])


def some_rectangle(rng, ratio=(0.2, 0.8)):
    length = rng.uniform(4.0, 12.0)
    return Rectangle(
        float(rng.uniform(-5, 5)),
        float(rng.uniform(-5, 5)),
        float(length),
        float(length * rng.uniform(*ratio)),
        float(rng.uniform(-1.5, 1.5)),
    )


def some_ellipse(rng, ratio=(0.3, 0.85)):
    r = some_rectangle(rng, ratio)
    return Ellipse(r.x_cm, r.y_cm, r.length_cm, r.breadth_cm, r.angle_rad)


def covered(rectangle, shape=(40, 40), pitch=0.5, origin=(0.0, 0.0)):
    """The mask of the cells whose centres lie in a rectangle."""
    x = origin[0] + (np.arange(shape[1]) + 0.5) * pitch
    y = origin[1] + (np.arange(shape[0]) + 0.5) * pitch
    dx, dy = x[None, :] - rectangle.x_cm, rectangle.y_cm - y[:, None]
    cos, sin = math.cos(rectangle.angle_rad), math.sin(rectangle.angle_rad)
    u, v = dx * cos + dy * sin, dy * cos - dx * sin
    inside = (abs(u) <= rectangle.length_cm / 2) & (abs(v) <= rectangle.breadth_cm / 2)
    return Mask(inside, (pitch, pitch), origin)


def off_rad(one, other):
    """How far two axes are apart: modulo half turns."""
    return abs(math.remainder(one - other, math.pi))


def turned(xy, angle):
    """Points turned counter-clockwise as seen about (0, 0)."""
    cos, sin = math.cos(angle), math.sin(angle)
    return np.column_stack([xy[:, 0] * cos + xy[:, 1] * sin, xy[:, 1] * cos - xy[:, 0] * sin])


def points(xy):
    return Points(np.array(xy, dtype=float))
