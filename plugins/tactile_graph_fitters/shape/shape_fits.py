"""How far the outline of a hull is from the best disc, ellipse, rectangle and polygons."""

from __future__ import annotations

import math
from typing import TypeAlias

import numpy as np
from numpy.typing import NDArray

from tactile_graph.compiled import compiled_later
from tactile_graph_fitters.circle.geometric import geometric_fit
from tactile_graph_fitters.circle.principal_axes import into_frame
from tactile_graph_fitters.ellipse.fit_ellipse import refined
from tactile_graph_fitters.ellipse.nearest_on_ellipse import distances
from tactile_graph_fitters.rectangle.fit_rectangle import outline_fit
from tactile_graph_fitters.shape.simplify_polygon import met, thinned

Values: TypeAlias = NDArray[np.float64]

DISC, ELLIPSE, RECTANGLE = range(3)
"""Rows of what `shape_fits` returns; a polygon of k corners stands in row k."""
FEWEST_CORNERS = 3  # of a polygon
FEWEST_POINTS = 12
ROUNDED = 0.5 + 1e-6  # a side of a whole number of half steps is not left to its last bit
NEAR = 1e-4  # of a shape's size, at which a search ends: mean squares grow with its square


@compiled_later
def evenly(corners: Values, step: float) -> tuple[Values, float]:
    """Return points spread over a polygon's sides about ``step`` apart, and the outline's length.

    Each side has its own, evenly around its middle: where the walk begins and which way it goes
    makes no difference. So do sides in a row that are too short for one each, taken together; all
    sides have one where all are.
    """
    count = corners.shape[0]
    sizes, parts = np.empty(count), np.empty(count, np.int64)
    length = 0.0
    for k in range(count):
        m = (k + 1) % count
        sizes[k] = math.hypot(corners[m, 0] - corners[k, 0], corners[m, 1] - corners[k, 1])
        length += sizes[k]
    step = min(step, length / FEWEST_POINTS)
    begin, n = -1, 0
    for k in range(count):
        parts[k] = math.floor(sizes[k] / step + ROUNDED) if sizes[k] > 0.0 else 0
        n += parts[k]
        if parts[k] > 0:
            begin = k
    xy = np.empty((n + count, 2))
    i = done = 0
    while done < count:
        first, sides = (begin + 1 + done) % count, 1
        together, points = sizes[first], parts[first]
        if begin < 0:
            points = 1
        elif points == 0:
            while parts[(first + sides) % count] == 0:
                together += sizes[(first + sides) % count]
                sides += 1
            points = math.floor(together / step + ROUNDED)
        side, before = first, 0.0
        for part in range(points):
            at = (part + 0.5) / points * together
            while at > before + sizes[side] and side != (first + sides - 1) % count:
                before += sizes[side]
                side = (side + 1) % count
            share, m = (part + 0.5) / points, (side + 1) % count
            if sides > 1:
                share = min(max((at - before) / sizes[side], 0.0), 1.0)
            for axis in range(2):
                xy[i, axis] = corners[side, axis] + share * (corners[m, axis] - corners[side, axis])
            i += 1
        done += sides
    return xy[:i].copy(), length


@compiled_later
def squared_from_sides(corners: Values, xy: Values) -> float:
    """Return the mean squared distance of points, shape (N, 2), from the sides of a polygon."""
    count, total = corners.shape[0], 0.0
    for i in range(xy.shape[0]):
        nearest = np.inf
        for k in range(count):
            m = (k + 1) % count
            dx, dy = corners[m, 0] - corners[k, 0], corners[m, 1] - corners[k, 1]
            u, v = xy[i, 0] - corners[k, 0], xy[i, 1] - corners[k, 1]
            along = min(max((u * dx + v * dy) / max(dx * dx + dy * dy, 1e-300), 0.0), 1.0)
            u, v = u - along * dx, v - along * dy
            nearest = min(nearest, u * u + v * v)
        total += nearest
    return float(total / xy.shape[0])


