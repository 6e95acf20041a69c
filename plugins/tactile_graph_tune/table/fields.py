"""Which fields of a node's value a guard could hold against a number."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import numpy as np

from tactile_graph import Pipeline
from tactile_graph.inspect import NodeKind, arms, field_type, public_fields

DEEPEST = 2
PLACES = ("x_cm", "y_cm", "angle_rad", "angle_deg", "index", "row", "column", "origin_cm")
"""Where a thing lies says where things were put, not how well they were found."""


def guard_fields(pipeline: Pipeline) -> list[str]:
    """Return every ``node.field`` of the pipeline's steps that is a number, or true or false."""
    found: list[str] = []
    for name, node in pipeline.nodes.items():
        if node.kind is NodeKind.STEP and not node.is_sink and "/" not in name:
            found += [".".join((name, *path)) for path in _paths(node.output, DEEPEST)]
    return found


def _paths(kind: Any, depth: int) -> Iterator[tuple[str, ...]]:
    if _is_number(kind):
        yield ()
        return
    if depth == 0:
        return
    known = [set(public_fields(arm)) for arm in arms(kind) if arm is not type(None)]
    for name in sorted(set.intersection(*known)) if known else ():
        if name not in PLACES:
            inner = field_type(kind, name)
            yield from ((name, *path) for path in _paths(inner, depth - 1))


def _is_number(kind: Any) -> bool:
    kinds = [arm for arm in arms(kind) if arm is not type(None)]
    return bool(kinds) and all(
        isinstance(k, type) and issubclass(k, int | float | np.number | np.bool_) for k in kinds
    )


def is_flag(kind: Any) -> bool:
    """Return whether a field is true or false."""
    return all(k in (bool, np.bool_, type(None)) for k in arms(kind))


def value_at(value: Any, path: tuple[str, ...]) -> float:
    """Return a field as a number; NaN where it has none."""
    try:
        for name in path:
            value = getattr(value, name)
        return float(value)
    except (TypeError, ValueError, ArithmeticError, AttributeError):
        return np.nan
