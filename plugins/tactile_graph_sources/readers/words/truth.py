"""Truth as JSON: what lay on the pad, a list of objects for each frame."""

from __future__ import annotations

import json
import math
from collections.abc import Sequence
from typing import Any

import numpy as np

from tactile_graph.errors import UsageError, did_you_mean, one_of
from tactile_graph.wires import (
    LARGEST,
    Circle,
    Ellipse,
    Polygon,
    Rectangle,
    Shape,
    TrueObject,
)
from tactile_graph.wires.measure import Measured

_FIELDS: dict[str, tuple[type[Circle | Ellipse | Rectangle], tuple[str, ...]]] = {
    "circle": (Circle, ("x_cm", "y_cm", "radius_cm")),
    "ellipse": (Ellipse, ("x_cm", "y_cm", "semi_major_cm", "semi_minor_cm", "angle_rad")),
    "rectangle": (Rectangle, ("x_cm", "y_cm", "length_cm", "breadth_cm", "angle_rad")),
}
_KEYS = {
    "kind",
    "weight_g",
    "name",
    "xy_cm",
    *(f for _, fields in _FIELDS.values() for f in fields),
}
_FORM = 'such as [[{"kind": "circle", "x_cm": 9, "y_cm": 11, "radius_cm": 6}], [], null]'
ANYWHERE = ("x_cm", "y_cm", "angle_rad")
"""Numbers that may be 0 or less."""
MOST_SHOWN = 60
Truth = tuple[TrueObject, ...] | None


def own_shapes(truth: Truth) -> list[str]:
    """Return the types of true shapes that are a plugin's own: there is no JSON of them."""
    return [type(o.shape).__name__ for o in truth or () if not _kind(o.shape)]


def _kind(shape: Shape | Measured) -> str:
    if isinstance(shape, Polygon):
        return "polygon"
    return next((kind for kind, (of, _) in _FIELDS.items() if type(shape) is of), "")


def _shape_to_json(shape: Shape | Measured) -> dict[str, Any]:
    if isinstance(shape, Polygon):
        return {"kind": "polygon", "xy_cm": shape.xy_cm.tolist()}
    kind = _kind(shape)
    if not kind:
        told = one_of([*_FIELDS, "polygon"])
        raise UsageError(f"a true {type(shape).__name__} cannot be written; what can is: {told}")
    return {"kind": kind, **{f: float(getattr(shape, f)) for f in _FIELDS[kind][1]}}


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


def truth_from_json(text: str, by_hand: bool = False) -> list[Truth]:
    """Return the truth of frames from a JSON text.

    Parameters
    ----------
    text : str
    by_hand : bool
        Whether a person wrote it: keys that nobody knows are misspelt, and a size is above 0.

    Raises
    ------
    ValueError
        If the text is no list of objects of known kinds with all their fields: in which frame,
        which object of it, what is wrong, and what is right.
    """
    try:
        frames = json.loads(text)
    except (ValueError, RecursionError) as error:
        raise ValueError(f"is no JSON: {error}") from error
    if not isinstance(frames, list):
        raise ValueError(
            f"must be a list with an entry for each frame, got {_got(frames)}; {_FORM}"
        )
    return [_of_frame(f"frame {k}", frame, by_hand) for k, frame in enumerate(frames)]


def _of_frame(where: str, frame: Any, by_hand: bool) -> Truth:
    if frame is None:
        return None
    if not isinstance(frame, list):
        told = f"{where}: must be null or a list of objects, got {_got(frame)}; {_FORM}"
        raise ValueError(told)
    return tuple(_object(f"{where}, object {j}", o, by_hand) for j, o in enumerate(frame))


def _object(where: str, entry: Any, by_hand: bool) -> TrueObject:
    if not isinstance(entry, dict):
        raise ValueError(f"{where}: must be an object, got {_got(entry)}; {_FORM}")
    kinds = (*_FIELDS, "polygon")
    if "kind" not in entry:
        others = [k for k in entry if k not in _KEYS]
        of_it = f"; {others[0]!r} is no key" if others else ""
        raise ValueError(f"{where}: has no 'kind' ({one_of(kinds)}){of_it}; {_FORM}")
    kind = entry["kind"]
    if not isinstance(kind, str) or kind not in kinds:
        near = did_you_mean(str(kind), kinds)
        raise ValueError(f"{where}: unknown kind {_got(kind)}, known: {one_of(kinds)}{near}")
    needed = ("xy_cm",) if kind == "polygon" else _FIELDS[kind][1]
    known = ("kind", *needed, "weight_g", "name")
    unknown = [k for k in entry if k not in known] if by_hand else []
    missing = [k for k in needed if k not in entry]
    form = f"a {kind} has {', '.join(known)}"
    if unknown:
        near = did_you_mean(unknown[0], missing or known)
        raise ValueError(f"{where}: unknown key {unknown[0]!r}; {form}{near}")
    if missing:
        raise ValueError(f"{where}: has no {missing[0]!r}; {form}")
    weight = entry.get("weight_g")
    grams = None if weight is None else _number(where, "weight_g", weight, by_hand)
    name = str(entry.get("name", ""))
    if kind == "polygon":
        return TrueObject(_polygon(where, entry["xy_cm"]), grams, name)
    numbers = [_number(where, key, entry[key], by_hand) for key in needed]
    return TrueObject(_FIELDS[kind][0](*numbers), grams, name)


def _polygon(where: str, given: Any) -> Polygon:
    try:
        corners = np.array(given, dtype=np.float64)
    except (ValueError, TypeError, OverflowError):
        corners = np.empty(0)
    if corners.ndim != 2 or corners.shape[1] != 2 or not np.isfinite(corners).all():
        told = f"xy_cm: must be corners, a list of pairs of numbers, got {_got(given)}"
        raise ValueError(f"{where}: {told}")
    return Polygon(corners)


def _number(where: str, key: str, given: Any, by_hand: bool) -> float:
    whole = isinstance(given, int | float) and not isinstance(given, bool)
    number = float(given) if whole and abs(given) <= LARGEST else math.nan
    above = by_hand and key not in ANYWHERE
    if not math.isfinite(number) or (above and number <= 0.0):
        needed = "a number > 0" if above else "a number"
        raise ValueError(f"{where}: {key}: must be {needed}, got {_got(given)}")
    return number


def _got(given: Any) -> str:
    """Return what was given as JSON writes it, cut where it is long."""
    text = json.dumps(given)
    return text if len(text) <= MOST_SHOWN else f"{text[:MOST_SHOWN]}…"