@compiled_later
def _ellipse(xy: Values, found: Values) -> float:
    """Write the nearest ellipse: centre, half axes, angle in x and y; return the mean square.

    The search starts from the ellipse with the points' moments.
    """
    status, uv, frame = into_frame(xy)
    if status != 0:
        return np.inf
    x, y, unit, cos, sin = frame
    n = uv.shape[1]
    uu = vv = 0.0
    for i in range(n):
        uu += uv[0, i] * uv[0, i]
        vv += uv[1, i] * uv[1, i]
    p = np.array([0.0, 0.0, math.sqrt(2.0 * uu / n), math.sqrt(2.0 * vv / n), 0.0])
    _, rounds = refined(uv, p, NEAR)
    if rounds <= 0:
        return np.inf
    off = distances(uv, p[0], p[1], p[2], p[3], p[4])
    found[0] = x + unit * (p[0] * cos - p[1] * sin)
    found[1] = y + unit * (p[0] * sin + p[1] * cos)
    found[2], found[3], found[4] = unit * p[2], unit * p[3], p[4] + math.atan2(sin, cos)
    total = 0.0
    for i in range(n):
        total += off[i] * off[i]
    return float(unit * unit * total / n)


@compiled_later
def _rectangle(xy: Values, scale: float, found: Values) -> float:
    """Write the nearest rectangle: centre, half sides, angle as seen; return the mean square."""
    status, x, y, first, second, angle, _, _ = outline_fit(xy, scale, 2, NEAR)
    if status != 0:
        return np.inf
    found[0], found[1], found[2], found[3], found[4] = x, y, first, second, angle
    cos, sin = math.cos(angle), math.sin(angle)
    corners = np.empty((4, 2))
    for k in range(4):
        a = first if k in (0, 3) else -first
        b = second if k < 2 else -second
        corners[k, 0], corners[k, 1] = x + a * cos - b * sin, y - a * sin - b * cos
    return squared_from_sides(corners, xy)


@compiled_later
def shape_fits(
    corners: Values, step: float, most: int, scale: float
) -> tuple[int, float, Values, Values, Values]:
    """Fit every kind of shape to the outline of a hull.

    Parameters
    ----------
    corners : ndarray, shape (K, 2)
        Of the hull, in order.
    step : float
        Distance of the points of the outline that are compared, in cm.
    most : int
        Polygons of 3 up to so many corners are fitted, of no more than the hull has.
    scale : float
        As `fit_rectangle` takes it.

    Returns
    -------
    n : int
        Points compared.
    length : float
        Of the outline, in cm.
    mean_squares : ndarray, shape (most + 1,)
        Mean squared distance in cm2 from the disc, ellipse and rectangle, then from the polygon of
        as many corners as the index says; infinite where there is no such shape.
    shapes : ndarray, shape (3, 5)
        Disc: centre, radius. Ellipse: centre, half axes, angle in x and y. Rectangle: centre, half
        sides, angle as seen.
    polygons : ndarray, shape (most + 1, most, 2)
        Corners of each polygon.
    """
    xy, length = evenly(corners, step)
    mean_squares = np.full(most + 1, np.inf)
    shapes = np.zeros((3, 5))
    polygons = np.zeros((most + 1, most, 2))
    status, x, y, radius, rms, _ = geometric_fit(xy)
    if status == 0:
        shapes[DISC, 0], shapes[DISC, 1], shapes[DISC, 2] = x, y, radius
        mean_squares[DISC] = rms * rms
    mean_squares[ELLIPSE] = _ellipse(xy, shapes[ELLIPSE])
    mean_squares[RECTANGLE] = _rectangle(xy, scale, shapes[RECTANGLE])
    kept = np.arange(corners.shape[0])
    left = corners.shape[0]
    for count in range(min(most, left), FEWEST_CORNERS - 1, -1):
        left = thinned(corners, kept, left, count, -1.0)
        found = met(corners, kept[:count])
        mean_squares[count] = squared_from_sides(found, xy)
        polygons[count, :count] = found
    return xy.shape[0], length, mean_squares, shapes, polygons
