"""What kinds of values conditions read: which are scalars, and which can be compared."""

from __future__ import annotations

from typing import Any, Literal, get_args, get_origin

import numpy as np

from tactile_graph.errors import one_of
from tactile_graph.pipeline.wiring import arms, public_fields


def sort_of(kind: Any) -> str | None:
    """Return ``number`` or ``text``, None for a type that may be either or neither."""
    if get_origin(kind) is Literal:
        sorts = {sort_of(type(value)) for value in get_args(kind)}
        return sorts.pop() if len(sorts) == 1 else None
    if not isinstance(kind, type) or kind is type(None):
        return None
    if issubclass(kind, str):
        return "text"
    return "number" if issubclass(kind, bool | int | float | np.number) else None


def is_scalar(kind: Any) -> bool:
    """Return whether values of a type are numbers, texts or yes/no."""
    if kind is Any or kind is type(None) or get_origin(kind) is Literal:
        return True
    return isinstance(kind, type) and issubclass(kind, bool | int | float | str | np.generic)


def fields_hint(kind: Any) -> str:
    """Return what a condition could read of a value that is none itself."""
    fields = [n for n, k in public_fields(kind).items() if all(is_scalar(a) for a in arms(k))]
    return f"; it has: {one_of(fields)}" if fields else ""
