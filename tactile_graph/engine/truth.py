"""How far a shape that was found is from what truly lay there."""

from __future__ import annotations

import math
from collections.abc import Iterable
from typing import Any

from tactile_graph.pipeline.wiring import arms
from tactile_graph.wires.frame import TrueObject
from tactile_graph.wires.shapes import Circle, Ellipse, Polygon, Rectangle, printed_angle_deg

MEASURES: dict[type, tuple[str, ...]] = {
    Circle: ("radius_cm",),
    Ellipse: ("semi_major_cm", "semi_minor_cm", "angle_deg"),
    Rectangle: ("length_cm", "breadth_cm", "angle_deg"),
    Polygon: ("area_cm2",),
}
"""Beside its centre, what of a shape is compared with the truth."""


def shape_kind(kind: Any) -> type | None:
    """Return which of the shapes a type is; None if it is none."""
    return next((s for s in MEASURES if isinstance(kind, type) and issubclass(kind, s)), None)


def error_names(kind: Any) -> tuple[str, ...]:
    """Return the names of the errors that values of a type can have; empty if it is no shape."""
    shapes = [s for s in map(shape_kind, arms(kind)) if s is not None]
    measures = dict.fromkeys(m for s in shapes for m in MEASURES[s])
    return ("centre_cm", *measures) if shapes else ()


def nearest(value: Any, truth: Iterable[TrueObject] | None) -> TrueObject | None:
    """Return the true object of the value's kind whose centre is nearest; None if none is."""
    kind = shape_kind(type(value))
    if kind is None or truth is None:
        return None
    alike = [t for t in truth if isinstance(t.shape, kind)]
    return min(alike, key=lambda t: _centre_cm(value, t.shape), default=None)


def errors_against(value: Any, true: TrueObject) -> dict[str, float]:
    """Return the distance of the centres, and each measure's error (found minus true).

    Parameters
    ----------
    value : Circle, Ellipse, Rectangle or Polygon
        What was found.
    true : TrueObject
        Of the same kind, as `nearest` gives it. The angle's error is brought into (-90, 90].
    """
    kind = shape_kind(type(value))
    assert kind is not None
    errors = {"centre_cm": _centre_cm(value, true.shape)}
    for name in MEASURES[kind]:
        off = float(getattr(value, name)) - float(getattr(true.shape, name))
        errors[name] = printed_angle_deg(math.radians(off)) if name == "angle_deg" else off
    return errors


def _centre_cm(a: Any, b: Any) -> float:
    return math.hypot(a.x_cm - b.x_cm, a.y_cm - b.y_cm)
