"""Flatten results into named scalars for tables, CSV and JSON, with errors where truth is known."""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Mapping
from collections.abc import Set as AbstractSet
from functools import cache, lru_cache
from typing import Any, Literal, get_origin

import numpy as np

from tactile_graph.engine.outcomes.outcome import (
    NO_VALUE,
    Done,
    Failed,
    Skipped,
    gaps,
    item_words,
    outcome_word,
    with_value,
)
from tactile_graph.engine.outcomes.outcomes import Outcomes
from tactile_graph.engine.tables.truth import shape_kind
from tactile_graph.errors import PluginError
from tactile_graph.pipeline.wiring import arms, public_fields

OF_FRAMES = ("frame", "time_s", "label")
"""The columns that say which frame a row is of."""
MOST_NUMBERS = 32
"""How many numbers an array or a list may have to be written where only a summary is."""


def result_row(result: Outcomes) -> dict[str, Any]:
    """Return frame number and time, then each output's scalars; a reason where it has none."""
    frame = result.frame
    row: dict[str, Any] = {"frame": frame.index}
    if frame.label:
        row["label"] = frame.label
    if frame.time_s is not None:
        row["time_s"] = frame.time_s
    for name in result.plan.asked:
        outcome = result.outcome(name)
        if outcome.__class__ in NO_VALUE:
            row[free_key(name)] = outcome_word(outcome)
            continue
        row.update({free_key(key): value for key, value in scalars(name, outcome).items()})
        if gaps(outcome):
            row[free_key(name)] = outcome_word(outcome)
    return row


@cache
def free_key(key: str) -> str:
    """Return the name of an output's column beside those that every table has."""
    taken = key in OF_FRAMES or key.rpartition(".")[2] == "outcome"
    return f"{key}.value" if taken else key


def fields_in_tables(kind: Any) -> tuple[str, ...]:
    """Return the fields of a record's type that stand in tables; none of a named tuple.

    Where it does not say so itself (``columns_shown``) they are a dataclass's numbers, texts and
    yes/no, and how many things it holds.
    """
    told: tuple[str, ...] | None = getattr(kind, "columns_shown", None)
    if told is not None or hasattr(kind, "_fields") or not dataclasses.is_dataclass(kind):
        return told or ()
    of: Any = get_origin(kind) or kind
    return _scalar_fields(of)


@lru_cache(maxsize=256)
def _scalar_fields(kind: Any) -> tuple[str, ...]:
    types = public_fields(kind)
    names = [f.name for f in dataclasses.fields(kind) if _is_scalar(types.get(f.name, Any))]
    if "count" not in names and isinstance(types.get("count"), type):
        names.insert(0, "count")
    return tuple(names)


def _is_scalar(kind: Any) -> bool:
    """Return whether a type is a number, a text or yes/no, or one of these and None."""
    kinds = [arm for arm in arms(kind) if arm is not type(None)]
    return bool(kinds) and all(
        get_origin(arm) is Literal
        or (isinstance(arm, type) and issubclass(arm, bool | int | float | str | np.generic))
        for arm in kinds
    )


def scalars(name: str, value: Any) -> dict[str, Any]:
    """Return a value as scalars named ``name`` or ``name.field``."""
    if isinstance(value, bool | int | float | str | np.generic):
        return {name: value.item() if isinstance(value, np.generic) else value}
    if isinstance(value, Done):
        return {name: "done"}
    shown = fields_in_tables(value.__class__)
    if shown:
        row = {f"{name}.{field}": getattr(value, field) for field in shown}
        if not hasattr(value, "columns_shown"):  # nobody promised that they hold what they say
            row = {key: _single(one) for key, one in row.items()}
        return row
    fields = getattr(value, "_fields", ())
    row = {}
    for field in fields:
        inner = getattr(value, field)
        if isinstance(inner, list | tuple) and "count" in fields:
            continue  # the record counts them itself
        if inner is not None and not isinstance(inner, Skipped | Failed):
            row.update(scalars(f"{name}.{field}", inner))
    if fields:
        return row
    if isinstance(value, list | tuple):
        return {f"{name}.count": len(with_value(value))}
    count = getattr(value, "count", None)
    return {f"{name}.count": count} if isinstance(count, int) else {}


