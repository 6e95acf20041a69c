"""``hull_qhull``: the convex hull by Qhull, the program whose ancestor the thesis used."""

from __future__ import annotations

from typing import Annotated

import numpy as np
from annotated_types import Ge
from numpy.typing import NDArray

from tactile_graph.wires import Points, Polygon
from tactile_graph_hull.corners import as_points, hull_polygon
from tactile_graph_hull.hull import chain_corners

NEAR = 2.0**-40  # Qhull merges within some dozen units in the last place; this is a wide net


def hull_qhull(points: Points, *, rounding_ulps: Annotated[float, Ge(0)] = 8.0) -> Polygon:
    """Return the smallest convex polygon around the points, found by Qhull.

    Parameters
    ----------
    points : Points
        At least one; duplicates and points in a line are welcome.
    rounding_ulps : float
        As in `hull`.

    Returns
    -------
    Polygon
        The same corners in the same order as `hull` gives.

    Raises
    ------
    Degenerate
        If there are no points, or some are not finite.

    Notes
    -----
    Qhull merges edges that are in one line within its own rounding and refuses flat sets. The
    points near or outside the hull it finds (all points, if it refuses) therefore go through the
    exact chain of `hull` once more. Source: thesis 4.2.8; Barber, Dobkin and Huhdanpaa 1996,
    10.1145/235815.235821.
    """
    return hull_polygon(points.xy_cm, qhull_corners, rounding_ulps)


def qhull_corners(xy: NDArray[np.float64], ulps: float) -> NDArray[np.float64]:
    """Return the hull's corners, shape (K, 2); none if they could not be exact."""
    from scipy.spatial import ConvexHull, QhullError

    if len(xy) < 3 or not np.isfinite(xy).all():
        return chain_corners(xy, ulps)
    low, high = xy.min(axis=0), xy.max(axis=0)
    middle, half = low / 2 + high / 2, float((high / 2 - low / 2).max())
    if not 1e-300 < half < 1e300:
        return chain_corners(xy, ulps)
    scaled = (xy - middle) / half
    try:
        corners = scaled[ConvexHull(scaled).vertices]
    except QhullError:
        return chain_corners(xy, ulps)
    rounding = float(np.abs(xy).max()) / half
    left = xy[_not_inside(scaled, corners, NEAR * (1.0 + rounding))]
    return chain_corners(as_points(left), ulps)


def _not_inside(
    xy: NDArray[np.float64], corners: NDArray[np.float64], near: float
) -> NDArray[np.bool_]:
    """Return which points are outside the polygon or no further than ``near`` inside it.

    A point outside a convex polygon is beyond the edge above or below it, or left or right of
    all: one look at two edges a point is enough.
    """
    start = int(np.lexsort((corners[:, 1], corners[:, 0]))[0])
    ring = np.roll(corners, -start, axis=0)
    if _area(ring) < 0.0:
        ring = np.roll(ring[::-1], 1, axis=0)
    end = int(np.lexsort((ring[:, 1], ring[:, 0]))[-1])
    lower = ring[: end + 1]
    upper = np.vstack([ring[end:], ring[:1]])[::-1]
    x = xy[:, 0]
    outside = (x <= lower[0, 0] + near) | (x >= lower[-1, 0] - near)
    for chain, sign in ((lower, 1.0), (upper, -1.0)):
        k = np.clip(np.searchsorted(chain[:, 0], x) - 1, 0, len(chain) - 2)
        along, offset = chain[k + 1] - chain[k], xy - chain[k]
        cross = along[:, 0] * offset[:, 1] - along[:, 1] * offset[:, 0]
        outside |= sign * cross <= near * np.hypot(along[:, 0], along[:, 1])
    return np.asarray(outside)


def _area(ring: NDArray[np.float64]) -> float:
    following = np.roll(ring, -1, axis=0)
    return 0.5 * float((ring[:, 0] * following[:, 1] - following[:, 0] * ring[:, 1]).sum())
