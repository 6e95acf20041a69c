"""Step ``jitter_points``: every point moved by Gaussian noise of a known size."""

from __future__ import annotations

from typing import Annotated

import numpy as np
from annotated_types import Ge

from tactile_graph.errors import DataError
from tactile_graph.wires import Points


def jitter_points(
    points: Points, *, sd_cm: Annotated[float, Ge(0)] = 0.1, rng: np.random.Generator
) -> Points:
    """Return the points, each moved independently along x and y.

    Parameters
    ----------
    points : Points
    sd_cm : float
        Standard deviation along each of the two.
    rng : numpy.random.Generator

    Raises
    ------
    DataError
        If a coordinate is not finite.
    """
    if not np.isfinite(points.xy_cm).all():
        raise DataError("points", "every coordinate must be a finite number")
    return Points(points.xy_cm + sd_cm * rng.standard_normal(points.xy_cm.shape))
