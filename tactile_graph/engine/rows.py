"""Flatten results into named scalars for tables, CSV and JSON, with errors where truth is known."""

from __future__ import annotations

import dataclasses
import math
from typing import Any

import numpy as np

from tactile_graph.engine.outcome import Done, Failed, Skipped
from tactile_graph.engine.outcomes import Outcomes


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
        if isinstance(outcome, Failed):
            row[name] = f"failed: {outcome.reason}"
        elif isinstance(outcome, Skipped):
            row[name] = f"skipped: {outcome.reason}"
        else:
            row.update(scalars(name, outcome))
    return row


def scalars(name: str, value: Any) -> dict[str, Any]:
    """Return a value as scalars named ``name`` or ``name.field``."""
    if isinstance(value, bool | int | float | str | np.generic):
        return {name: value.item() if isinstance(value, np.generic) else value}
    if isinstance(value, Done):
        return {name: "done"}
    shown = getattr(value, "columns_shown", ())
    if shown:
        return {f"{name}.{field}": getattr(value, field) for field in shown}
    fields = getattr(value, "_fields", ())
    row: dict[str, Any] = {}
    for field in fields:
        inner = getattr(value, field)
        if isinstance(inner, list | tuple) and "count" in fields:
            continue  # the record counts them itself
        if inner is not None and not isinstance(inner, Skipped | Failed):
            row.update(scalars(f"{name}.{field}", inner))
    if fields:
        return row
    if isinstance(value, list | tuple):
        return {f"{name}.count": len(value)}
    count = getattr(value, "count", None)
    return {f"{name}.count": count} if isinstance(count, int) else {}


def as_data(value: Any) -> Any:
    """Return a value as plain data for JSON, arrays as nested lists."""
    if isinstance(value, Skipped):
        return {"skipped": value.reason, "origin": value.origin}
    if isinstance(value, Failed):
        return {"failed": value.reason, "origin": value.origin, "kind": value.kind}
    if isinstance(value, np.generic | np.ndarray):
        return value.tolist()
    if isinstance(value, bool | int | float | str) or value is None:
        return value
    if hasattr(value, "_asdict"):
        return {k: as_data(v) for k, v in value._asdict().items()}
    if isinstance(value, list | tuple):
        return [as_data(v) for v in value]
    if isinstance(value, dict):
        return {str(k): as_data(v) for k, v in value.items()}
    return _record(value)


def _record(value: Any) -> Any:
    if dataclasses.is_dataclass(value):
        names = [f.name for f in dataclasses.fields(value)]
    else:
        names = [n for kind in type(value).__mro__ for n in getattr(kind, "__slots__", ())]
    shown = [n for n in dict.fromkeys(names) if not n.startswith("_")]
    data = {n: as_data(getattr(value, n)) for n in shown}
    for name in getattr(value, "columns_shown", ()):
        data.setdefault(name, as_data(getattr(value, name)))
    return data if data else str(value)


def without_nan(data: Any) -> Any:
    """Return data with null for NaN, which JSON has not."""
    if isinstance(data, float):
        return data if math.isfinite(data) else None
    if isinstance(data, dict):
        return {k: without_nan(v) for k, v in data.items()}
    return [without_nan(v) for v in data] if isinstance(data, list) else data
