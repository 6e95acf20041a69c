"""Values as plain data, fit for YAML, JSON and digests."""

from __future__ import annotations

import dataclasses
from collections.abc import Mapping
from enum import Enum
from typing import Any


def plain(value: Any) -> Any:
    """Return a value as plain data fit for YAML and JSON."""
    if isinstance(value, dict | Mapping):
        return {str(k): plain(v) for k, v in value.items()}
    if isinstance(value, list | tuple):
        return [plain(v) for v in value]
    if isinstance(value, set | frozenset):
        return sorted((plain(v) for v in value), key=repr)  # the same under every hash seed
    if value is None or isinstance(value, bool | int | float | str):
        return value
    if hasattr(value, "tolist"):
        return value.tolist()
    return str(value)


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
    return plain(value)
