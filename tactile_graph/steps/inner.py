"""Inside a setting that is a mapping: its fields, their types, and where an error lies."""

from __future__ import annotations

import dataclasses
import types
from collections.abc import Iterator, Mapping, Sequence
from collections.abc import Set as AbstractSet
from enum import Enum
from typing import Any, Literal, Union, get_args, get_origin, get_type_hints

from tactile_graph.steps.arrays import is_array
from tactile_graph.steps.signature import list_item, strip, type_name

Place = tuple[str | int, ...]
LONGEST = 100
"""Characters that tell the fields of a record with their types; of a longer one the names do."""


def fields(annotation: Any) -> dict[str, Any]:
    """Return name and annotation of each field of a dataclass, model, typed dict or named
    tuple, else none.

    Of a union, those of its members together.
    """
    found: dict[str, Any] = {}
    for bare in members(annotation):
        names = _names(bare)
        if not names:
            continue
        try:
            hints = get_type_hints(bare, include_extras=True)
        except Exception:  # names that only a type checker sees
            hints = {}
        found = {**{told: hints.get(name, Any) for told, name in names.items()}, **found}
    return found


def _names(bare: Any) -> dict[str, str]:
    """Return the name of each field by the one that a file gives it."""
    if not isinstance(bare, type):
        return {}
    if dataclasses.is_dataclass(bare):
        return {f.name: f.name for f in dataclasses.fields(bare) if f.init}
    if hasattr(bare, "model_fields"):
        told = {name: field.validation_alias for name, field in bare.model_fields.items()}
        return {alias if isinstance(alias, str) else name: name for name, alias in told.items()}
    if issubclass(bare, dict) and hasattr(bare, "__total__"):
        return {name: name for name in bare.__annotations__}
    if issubclass(bare, tuple) and hasattr(bare, "_fields"):
        return {name: name for name in bare._fields}
    return {}


def item(annotation: Any, part: str | int) -> Any:
    """Return the annotation of a field, of a list's items or a mapping's values.

    Of a union, what each member that holds such things says; Any if there is none to know.
    """
    return _any_of([*_items(annotation, part)])


def _items(annotation: Any, part: str | int) -> Iterator[Any]:
    for bare in members(annotation):
        known = fields(bare)
        args = get_args(bare)
        if part in known:
            yield known[str(part)]
        elif _is_mapping(bare):
            yield from args[1:]
        elif isinstance(part, int) and hasattr(bare, "_fields"):
            yield from list(known.values())[part : part + 1]
        elif isinstance(part, int) and n_items(bare):
            yield from args[part : part + 1]
        elif isinstance(part, int) and (found := list_item(bare)) is not None:
            yield found


def is_open(annotation: Any, at: Place) -> bool:
    """Return whether a setting's type leaves it open what stands at a place within it."""
    for part in at:
        if any(is_array(bare) or _is_set(bare) for bare in members(annotation)):
            return False
        annotation = item(annotation, part)
    return not {Any, object}.isdisjoint(members(annotation))


def members(annotation: Any) -> list[Any]:
    """Return the bare types of which a value may be any: those of a union, else the one."""
    bare, _ = strip(annotation)
    if get_origin(bare) not in (Union, types.UnionType):
        return [bare]
    return [m for arm in get_args(bare) for m in members(arm)]


def written_type(annotation: Any, within: tuple[Any, ...] = ()) -> str:
    """Return a setting's type as a file may give it: ``'red' | 'blue'``, ``{a: int, b: str}``."""
    bare, _ = strip(annotation)
    if isinstance(bare, type) and issubclass(bare, Enum):
        return " | ".join(repr(member.value) for member in bare)
    inside = (*within, bare)
    if get_origin(bare) in (Union, types.UnionType):
        return " | ".join(written_type(arm, inside) for arm in get_args(bare))
    if bare not in within and (known := fields(bare)):
        told = ", ".join(f"{n}: {written_type(k, inside)}" for n, k in known.items())
        return f"{{{told if len(told) <= LONGEST else ', '.join(known)}}}"
    if get_origin(bare) in (None, Literal) or not get_args(bare):
        return type_name(bare)
    items = ("..." if k is Ellipsis else written_type(k, inside) for k in get_args(bare))
    return f"{type_name(get_origin(bare))}[{', '.join(items)}]"


def key_of(annotation: Any) -> Any:
    """Return the annotation of a mapping's keys, Any if there is none to know."""
    return _any_of([get_args(bare)[0] for bare in members(annotation) if _is_mapping(bare)])


def n_items(annotation: Any) -> int:
    """Return how many items a tuple has, 0 where that is left open."""
    for bare in members(annotation):
        args = get_args(bare)
        if get_origin(bare) is tuple and Ellipsis not in args:
            return len(args)
    return 0


def _any_of(annotations: list[Any]) -> Any:
    if len(annotations) < 2:
        return annotations[0] if annotations else Any
    try:
        return Union[tuple(annotations)]  # noqa: UP007 -- as many as there are
    except TypeError:  # metadata without a hash
        return annotations[0]


def holds(bare: Any) -> bool:
    """Return whether values of a bare type hold others, such as a list's items."""
    kind = get_origin(bare) or bare
    if isinstance(kind, type) and issubclass(kind, Mapping | Sequence | AbstractSet):
        return not issubclass(kind, str | bytes)
    return is_array(bare) or bool(fields(bare))


def _is_mapping(bare: Any) -> bool:
    origin = get_origin(bare)
    return isinstance(origin, type) and issubclass(origin, Mapping) and len(get_args(bare)) == 2


def _is_set(bare: Any) -> bool:
    origin = get_origin(bare)
    return isinstance(origin, type) and issubclass(origin, AbstractSet)


def place(given: Any, parts: tuple[str | int, ...]) -> Place:
    """Return that of pydantic's location which the file can tell: keys and numbers given there.

    The rest of it names the arms of unions.
    """
    kept: list[str | int] = []
    for part in parts:
        if isinstance(given, Mapping):
            if part not in given:
                continue
            given = given[part]
        elif isinstance(part, int) and isinstance(given, list | tuple) and part < len(given):
            given = given[part]
        else:
            continue
        kept.append(part)
    return tuple(kept)


def leaves(annotation: Any, given: Any, at: Place = ()) -> Iterator[tuple[Place, Any, Any]]:
    """Yield place, annotation and value of all that is given within mappings and lists.

    A mapping or list of which nothing tells what is in it is one of these itself; fields that
    nothing is known of are left out.
    """
    within: list[tuple[Any, Any]] = []
    if isinstance(given, Mapping):
        within = [*given.items()]
    elif isinstance(given, list | tuple):
        within = [*enumerate(given)]
    known = [
        (part, value, kind) for part, value in within if (kind := item(annotation, part)) is not Any
    ]
    if not known and not (within and fields(annotation)):
        yield at, annotation, given
    for part, value, kind in known:
        yield from leaves(kind, value, (*at, part))
