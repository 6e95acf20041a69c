"""How much of each element an outline covers, exactly."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from tactile_graph.wires import Circle, Ellipse, Rectangle, Shape
from tactile_graph_pads.coverage.ellipse import ellipse_areas
from tactile_graph_pads.coverage.polygon import polygon_areas
from tactile_graph_pads.geometry import Geometry


def coverage_cm2(shape: Shape, geometry: Geometry) -> NDArray[np.float64]:
    """Return the exact area of ``shape`` on each element, shape (rows, columns), in cm^2.

    Closed forms throughout: discs and ellipses by the primitive of the chord, rectangles and
    simple polygons by edge integrals. What lies over the gaps counts nowhere.

    Parameters
    ----------
    shape : Circle, Ellipse, Rectangle or Polygon
        In pad coordinates; it may reach over the edge of the pad.
    geometry : Geometry
        Where the elements are.
    """
    pitch, element = float(geometry.pitch_cm), float(geometry.element_cm)
    rows, columns = geometry.rows, geometry.columns
    if isinstance(shape, Circle):
        radius = float(shape.radius_cm)
        return ellipse_areas(
            float(shape.x_cm), float(shape.y_cm), radius, radius, 0.0, pitch, element, rows, columns
        )
    if isinstance(shape, Ellipse):
        return ellipse_areas(
            float(shape.x_cm),
            float(shape.y_cm),
            float(shape.semi_major_cm),
            float(shape.semi_minor_cm),
            float(shape.angle_rad),
            pitch,
            element,
            rows,
            columns,
        )
    corners = _corners(shape) if isinstance(shape, Rectangle) else np.array(shape.xy_cm, float)
    return polygon_areas(corners, pitch, element, rows, columns)


def _corners(slab: Rectangle) -> NDArray[np.float64]:
    """Return the four corners; in scalars, at a fifth of the time of an outline to draw."""
    cos, sin = math.cos(slab.angle_rad), math.sin(slab.angle_rad)
    ux, uy = 0.5 * slab.length_cm * cos, -0.5 * slab.length_cm * sin
    vx, vy = -0.5 * slab.breadth_cm * sin, -0.5 * slab.breadth_cm * cos
    x, y = slab.x_cm, slab.y_cm
    return np.array(
        [
            (x + ux + vx, y + uy + vy),
            (x - ux + vx, y - uy + vy),
            (x - ux - vx, y - uy - vy),
            (x + ux - vx, y + uy - vy),
        ]
    )
