"""Which outputs of a variant answer what, told by their types before the first frame."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from operator import attrgetter
from typing import Any

from tactile_graph import Pipeline
from tactile_graph.inspect import (
    NO_VALUE,
    Ref,
    Skipped,
    arms,
    field_type,
    public_fields,
    shape_kind,
    with_value,
)
from tactile_graph.steps.signature import list_item
from tactile_graph_compare.score.quantities import quantities_of, units_of

Outcomes = Callable[[Ref], Any]
"""Gives the outcome at a reference of a variant."""


@dataclass(frozen=True)
class Places:
    """An output that says where things are: one, or as many as there are.

    Parameters
    ----------
    ref : Ref
    many : bool
        Whether it is a list.
    items : callable
        Gives the list of an output's value.
    thing : callable
        Gives what of an item has a place: itself, or its shape.
    kinds : tuple of type
        The shapes an item can be; empty where it only has a place.
    quantities : tuple of str
    """

    ref: Ref
    many: bool
    items: Callable[[Any], Sequence[Any]]
    thing: Callable[[Any], Any]
    kinds: tuple[type, ...]
    quantities: tuple[str, ...]


@dataclass(frozen=True)
class Answers:
    """What of a variant answers which quantity; where several could, the first not skipped does.

    Shapes come before what only has a place; an output that failed is asked all the same.
    """

    places: tuple[Places, ...]
    counts: tuple[tuple[Ref, Callable[[Any], int]], ...]
    identities: tuple[Ref, ...]

    @property
    def quantities(self) -> tuple[str, ...]:
        """The quantities the variant can answer."""
        found = dict.fromkeys(q for p in self.places for q in p.quantities)
        found |= {"count": None} if self.counts else {}
        found |= {"identity": None} if self.identities else {}
        return tuple(found)

    @property
    def units(self) -> dict[str, str]:
        """The unit of each quantity."""
        return units_of(k for p in self.places for k in p.kinds)

    def placed(self, outcomes: Outcomes) -> tuple[Places, Any]:
        """Return the first output that was not skipped; a failed one has no other stand in."""
        for place in self.places:
            value = outcomes(place.ref)
            if value.__class__ is not Skipped:
                return place, value
        return self.places[0], outcomes(self.places[0].ref)

    def counted(self, outcomes: Outcomes) -> int | None:
        """Return how many things the first output that has a value counts; None without any."""
        for ref, count in self.counts:
            value = outcomes(ref)
            if value.__class__ not in NO_VALUE:
                return count(value)
        return None

    def named(self, outcomes: Outcomes) -> str:
        """Return the name the first output that was not skipped gives; empty for a stranger."""
        values = [outcomes(ref) for ref in self.identities]
        value = next((v for v in values if v.__class__ is not Skipped), values[0])
        return "" if value.__class__ in NO_VALUE or not value.known else str(value.name)


def answers_of(pipeline: Pipeline, asked: Sequence[str]) -> Answers:
    """Return what the outputs asked for say about the truth.

    Parameters
    ----------
    pipeline : Pipeline
    asked : sequence of str
        Outputs, nodes or ``node.field``.
    """
    shapes: list[Places] = []
    spots: list[Places] = []
    counts: list[tuple[Ref, Callable[[Any], int]]] = []
    identities: list[Ref] = []
    for name in asked:
        ref = pipeline.outputs.get(name) or pipeline.ref(name)
        kind = pipeline.type_of(ref)
        items, item = _listed(kind)
        if items is not None:
            counts.append((ref, _counter(kind, items)))
        place = _places(ref, items, item)
        if place is not None:
            (shapes if place.kinds else spots).append(place)
        elif _is_identity(kind):
            identities.append(ref)
    return Answers(tuple(shapes or spots), tuple(counts), tuple(identities))


def _listed(kind: Any) -> tuple[Callable[[Any], Sequence[Any]] | None, Any]:
    """Return how a type's list is had, and the type of its items; None and itself without."""
    item = list_item(kind)
    if item is not None:
        return (lambda value: value), item
    fields = public_fields(kind)
    if fields.get("count") is int and hasattr(kind, "_fields"):
        for name in kind._fields:
            item = list_item(fields.get(name))
            if item is not None:
                return attrgetter(name), item
    return None, kind


def _counter(kind: Any, items: Callable[[Any], Sequence[Any]]) -> Callable[[Any], int]:
    if list_item(kind) is None:
        return attrgetter("count")  # the record counts its list itself
    return lambda value: len(with_value(items(value)))


def _places(ref: Ref, items: Any, item: Any) -> Places | None:
    kinds = _shape_kinds(item)
    thing: Callable[[Any], Any] = _itself
    if not kinds and (kinds := _shape_kinds(field_type(item, "shape"))):
        thing = attrgetter("shape")
    if kinds:
        quantities = tuple(dict.fromkeys(q for k in kinds for q in quantities_of(k)))
    elif all(_is_number(field_type(item, name)) for name in ("x_cm", "y_cm")):
        turned = _is_number(field_type(item, "angle_deg"))
        quantities = ("centre", "angle") if turned else ("centre",)
    else:
        return None
    return Places(ref, items is not None, items or _alone, thing, kinds, quantities)


def _itself(value: Any) -> Any:
    return value


def _alone(value: Any) -> Sequence[Any]:
    return (value,)


def _shape_kinds(kind: Any) -> tuple[type, ...]:
    """Return the shapes a type can be, if it is nothing else."""
    if kind is None:
        return ()
    found = [shape_kind(arm) for arm in arms(kind) if arm is not type(None)]
    return tuple(dict.fromkeys(k for k in found if k)) if found and all(found) else ()


def _is_number(kind: Any) -> bool:
    return kind is float or kind is int


def _is_identity(kind: Any) -> bool:
    return all(
        fields.get("name") is str and fields.get("known") is bool
        for fields in map(public_fields, arms(kind))
    )
