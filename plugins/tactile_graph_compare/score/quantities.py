"""What is compared with the truth: units, what of each shape there is to compare, and its error."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping
from typing import Any

from tactile_graph.inspect import measures_of, shape_kind
from tactile_graph.wires.measure import Measure, axis_off_deg

OF_ANY: Mapping[str, str] = {"centre": "cm", "angle": "°", "count": "", "identity": ""}
"""Quantity -> unit, of those that are compared whatever the shapes."""
_FIRST = ("centre", "radius", "length", "breadth", "angle", "area")
_LAST = ("count", "identity")
_DECIMALS: Mapping[str, int] = {"cm": 3, "°": 2, "cm²": 2}
_AXIS = "angle_deg"


def decimals(unit: str) -> int:
    """Return how many decimals of a unit tables show."""
    return _DECIMALS.get(unit, 3)


def in_order(quantities: Iterable[str]) -> tuple[str, ...]:
    """Return quantities as tables have them: what most shapes have, what others add, the rest."""
    found = tuple(dict.fromkeys(quantities))
    others = sorted(q for q in found if q not in (*_FIRST, *_LAST))
    return tuple(q for q in (*_FIRST, *others, *_LAST) if q in found)


def units_of(kinds: Iterable[type]) -> dict[str, str]:
    """Return the unit of each quantity that there can be where shapes are of some kinds."""
    return {**{m.quantity: m.unit for k in kinds for m in measures_of(k)}, **OF_ANY}


def quantities_of(kind: type) -> tuple[str, ...]:
    """Return the quantities that a kind of shape has."""
    return ("centre", *(m.quantity for m in measures_of(kind)))


def distance_cm(a: Any, b: Any) -> float:
    """Return how far apart two centres are."""
    return math.hypot(a.x_cm - b.x_cm, a.y_cm - b.y_cm)


def errors_against(found: Any, true: Any) -> dict[str, float]:
    """Return how far each quantity is off, found less true, of those that both have.

    An angle is compared even with what is of another kind.
    """
    errors = {"centre": distance_cm(found, true)}
    kind, mine = shape_kind(type(true)), shape_kind(type(found))
    if kind is not None and hasattr(found, _AXIS) and _has_axis(measures_of(kind)):
        errors["angle"] = axis_off_deg(found, true)
    if mine is not None and isinstance(true, mine):
        errors |= {m.quantity: m.factor * m.error(found, true) for m in measures_of(mine)}
    return errors


def _has_axis(measures: Iterable[Measure]) -> bool:
    return any(m.field == _AXIS for m in measures)
