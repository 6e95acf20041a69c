"""What is compared with the truth: units, what of each shape there is to compare, and its error."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Any, NamedTuple

from tactile_graph.inspect import shape_kind
from tactile_graph.wires.shapes import Circle, Ellipse, Polygon, Rectangle, printed_angle_deg

QUANTITIES: Mapping[str, str] = {
    "centre": "cm",
    "radius": "cm",
    "length": "cm",
    "breadth": "cm",
    "angle": "°",
    "area": "cm²",
    "count": "",
    "identity": "",
}
"""Quantity -> unit, in the order of the tables."""

DECIMALS: Mapping[str, int] = {"cm": 3, "°": 2, "cm²": 2, "": 3}
"""Unit -> decimals that tables show."""


class Measure(NamedTuple):
    """Where a shape has a quantity: in a field, times a factor."""

    field: str
    factor: float = 1.0


MEASURES: Mapping[type, Mapping[str, Measure]] = {
    Circle: {"radius": Measure("radius_cm")},
    Ellipse: {"length": Measure("semi_major_cm", 2.0), "breadth": Measure("semi_minor_cm", 2.0)},
    Rectangle: {"length": Measure("length_cm"), "breadth": Measure("breadth_cm")},
    Polygon: {"area": Measure("area_cm2")},
}
"""What of each kind of shape is compared beside its centre; an ellipse's axes are whole ones."""

WITH_AXIS = (Ellipse, Rectangle)
"""The kinds of shape that have an angle to compare, even with what is of another kind."""


def quantities_of(kind: type) -> tuple[str, ...]:
    """Return the quantities that a kind of shape has."""
    return ("centre", *MEASURES[kind], *(("angle",) if kind in WITH_AXIS else ()))


def distance_cm(a: Any, b: Any) -> float:
    """Return how far apart two centres are."""
    return math.hypot(a.x_cm - b.x_cm, a.y_cm - b.y_cm)


def errors_against(found: Any, true: Any) -> dict[str, float]:
    """Return how far each quantity is off, found less true, of those that both have."""
    errors = {"centre": distance_cm(found, true)}
    if isinstance(true, WITH_AXIS) and hasattr(found, "angle_deg"):
        # An axis has no head: 179 degrees off is 1 degree off.
        errors["angle"] = printed_angle_deg(math.radians(found.angle_deg - true.angle_deg))
    kind = shape_kind(type(found))
    if kind is not None and isinstance(true, kind):
        for quantity, (name, factor) in MEASURES[kind].items():
            errors[quantity] = factor * (float(getattr(found, name)) - float(getattr(true, name)))
    return errors