def _single(value: Any) -> Any:
    """Return a number, a text or yes/no as it is; None in place of anything else."""
    if isinstance(value, np.ndarray):
        value = value.item() if value.ndim == 0 else None
    return value if isinstance(value, bool | int | float | str | np.generic) else None


def as_data(value: Any, full: bool = True) -> Any:
    """Return a value as plain data for JSON, arrays as nested lists.

    Parameters
    ----------
    value : Any
    full : bool
        Whether records give every field. Otherwise one that has a method ``summary()`` gives the
        mapping that this returns, and arrays and lists of more than `MOST_NUMBERS` numbers are
        told by their shape alone.
    """
    if isinstance(value, Skipped):
        return {"skipped": value.reason, "origin": value.origin, **_item(value)}
    if isinstance(value, Failed):
        told = {"failed": value.reason, "origin": value.origin, "kind": value.kind}
        return {**told, **_item(value)}
    if isinstance(value, np.generic | np.ndarray):
        return value.tolist() if full or value.size <= MOST_NUMBERS else _shape(*value.shape)
    if isinstance(value, bool | int | float | str) or value is None:
        return value
    if isinstance(value, Mapping):
        return {str(k): as_data(v, full) for k, v in value.items()}
    if not full and callable(getattr(type(value), "summary", None)):
        return _own_summary(value)
    if hasattr(value, "_asdict"):
        return {k: as_data(v, full) for k, v in value._asdict().items()}
    if isinstance(value, frozenset | set):
        return as_data(_in_order(value), full)
    if isinstance(value, list | tuple):
        data = [as_data(v, full) for v in value]
        numbers = len(data) > MOST_NUMBERS and not isinstance(data[0], dict)
        return _shape(len(data)) if numbers and not full else data
    return _record(value, full)


def _in_order(value: AbstractSet[Any]) -> list[Any]:
    """Return what is in a set in an order that is the same in every process."""
    try:
        return sorted(value)
    except TypeError:
        return sorted(value, key=repr)


def _item(outcome: Skipped | Failed) -> dict[str, str]:
    return {"item": item_words(outcome.item).removeprefix("item ")} if outcome.item else {}


def _shape(*shape: int) -> dict[str, list[int]]:
    return {"shape": list(shape)}


def _own_summary(value: Any) -> dict[str, Any]:
    told = value.summary()
    if not isinstance(told, Mapping):
        kind = type(value).__name__
        raise PluginError(f"{kind}.summary() must return a mapping, got {type(told).__name__}")
    return {str(k): as_data(v, full=False) for k, v in told.items()}


def _record(value: Any, full: bool) -> Any:
    if dataclasses.is_dataclass(value):
        names = [f.name for f in dataclasses.fields(value)]
    else:
        slots = [n for kind in type(value).__mro__ for n in getattr(kind, "__slots__", ())]
        names = getattr(value, "fields_told", slots)  # a slot may hold the making of a field
    shown = [n for n in dict.fromkeys(names) if not n.startswith("_")]
    shape = shape_kind(type(value))
    data = {} if shape is None or "kind" in shown else {"kind": shape.__name__}
    data |= {n: as_data(getattr(value, n), full) for n in shown}
    for name in getattr(value, "columns_shown", ()):
        data.setdefault(name, as_data(getattr(value, name), full))
    return data if data else str(value)


def without_nan(data: Any) -> Any:
    """Return data with null for NaN, which JSON has not."""
    if isinstance(data, float):
        return data if math.isfinite(data) else None
    if isinstance(data, dict):
        return {k: without_nan(v) for k, v in data.items()}
    return [without_nan(v) for v in data] if isinstance(data, list) else data
