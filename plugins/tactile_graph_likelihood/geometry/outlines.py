"""Outlines as plain numbers for the kernels: what kind, how many numbers, and back to shapes.

| kind        | numbers                                                         |
|-------------|-----------------------------------------------------------------|
| `DISC`      | centre x and y, radius                                          |
| `ELLIPSE`   | centre, two half axes, angle of the first                       |
| `RECTANGLE` | centre, two half sides, angle of the first                      |
| `REGULAR`   | centre, distance of the corners, angle of the first corner      |
| `FREE`      | x and y of each corner, counter-clockwise as (x, y) are plotted |
| `OVAL`      | an ellipse as it is searched for, see `oval`                    |

Lengths in cm, angles in radians counter-clockwise as seen.
"""

from __future__ import annotations

import math
from typing import TypeAlias

import numpy as np
from numpy.typing import NDArray

from tactile_graph.compiled import compiled_as_is
from tactile_graph.wires import Circle, Ellipse, Polygon, Rectangle, Shape
from tactile_graph_likelihood.geometry.lengths import length
from tactile_graph_likelihood.geometry.oval import as_ellipse

Values: TypeAlias = NDArray[np.float64]

DISC, ELLIPSE, RECTANGLE, REGULAR, FREE, OVAL = range(6)


@compiled_as_is
def unknowns(kind: int, corners: int) -> int:
    """Return how many numbers make an outline."""
    if kind == DISC:
        return 3
    if kind == REGULAR:
        return 4
    return 2 * corners if kind == FREE else 5


@compiled_as_is
def sizes(kind: int) -> int:
    """Return how many of the numbers, from the third on, are lengths."""
    if kind == FREE:
        return 0
    return 1 if kind in (DISC, REGULAR, OVAL) else 2


@compiled_as_is
def period(kind: int, corners: int) -> float:
    """Return the turn that brings the set of outlines back onto itself; 0 without an angle.

    A quarter turn for rectangles and ellipses: one that is turned by it is the same outline with
    its two sizes exchanged.
    """
    if kind in (ELLIPSE, RECTANGLE):
        return 0.5 * math.pi
    return 2.0 * math.pi / corners if kind == REGULAR else 0.0


@compiled_as_is
def corners_of(kind: int, corners: int, p: Values) -> Values:
    """Return the corners of an outline that has any, shape (N, 2), in cm."""
    if kind == FREE:
        return p[: 2 * corners].copy().reshape((corners, 2))
    xy = np.empty((4 if kind == RECTANGLE else corners, 2))
    x, y = p[0], p[1]
    if kind == RECTANGLE:
        cos, sin = math.cos(p[4]), math.sin(p[4])
        ux, uy, vx, vy = p[2] * cos, -p[2] * sin, -p[3] * sin, -p[3] * cos
        xy[0, 0], xy[0, 1] = x + ux + vx, y + uy + vy
        xy[1, 0], xy[1, 1] = x - ux + vx, y - uy + vy
        xy[2, 0], xy[2, 1] = x - ux - vx, y - uy - vy
        xy[3, 0], xy[3, 1] = x + ux - vx, y + uy - vy
        return xy
    for k in range(corners):
        turn = p[3] + 2.0 * math.pi * k / corners
        xy[k, 0], xy[k, 1] = x + p[2] * math.cos(turn), y - p[2] * math.sin(turn)
    return xy


@compiled_as_is
def bounds(kind: int, corners: int, p: Values) -> tuple[float, float, float, float]:
    """Return the left, top, right and bottom of an outline, in cm."""
    if kind == OVAL:
        p = as_ellipse(p)
    if kind in (DISC, ELLIPSE, OVAL):
        wide = high = p[2]
        if kind != DISC:
            cos, sin = math.cos(p[4]), math.sin(p[4])
            wide, high = length(p[2] * cos, p[3] * sin), length(p[2] * sin, p[3] * cos)
        return p[0] - wide, p[1] - high, p[0] + wide, p[1] + high
    if kind == RECTANGLE:
        cos, sin = abs(math.cos(p[4])), abs(math.sin(p[4]))
        wide, high = p[2] * cos + p[3] * sin, p[2] * sin + p[3] * cos
        return p[0] - wide, p[1] - high, p[0] + wide, p[1] + high
    xy = corners_of(kind, corners, p)
    left = right = xy[0, 0]
    top = bottom = xy[0, 1]
    for k in range(1, xy.shape[0]):
        left, right = min(left, xy[k, 0]), max(right, xy[k, 0])
        top, bottom = min(top, xy[k, 1]), max(bottom, xy[k, 1])
    return left, top, right, bottom


def packed(shape: Shape) -> tuple[int, int, Values]:
    """Return a shape as kind, number of corners (0 where it has a closed form) and its numbers."""
    if isinstance(shape, Circle):
        return DISC, 0, np.array([shape.x_cm, shape.y_cm, shape.radius_cm])
    if isinstance(shape, Ellipse):
        halves = (shape.semi_major_cm, shape.semi_minor_cm)
        return ELLIPSE, 0, np.array([shape.x_cm, shape.y_cm, *halves, shape.angle_rad])
    if isinstance(shape, Rectangle):
        halves = (0.5 * shape.length_cm, 0.5 * shape.breadth_cm)
        return RECTANGLE, 0, np.array([shape.x_cm, shape.y_cm, *halves, shape.angle_rad])
    return FREE, shape.count, np.array(shape.xy_cm, dtype=np.float64).ravel()


def unpacked(kind: int, corners: int, p: Values) -> Shape:
    """Return the shape that numbers stand for; the longer of two sizes comes first."""
    if kind == DISC:
        return Circle(float(p[0]), float(p[1]), float(p[2]))
    if kind in (REGULAR, FREE):
        return Polygon(corners_of(kind, corners, p))
    first, second, angle = ordered(p)
    x, y = float(p[0]), float(p[1])
    if kind == ELLIPSE:
        return Ellipse(x, y, first, second, angle)
    return Rectangle(x, y, 2.0 * first, 2.0 * second, angle)


def ordered(p: Values) -> tuple[float, float, float]:
    """Return the longer half, the shorter, and the longer's angle in (-pi/2, pi/2]."""
    first, second, angle = float(p[2]), float(p[3]), float(p[4])
    if second > first:
        first, second, angle = second, first, angle + 0.5 * math.pi
    angle = math.remainder(angle, math.pi)
    return first, second, angle if angle > -0.5 * math.pi else 0.5 * math.pi


def as_ellipse_of_disc(disc: Values) -> Values:
    """Return the numbers of an ellipse that is a disc, and what follows them."""
    return np.concatenate([disc[:3], disc[2:3], [0.0], disc[3:]])
