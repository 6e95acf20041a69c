"""Step ``fit_stroke``: the straight stroke through points."""

import numpy as np
from tactile_graph import Degenerate, Points

from tactile_graph_fingers.stroke import Stroke


def fit_stroke(points: Points) -> Stroke:
    """Return the stroke along the points' principal axis, as long as they reach.

    Raises
    ------
    Degenerate
        If a point is not finite, or the points are fewer than two or all the same.
    """
    xy = np.asarray(points.xy_cm)
    if len(xy) < 2 or not np.abs(xy).max() < 1e100 or (xy == xy[0]).all():
        raise Degenerate("a stroke wants two points that differ")
    middle = xy.mean(axis=0)
    _, _, axes = np.linalg.svd(xy - middle, full_matrices=False)
    along = (xy - middle) @ axes[0]
    start, end = middle + along.min() * axes[0], middle + along.max() * axes[0]
    return Stroke(*map(float, (*start, *end)))
