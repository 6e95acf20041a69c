"""Truth as JSON: what lay on the pad, a list of objects for each frame."""

from __future__ import annotations

import json
from collections.abc import Sequence
from typing import Any

import numpy as np

from tactile_graph.errors import UsageError, one_of
from tactile_graph.wires import Circle, Ellipse, Polygon, Rectangle, Shape, TrueObject
from tactile_graph.wires.measure import Measured

_FIELDS: dict[str, tuple[type[Circle | Ellipse | Rectangle], tuple[str, ...]]] = {
    "circle": (Circle, ("x_cm", "y_cm", "radius_cm")),
    "ellipse": (Ellipse, ("x_cm", "y_cm", "semi_major_cm", "semi_minor_cm", "angle_rad")),
    "rectangle": (Rectangle, ("x_cm", "y_cm", "length_cm", "breadth_cm", "angle_rad")),
}
Truth = tuple[TrueObject, ...] | None


def _shape_to_json(shape: Shape | Measured) -> dict[str, Any]:
    if isinstance(shape, Polygon):
        return {"kind": "polygon", "xy_cm": shape.xy_cm.tolist()}
    kind = type(shape).__name__.lower()
    if kind not in _FIELDS:
        told = one_of([*_FIELDS, "polygon"])
        raise UsageError(f"a true {type(shape).__name__} cannot be written; what can is: {told}")
    return {"kind": kind, **{f: float(getattr(shape, f)) for f in _FIELDS[kind][1]}}


def _shape_from_json(entry: dict[str, Any]) -> Shape:
    kind = entry["kind"]
    if kind == "polygon":
        corners = np.array(entry["xy_cm"], dtype=np.float64)
        if corners.ndim != 2 or corners.shape[1] != 2 or not np.isfinite(corners).all():
            raise ValueError(f"a polygon's corners have shape {corners.shape}, not (N, 2)")
        return Polygon(corners)
    shape, names = _FIELDS[kind]
    fields = {name: float(entry[name]) for name in names}
    if not np.isfinite(list(fields.values())).all():
        raise ValueError(f"a {kind} with a number that is not finite")
    return shape(**fields)


def truth_to_json(truths: Sequence[Truth]) -> str:
    """Return the truth of frames as a JSON text; null where nobody knows.

    Raises
    ------
    UsageError
        If a true shape is a plugin's own.
    """
    return json.dumps(
        [
            truth
            if truth is None
            else [
                {**_shape_to_json(o.shape), "weight_g": o.weight_g, "name": o.name} for o in truth
            ]
            for truth in truths
        ],
        allow_nan=False,
    )


def truth_from_json(text: str) -> list[Truth]:
    """Return the truth of frames from a JSON text.

    Raises
    ------
    ValueError
        If the text is no list of objects of known kinds with all their fields.
    """
    try:
        frames = json.loads(text)
        return [None if f is None else tuple(_object(entry) for entry in f) for f in frames]
    except (KeyError, TypeError, AttributeError, RecursionError, OverflowError) as error:
        raise ValueError(f"no list of true objects: {error!r}") from error


def _object(entry: dict[str, Any]) -> TrueObject:
    weight = entry.get("weight_g")
    name = entry.get("name", "")
    return TrueObject(_shape_from_json(entry), None if weight is None else float(weight), str(name))
