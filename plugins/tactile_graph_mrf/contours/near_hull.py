"""Step ``near_hull``: those of many points that lie on, or just within, their convex hull."""

from __future__ import annotations

from typing import Annotated

import numpy as np
from annotated_types import Ge

from tactile_graph.wires import Points, Polygon


def near_hull(points: Points, hull: Polygon, *, within_cm: Annotated[float, Ge(0)] = 0.5) -> Points:
    """Return the points that lie no farther than a distance from a hull's outline.

    A hull's corners alone say little of a straight side, and all points say too much: voids at
    an object's edge leave bays that are no part of its outline.

    Parameters
    ----------
    points : Points
    hull : Polygon
        Convex hull of the points.
    within_cm : float
        Farthest that a point may lie from the hull.

    Returns
    -------
    Points
        In their order.
    """
    size = float(np.abs(points.xy_cm).max(initial=0.0)) or 1.0  # of any size, squares stay finite
    xy, corners = points.xy_cm / size, hull.xy_cm / size
    distance = np.full(len(xy), np.inf)
    for start, end in zip(corners, np.roll(corners, -1, axis=0), strict=True):
        along, off = end - start, xy - start
        length = float(along @ along)
        share = np.clip(off @ along / length, 0.0, 1.0) if length > 0.0 else np.zeros(len(xy))
        np.minimum(distance, np.hypot(*(off - share[:, None] * along).T), out=distance)
    return Points(points.xy_cm[distance <= within_cm / size])
