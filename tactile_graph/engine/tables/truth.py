"""How far a shape that was found is from what truly lay there."""

from __future__ import annotations

import math
from collections.abc import Iterable
from typing import Any

from tactile_graph.pipeline.wiring import arms
from tactile_graph.wires.frame import TrueObject
from tactile_graph.wires.measure import Measure


def shape_kind(kind: Any) -> type | None:
    """Return which shape a type is: the class that says how it is measured; None if it is none."""
    if not isinstance(kind, type) or not hasattr(kind, "error_measures"):
        return None
    return next(c for c in kind.__mro__ if "error_measures" in vars(c))


def measures_of(kind: type) -> tuple[Measure, ...]:
    """Return what of a kind of shape is held against the truth, beside its centre."""
    found: tuple[Measure, ...] = vars(kind)["error_measures"]
    return found


def error_names(kind: Any) -> tuple[str, ...]:
    """Return the names of the errors that values of a type can have; empty if it is no shape."""
    shapes = [s for s in map(shape_kind, arms(kind)) if s is not None]
    measures = dict.fromkeys(m.field for s in shapes for m in measures_of(s))
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
    value : Circle, Ellipse, Rectangle, Polygon or a plugin's own shape
        What was found.
    true : TrueObject
        Of the same kind, as `nearest` gives it. The angle's error is brought into (-90, 90].
    """
    kind = shape_kind(type(value))
    assert kind is not None
    errors = {"centre_cm": _centre_cm(value, true.shape)}
    return errors | {m.field: m.error(value, true.shape) for m in measures_of(kind)}


def _centre_cm(a: Any, b: Any) -> float:
    return math.hypot(a.x_cm - b.x_cm, a.y_cm - b.y_cm)
