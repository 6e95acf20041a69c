"""Step ``fit_circle_median``: a circle that a few wild points do not move, beside ``fit_circle``.

Run by:
    tactile-graph compare circle-1 circle-median --frames 30
"""

from collections.abc import Mapping
from pathlib import Path
from typing import Annotated

import numpy as np
from annotated_types import Ge

from tactile_graph import Circle, Degenerate, Points, hookimpl


@hookimpl
def tactile_graph_steps() -> Mapping[str, str]:
    """Offer the fitter."""
    return {"fit_circle_median": f"{__name__}:fit_circle_median"}


@hookimpl
def tactile_graph_pipelines() -> Mapping[str, Path]:
    """Offer circle-1 with this fitter in the place of its own."""
    return {"circle-median": Path(__file__).parent / "pipelines" / "circle-median.yaml"}


def fit_circle_median(
    points: Points, *, n_triples: Annotated[int, Ge(10)] = 500, rng: np.random.Generator
) -> Circle:
    """Return the median of the circles through random triples of points.

    Centre and radius are medians, each by itself: they stay while a fifth of the points lie off, as
    half of the triples are then of good points alone.

    Parameters
    ----------
    points : Points
        Three or more that do not lie on a line.
    n_triples : int
    rng : numpy.random.Generator
        Seeded by the run.
    """
    xy = np.asarray(points.xy_cm)
    if len(xy) < 3 or not np.abs(xy).max() < 1e100:
        raise Degenerate("a circle wants three points or more, at places that are numbers")
    size = float(np.abs(xy).max()) or 1.0
    a, b, c = (xy[rng.integers(len(xy), size=n_triples)] / size for _ in range(3))
    (bx, by), (cx, cy) = (b - a).T, (c - a).T
    twice_area = bx * cy - by * cx
    sound = np.abs(twice_area) > 1e-6
    if np.count_nonzero(sound) < 10:
        raise Degenerate("the points lie on a line, or are all the same")
    bb, cc, d = bx**2 + by**2, cx**2 + cy**2, np.where(sound, 2 * twice_area, 1.0)
    x, y = (cy * bb - by * cc) / d, (bx * cc - cx * bb) / d
    found = np.array([a[:, 0] + x, a[:, 1] + y, np.hypot(x, y)])[:, sound]
    return Circle(*(size * float(v) for v in np.median(found, axis=1)))
