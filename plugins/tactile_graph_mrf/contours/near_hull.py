"""Step ``near_hull``: those of many points that lie on, or just within, their convex hull."""

from __future__ import annotations

import math
from typing import Annotated

import numpy as np
from annotated_types import Ge

from tactile_graph.errors import RuleError
from tactile_graph.wires import Image, Points, Polygon

USUAL_CM = 0.5
"""How near is near where nobody says; on the thesis' pad 0.385 elements' pitches."""


def near_hull(
    points: Points,
    hull: Polygon,
    elements: Image | None = None,
    *,
    within_cm: Annotated[float | None, Ge(0)] = None,
    within_cells: Annotated[float | None, Ge(0)] = None,
) -> Points:
    """Return the points that lie no farther than a distance from a hull's outline.

    A hull's corners alone say little of a straight side, and all points say too much: voids at
    an object's edge leave bays that are no part of its outline.

    Parameters
    ----------
    points : Points
    hull : Polygon
        Convex hull of the points.
    elements : Image, optional
        What was read, as it was read: not subdivided.
    within_cm : float, optional
        Farthest that a point may lie from the hull; 0.5 if neither is given.
    within_cells : float, optional
        The same in pitches of ``elements``, where ``within_cm`` is not given.

    Returns
    -------
    Points
        In their order.

    Raises
    ------
    RuleError
        If ``within_cells`` counts, and there are no ``elements``.
    """
    within_cm = _within_cm(elements, within_cm, within_cells)
    size = float(np.abs(points.xy_cm).max(initial=0.0)) or 1.0  # of any size, squares stay finite
    xy, corners = points.xy_cm / size, hull.xy_cm / size
    distance = np.full(len(xy), np.inf)
    for start, end in zip(corners, np.roll(corners, -1, axis=0), strict=True):
        along, off = end - start, xy - start
        length = float(along @ along)
        share = np.clip(off @ along / length, 0.0, 1.0) if length > 0.0 else np.zeros(len(xy))
        np.minimum(distance, np.hypot(*(off - share[:, None] * along).T), out=distance)
    return Points(points.xy_cm[distance <= within_cm / size])


near_hull.usual_cm = {"within_cm": USUAL_CM}  # type: ignore[attr-defined]


def _within_cm(
    elements: Image | None, within_cm: float | None, within_cells: float | None
) -> float:
    """Return the distance that was told, in cm."""
    if within_cm is not None or within_cells is None:
        return USUAL_CM if within_cm is None else within_cm
    if elements is None:
        raise RuleError("within_cells: needs the port 'elements', the image that was read")
    x_cm, y_cm = elements.pitch_cm
    return within_cells * (x_cm if x_cm == y_cm else math.sqrt(x_cm * y_cm))
