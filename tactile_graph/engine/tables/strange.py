"""Find NaN and infinity within an output: in lists, mappings, arrays, and records of records."""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Mapping
from functools import cache
from typing import Any

import numpy as np

PLAIN = frozenset({int, bool, str, type(None)})


def strange_within(value: Any) -> str:
    """Return where a value holds NaN or infinity, as ``[1].x_cm is nan``; "" where it does not.

    Of a record that says what tables show of it, only fields that these show count.
    """
    kind = value.__class__
    if kind in PLAIN:
        return ""
    if isinstance(value, float | np.floating):
        return "" if math.isfinite(value) else f" is {value}"
    if isinstance(value, np.ndarray):
        return _strange_array(value)
    if names := _looked_into(kind):
        for name in names:
            item: Any = getattr(value, name, None)
            kind = item.__class__
            if kind in PLAIN or (kind is float and item - item == 0.0):
                continue  # half of the time: most fields are finite numbers
            if found := strange_within(item):
                return f".{name}{found}"
    elif isinstance(value, Mapping):
        for key, item in value.items():
            if found := strange_within(item):
                return f"[{key!r}]{found}"
    elif isinstance(value, list | tuple):
        return _strange_items(value)
    return ""


def _strange_array(values: Any) -> str:
    given = values.compressed() if isinstance(values, np.ma.MaskedArray) else values
    if given.dtype.kind not in "fc":
        return ""
    good = int(np.count_nonzero(np.isfinite(given)))
    many = f" holds {given.size - good} numbers of {given.size} that are not finite"
    return many if good < given.size else ""


def _strange_items(items: list[Any] | tuple[Any, ...]) -> str:
    try:
        if all(map(math.isfinite, items)):  # a tenth of the time of one by one
            return ""
    except (TypeError, OverflowError):  # not only numbers
        pass
    for i, item in enumerate(items):
        if found := strange_within(item):
            return f"[{i}]{found}"
    return ""


@cache
def _looked_into(kind: type) -> tuple[str, ...]:
    """Return the fields of a record's type that hold what it says, none of any other type."""
    if hasattr(kind, "_fields"):
        own: tuple[str, ...] = tuple(kind._fields)
    elif dataclasses.is_dataclass(kind):
        own = tuple(f.name for f in dataclasses.fields(kind))
    else:
        return ()
    shown = getattr(kind, "columns_shown", own)
    return tuple(name for name in own if name in shown and not name.startswith("_"))
