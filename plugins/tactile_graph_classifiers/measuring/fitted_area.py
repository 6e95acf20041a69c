"""Step ``fitted_area``: the area of a fitted shape in place of the footprint's."""

from __future__ import annotations

import math
from typing import Annotated

from tactile_graph.errors import Degenerate
from tactile_graph.steps import Quantity
from tactile_graph.wires import Circle, Ellipse, Polygon, Rectangle
from tactile_graph_classifiers.measuring.measurements import Measurements


def fitted_area(
    features: Measurements, shape: Circle | Ellipse | Rectangle | Polygon
) -> Annotated[Measurements, Quantity.like("features")]:
    """Return the features with the area of a shape that was fitted to the object.

    Parameters
    ----------
    features : Measurements
    shape : Circle, Ellipse, Rectangle or Polygon
        As a localiser found it; thesis section 4.4.3 takes the circle's radius for the area.

    Raises
    ------
    Degenerate
        If its area is no finite number.
    """
    area_cm2 = shape.area_cm2
    if not math.isfinite(area_cm2):
        raise Degenerate(f"the area of the fitted shape is {area_cm2:g} cm²")
    return features.replaced("area_cm2", area_cm2)
