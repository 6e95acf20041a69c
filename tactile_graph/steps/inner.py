"""Inside a setting that is a mapping: its fields, their types, and where an error lies."""

from __future__ import annotations

import dataclasses
import types
from collections.abc import Iterator, Mapping
from typing import Any, Union, get_args, get_origin, get_type_hints

from tactile_graph.steps.signature import list_item, strip

Place = tuple[str | int, ...]


def fields(annotation: Any) -> dict[str, Any]:
    """Return name and annotation of each field of a dataclass, model or TypedDict, else none.

    Of a union, those of its members together.
    """
    bare, _ = strip(annotation)
    if get_origin(bare) in (Union, types.UnionType):
        found: dict[str, Any] = {}
        for member in get_args(bare):
            found = {**fields(member), **found}
        return found
    if not isinstance(bare, type):
        return {}
    if dataclasses.is_dataclass(bare):
        names = [f.name for f in dataclasses.fields(bare) if f.init]
    elif hasattr(bare, "model_fields"):
        names = list(bare.model_fields)
    elif issubclass(bare, dict) and hasattr(bare, "__total__"):
        names = list(bare.__annotations__)
    else:
        return {}
    try:
        hints = get_type_hints(bare, include_extras=True)
    except Exception:  # names that only a type checker sees
        hints = {}
    return {name: hints.get(name, Any) for name in names}


def item(annotation: Any, part: str | int) -> Any:
    """Return the annotation of a field or of a list's items, Any if there is none to know."""
    if isinstance(part, int):
        found = list_item(strip(annotation)[0])
        return Any if found is None else found
    return fields(annotation).get(part, Any)


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
    """Yield place, annotation and value of each field given within a mapping, deeper ones too."""
    known = fields(annotation) if isinstance(given, Mapping) else {}
    if not known:
        yield at, annotation, given
        return
    for name, value in given.items():
        if name in known:
            yield from leaves(known[name], value, (*at, name))
