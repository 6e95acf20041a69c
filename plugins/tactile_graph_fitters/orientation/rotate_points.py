"""``rotate_points``: points turned about a footprint's centre, its major axis brought along x."""

from __future__ import annotations

import math

import numpy as np

from tactile_graph.errors import Degenerate
from tactile_graph.wires import Points
from tactile_graph_fitters.orientation.orientation import Orientation, require_finite


def rotate_points(points: Points, axis: Orientation) -> Points:
    """Return the points turned about the axis' centre so that the axis lies along x.

    Parameters
    ----------
    points : Points
    axis : Orientation
        Its centre stays where it is; as seen, everything turns clockwise by its angle.

    Returns
    -------
    Points
        In pad coordinates but for the turn, in the same order. What is found in them is turned
        back with the same ``axis``, as `fit_ellipse_origin` does.

    Raises
    ------
    Degenerate
        If the axis or the turned points are not finite.

    Notes
    -----
    Thesis 4.3.5, equation 4.6. In pad coordinates, where y runs down, the matrix as printed turns
    clockwise as seen and so brings an axis at theta along x; where y runs up, it takes -theta.
    """
    require_finite(axis)
    cos, sin = math.cos(axis.angle_rad), math.sin(axis.angle_rad)
    xy = points.xy_cm.astype(np.float64, copy=False)
    dx, dy = (xy - (axis.x_cm, axis.y_cm)).T
    # y runs down: what turns clockwise as seen has its signs the other way round.
    turned = np.empty_like(xy)
    turned[:, 0] = axis.x_cm + (dx * cos - dy * sin)
    turned[:, 1] = axis.y_cm + (dx * sin + dy * cos)
    bad = len(turned) - int(np.isfinite(turned).all(axis=1).sum())
    if bad:
        raise Degenerate(f"{bad} of {len(turned)} points are not finite once they are turned")
    return Points(turned)
