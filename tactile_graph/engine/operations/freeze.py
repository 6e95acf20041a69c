"""Freeze what steps return: arrays become read-only, lists tuples, mappings the result's own.

A list within a record stays a list, as the record declares it, but is the result's own, and so is
a record whose fields can be set.

An array is copied only where it lies in one that its step may go on writing into.
"""

from __future__ import annotations

import copy
import dataclasses
from typing import Any, get_type_hints

import numpy as np

from tactile_graph.engine.operations.memory import OWN, own_array
from tactile_graph.wires.image import Image, Mask
from tactile_graph.wires.points import Points
from tactile_graph.wires.shapes import Circle, Ellipse, Polygon, Rectangle

IMMUTABLE = frozenset(
    {bool, int, float, complex, str, bytes, Mask, Points, Circle, Ellipse, Rectangle, Polygon}
)
"""Types of which the same object is the same value. An image's is not here: frames may come from
a buffer that its source fills anew."""

FROZEN: set[type] = {*IMMUTABLE, Image}
"""Types that need no second look: frozen by construction, or records of numbers met before. Of a
step that may hold on to what a wire's arrays lie in, `detached` looks at them."""


def freeze(value: Any) -> Any:
    """Return the value, arrays in it read-only, lists as tuples, dicts and sets copied.

    A frozen record is itself where all its fields are; else, and where its fields can be set, it is
    a copy: its step may go on with its own.

    Raises
    ------
    TypeError
        If the value holds itself, or is nested deeper than Python follows.
    """
    try:
        return _frozen(value, {})
    except RecursionError:
        raise TypeError(
            "what the step returned holds itself, or is nested hundreds deep; "
            "let records name each other by a number or a text"
        ) from None


def _frozen(value: Any, known: Known, inside: bool = False) -> Any:
    kind = value.__class__
    if kind in FROZEN or value is None:
        return OWN[kind](value) if kind in OWN else value
    names = _FIELDS.get(kind)
    if names is None:
        names = _FIELDS[kind] = _fields(kind)
        if _only_numbers(kind):
            FROZEN.add(kind)
            return value
    if known and names and id(value) in known:
        return known[id(value)][1]
    changed = None
    for name in names:
        field: Any = getattr(value, name, None)
        kind = field.__class__
        if kind is np.ndarray:
            field.setflags(False)  # by keyword it takes twice as long
            if field.base is None:
                continue
            own = own_array(field)
        elif kind not in FROZEN or kind in OWN:
            own = _frozen(field, known, True)
        else:
            continue
        if own is not field:
            changed = changed or {}
            changed[name] = own
    if changed or value.__class__ in _OPEN:
        made = _with(value, changed or {})
        known[id(value)] = value, made  # the record too: or another could have its id
        return made
    return value if names else _freeze_container(value, known, inside)


def _with(record: Any, changed: dict[str, Any]) -> Any:
    """Return a copy of a record, frozen or not, with other values in some of its fields."""
    kind = record.__class__
    if (plain := _PLAIN.get(kind)) is None:
        plain = _PLAIN[kind] = _is_plain(kind)
    if plain:  # a third of the time
        made = object.__new__(kind)
        vars(made).update(vars(record), **changed)
        return made
    try:
        made = copy.copy(record)
        for name, value in changed.items():
            object.__setattr__(made, name, value)
    except Exception:  # it lets nobody copy it, or give a field another value: it stays itself
        return record
    return made


def _is_plain(kind: type) -> bool:
    """Return whether records of a class are copied by their fields alone."""
    own = ("__copy__", "__getnewargs_ex__", "__getnewargs__", "__setstate__")
    common = ("__new__", "__reduce__", "__reduce_ex__", "__getstate__")
    return (
        kind.__dictoffset__ != 0  # less than 0 where Python lays out the fields itself
        and not any(hasattr(kind, name) for name in own)
        and all(getattr(kind, name) is getattr(object, name) for name in common)
        and not any("__slots__" in vars(c) and c.__slots__ for c in kind.__mro__)  # type: ignore[attr-defined]
        and not any(hasattr(type(vars(kind).get(n)), "__set__") for n in _FIELDS[kind])
    )


_PLAIN: dict[type, bool] = {}
Known = dict[int, tuple[Any, Any]]
"""Records and their copies, by the `id` of the record: one that is named twice stays one."""
_FIELDS: dict[type, tuple[str, ...]] = {}
"""The fields of each record type met so far."""
_OPEN: set[type] = set()
"""Those of them whose fields can be set, and which hold nothing that ends with them."""


def _fields(kind: type) -> tuple[str, ...]:
    if dataclasses.is_dataclass(kind):
        frozen = kind.__dataclass_params__.frozen  # type: ignore[attr-defined]
        if not (frozen or hasattr(kind, "__del__")):  # a copy that ends would end what it holds
            _OPEN.add(kind)
        return tuple(f.name for f in dataclasses.fields(kind))
    return ()


def _only_numbers(kind: type) -> bool:
    """Return whether a frozen dataclass declares nothing but numbers, texts and yes/no."""
    if not dataclasses.is_dataclass(kind) or not kind.__dataclass_params__.frozen:  # type: ignore[attr-defined]
        return False
    try:
        hints = get_type_hints(kind)
    except Exception:  # a plugin's own type may have hints that only its checker can read
        return False
    return all(hints[f.name] in (bool, int, float, str) for f in dataclasses.fields(kind))


def _freeze_container(value: Any, known: Known, inside: bool) -> Any:
    if isinstance(value, np.ndarray):
        value.setflags(False)  # type: ignore[call-arg]
        return own_array(value)
    if isinstance(value, tuple):
        items = [_frozen(v, known, inside) for v in value]
        if any(a is not b for a, b in zip(items, value, strict=True)):
            return type(value)(*items) if hasattr(value, "_fields") else tuple(items)
    elif isinstance(value, list):
        items = [_frozen(v, known, inside) for v in value]
        if not inside:
            return tuple(items)
        return items if value.__class__ is list else value
    elif value.__class__ is dict:  # a step may give the one it keeps, and go on filling it
        return {key: _frozen(item, known, inside) for key, item in value.items()}
    elif value.__class__ is set:
        return value.copy()
    elif isinstance(value, dict):
        for item in value.values():
            _frozen(item, known, inside)
    return value
