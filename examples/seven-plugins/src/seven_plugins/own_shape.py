"""Step ``stroke``: a shape of one's own, a finger's stroke with its direction.

Run by:
    tactile-graph run stroke-demo --frames 3 --plot stroke.png
"""

import math
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import ClassVar

import numpy as np
from numpy.typing import NDArray

from tactile_graph import Degenerate, Points, hookimpl


@hookimpl
def tactile_graph_steps() -> Mapping[str, str]:
    """Offer the fitter."""
    return {"stroke": f"{__name__}:stroke"}


@hookimpl
def tactile_graph_pipelines() -> Mapping[str, Path]:
    """Offer a pipeline that shows it at work."""
    return {"stroke-demo": Path(__file__).parent / "pipelines" / "stroke-demo.yaml"}


@dataclass(frozen=True)
class Stroke:
    """An open line between two ends; x right, y down, the angle counter-clockwise from +x."""

    x_cm: float
    y_cm: float
    length_cm: float
    angle_deg: float
    columns_shown: ClassVar[tuple[str, ...]] = ("x_cm", "y_cm", "length_cm", "angle_deg")
    outline_closed: ClassVar[bool] = False

    def outline_cm(self) -> NDArray[np.float64]:
        """Return its ends, shape (2, 2): pictures draw it by this."""
        angle = math.radians(self.angle_deg)
        half = np.array([math.cos(angle), -math.sin(angle)]) * self.length_cm / 2
        return np.array([self.x_cm, self.y_cm]) + np.stack([-half, half])


def stroke(points: Points) -> Stroke:
    """Return the principal axis of points, as long as they reach; two must differ."""
    xy = np.asarray(points.xy_cm)
    if len(xy) < 2 or not np.isfinite(xy).all() or not np.abs(np.ptp(xy, axis=0)).max() < 1e100:
        raise Degenerate("a stroke wants two points or more, at places that are numbers")
    middle = xy.mean(axis=0)
    axis = np.linalg.svd(xy - middle, full_matrices=False)[2][0]
    reach = (xy - middle) @ axis
    x, y = middle + axis * (reach.min() + reach.max()) / 2
    angle = 90.0 - (90.0 + math.degrees(math.atan2(axis[1], axis[0]))) % 180.0  # in (-90, 90]
    return Stroke(float(x), float(y), float(np.ptp(reach)), angle)
