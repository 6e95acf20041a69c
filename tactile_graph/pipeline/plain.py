"""Values as plain data, fit for YAML, JSON and digests."""

from __future__ import annotations

import dataclasses
from collections.abc import Mapping
from enum import Enum
from typing import Any

from tactile_graph.pipeline.by_value import text_by_value


def plain(value: Any) -> Any:
    """Return a value as plain data fit for YAML and JSON; equal only where values are.

    A record is told in words, all of its fields and what these hold.
    """
    if isinstance(value, dict | Mapping):
        named = {_name(k): plain(v) for k, v in value.items()}
        if len(named) == len(value):
            return named
        return [[plain(k), plain(v)] for k, v in value.items()]  # 1 and "1"
    if isinstance(value, list | tuple):
        return [plain(v) for v in value]
    if isinstance(value, set | frozenset):
        return sorted((plain(v) for v in value), key=repr)  # the same under every hash seed
    if value is None or isinstance(value, bool | int | float | str):
        return value
    if hasattr(value, "tolist") and _all_in_list(value):
        return value.tolist()
    return text_by_value(value)


def _name(key: Any) -> str:
    """Return a key as text: a number of NumPy's, which is equal to Python's, as that."""
    key = key.tolist() if hasattr(key, "tolist") else key
    return key if isinstance(key, str) else text_by_value(key)


def _all_in_list(value: Any) -> bool:
    """Return whether an array is all in the list of its numbers, or is a single number."""
    shape, kind = getattr(value, "shape", None), getattr(value, "dtype", None)
    if type(value).__module__ != "numpy":  # as a masked one
        return False
    return not shape or (0 not in shape and kind in ("float64", "int64", "bool"))


def as_given(value: Any) -> Any:
    """Return a setting as a file gives it: records as mappings, of an Enum's members the values."""
    if isinstance(value, Enum):
        return as_given(value.value)
    if isinstance(value, Mapping):
        return {str(key): as_given(item) for key, item in value.items()}
    if isinstance(value, list | tuple):
        return [as_given(item) for item in value]
    if dataclasses.is_dataclass(value) and not isinstance(value, type):
        told = {f.name: getattr(value, f.name) for f in dataclasses.fields(value) if f.init}
        return as_given(told)
    return value.tolist() if hasattr(value, "tolist") else plain(value)
