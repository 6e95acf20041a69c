"""``shape_decision``: whether an outline is a disc, an ellipse, a rectangle or a polygon."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Annotated, Literal, NamedTuple, TypeAlias

import numpy as np
from annotated_types import Ge, Gt, Le
from numpy.typing import NDArray

from tactile_graph.errors import Degenerate
from tactile_graph.wires import Circle, Ellipse, Points, Polygon, Rectangle
from tactile_graph_fitters.fit_circle import fit_circle
from tactile_graph_fitters.fit_ellipse import fit_ellipse
from tactile_graph_fitters.fit_rectangle import fit_rectangle
from tactile_graph_fitters.nearest_on_ellipse import distances
from tactile_graph_fitters.simplify_polygon import SimplifyPolygon

Values: TypeAlias = NDArray[np.float64]
Kind = Literal["disc", "ellipse", "rectangle", "polygon"]
AnyShape: TypeAlias = Circle | Ellipse | Rectangle | Polygon

FLOOR_CELLS = 0.12  # rms distance, in cells, below which closer is not better
PER_CELL = 2.0  # points of the hull's outline, evenly spread, that are compared


class ShapeDecision(NamedTuple):
    """What an outline is, and how sure that is.

    ``confidence`` is that of ``kind``; ``disc``, ``ellipse``, ``rectangle`` and ``polygon`` hold
    that of each and sum to 1. ``corners`` counts those of a rectangle or polygon, 0 for others.
    """

    kind: Kind
    confidence: float
    shape: AnyShape
    corners: int
    disc: float
    ellipse: float
    rectangle: float
    polygon: float


def shape_decision(
    points: Points,
    *,
    cell_cm: Annotated[float, Gt(0)] = 1.3,
    max_corners: Annotated[int, Ge(3), Le(12)] = 6,
    evidence: Annotated[float, Gt(0)] = 0.6,
) -> ShapeDecision:
    """Return the kind of shape that an outline is most likely of, with its confidence.

    Parameters
    ----------
    points : Points
        Of the boundary.
    cell_cm : float
        Pitch of the elements that were read: a cell's length of outline counts as one
        independent measurement.
    max_corners : int
        Polygons of 3 up to so many corners are considered.
    evidence : float
        Independent measurements per cell's length; less makes all confidences more alike.

    Returns
    -------
    ShapeDecision

    Raises
    ------
    Degenerate
        If the points' hull has no area.

    Notes
    -----
    A disc, an ellipse, a rectangle and polygons are fitted to the convex hull of the points,
    its outline evenly sampled. Each is judged by Schwarz' criterion n ln(rms**2 + f**2) + k ln n
    with k unknowns (3, 5, 5 and two a corner), n the outline's length in cells and f = 0.12 cells;
    confidences are the normalised exp(-criterion / 2), a kind of polygon counting by its best
    number of corners. Source: G. Schwarz 1978, 10.1214/aos/1176344136.
    """
    from tactile_graph_hull.hull import hull

    outline = hull(points)
    if outline.count < 3 or outline.area_cm2 <= 0.0:
        raise Degenerate(f"{points.count} points on one line: no shape to decide on")
    xy, length = _evenly(outline.xy_cm, cell_cm / PER_CELL)
    n = max(length / cell_cm * evidence, 2.0)
    found: dict[Kind, tuple[float, AnyShape]] = {}
    for kind, unknowns, shape in _candidates(Points(xy), outline, max_corners, cell_cm):
        off = _off(shape, xy)
        spread = float(off @ off) / len(off) + (FLOOR_CELLS * cell_cm) ** 2
        criterion = n * math.log(spread) + unknowns * math.log(n)
        if kind not in found or criterion < found[kind][0]:
            found[kind] = criterion, shape
    best = min(found, key=lambda kind: found[kind][0])
    weights = {k: math.exp(-0.5 * (c - found[best][0])) for k, (c, _) in found.items()}
    total = sum(weights.values())
    disc, ellipse, rectangle, polygon = (
        weights.get(kind, 0.0) / total for kind in ("disc", "ellipse", "rectangle", "polygon")
    )
    shape = found[best][1]
    corners = shape.count if isinstance(shape, Polygon) else 4 * isinstance(shape, Rectangle)
    return ShapeDecision(
        best, weights[best] / total, shape, corners, disc, ellipse, rectangle, polygon
    )


def _candidates(
    xy: Points, outline: Polygon, max_corners: int, cell_cm: float
) -> list[tuple[Kind, int, AnyShape]]:
    """Return kind, number of unknowns and fit of each shape that can be fitted."""
    fits: list[tuple[Kind, int, Callable[[], AnyShape]]] = [
        ("disc", 3, lambda: fit_circle(xy)),
        ("ellipse", 5, lambda: fit_ellipse(xy)),
        ("rectangle", 5, lambda: fit_rectangle(xy, scale_cm=cell_cm)),
    ]
    for corners in range(3, min(max_corners, outline.count) + 1):
        simplify = SimplifyPolygon(corners=corners)
        fits.append(("polygon", 2 * corners, lambda simplify=simplify: simplify(outline)))  # type: ignore[misc]
    done: list[tuple[Kind, int, AnyShape]] = []
    for kind, unknowns, fit in fits:
        try:
            done.append((kind, unknowns, fit()))
        except Degenerate:
            continue
    return done


def _evenly(corners: Values, step: float) -> tuple[Values, float]:
    """Return points evenly spread over a polygon's outline about ``step`` apart, and its length."""
    closed = np.vstack([corners, corners[:1]])
    sizes = np.hypot(*np.diff(closed, axis=0).T)
    along = np.concatenate([[0.0], np.cumsum(sizes)])
    length = float(along[-1])
    n = max(math.ceil(length / step), 12)
    at = (np.arange(n) + 0.5) * (length / n)
    return np.column_stack([np.interp(at, along, closed[:, k]) for k in (0, 1)]), length


def _off(shape: AnyShape, xy: Values) -> Values:
    """Return the points' distances from a shape's outline."""
    if isinstance(shape, Circle):
        return np.asarray(np.hypot(xy[:, 0] - shape.x_cm, xy[:, 1] - shape.y_cm) - shape.radius_cm)
    if isinstance(shape, Ellipse):
        a, b = shape.semi_major_cm, shape.semi_minor_cm
        # As seen angles run against those of (x, y) with y down.
        return distances(np.ascontiguousarray(xy.T), shape.x_cm, shape.y_cm, a, b, -shape.angle_rad)
    return distance_from_sides(shape.outline_cm(), xy)


def distance_from_sides(corners: Values, xy: Values) -> Values:
    """Return the distances of points, shape (N, 2), from the sides of a polygon."""
    starts, sides = corners, np.roll(corners, -1, axis=0) - corners
    sizes = np.maximum((sides * sides).sum(axis=1), 1e-300)
    off = xy[:, None, :] - starts[None]
    along = np.clip((off * sides).sum(axis=2) / sizes, 0.0, 1.0)
    return np.asarray(np.linalg.norm(off - along[..., None] * sides, axis=2).min(axis=1))
