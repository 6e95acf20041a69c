"""Whether two answers are the same, down to the last bit."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import fields, is_dataclass
from typing import Any

import numpy as np


def same(one: Any, other: Any) -> bool:
    """Return whether two answers have the same types and the same content; NaN equals NaN."""
    if one is other:
        return True
    if type(one) is not type(other):
        return False
    if isinstance(one, np.ndarray):
        alike = one.shape == other.shape and one.dtype == other.dtype
        if one.dtype.hasobject:
            return alike and all(map(same, one.ravel().tolist(), other.ravel().tolist()))
        return bool(alike and one.tobytes() == other.tobytes())
    if isinstance(one, Mapping):
        return list(one) == list(other) and all(same(one[k], other[k]) for k in one)
    if isinstance(one, list | tuple):
        return len(one) == len(other) and all(map(same, one, other))
    if isinstance(one, float | np.floating):
        return bool(one == other or (one != one and other != other))
    names = _content(one)
    if names:
        return all(same(getattr(one, n, None), getattr(other, n, None)) for n in names)
    return bool(one == other)


def _content(value: Any) -> list[str]:
    """Return the names of all that makes up a record; none where it must say itself."""
    if is_dataclass(value):
        return [f.name for f in fields(value)]
    slots = [s for kind in type(value).__mro__ for s in getattr(kind, "__slots__", ())]
    # Masks count themselves when somebody asks: what is derived is not compared.
    return [s for s in slots if not s.startswith("_")]
