"""Freeze what steps return: arrays become read-only, lists become tuples; nothing is copied."""

from __future__ import annotations

import dataclasses
from typing import Any

import numpy as np

from tactile_graph.wires.image import Image, Mask
from tactile_graph.wires.points import Points
from tactile_graph.wires.shapes import Circle, Ellipse, Rectangle

FROZEN: frozenset[type] = frozenset(
    {bool, int, float, complex, str, bytes, Image, Mask, Points, Circle, Ellipse, Rectangle}
)
"""Types that are frozen by construction and need no second look."""


def freeze(value: Any) -> Any:
    """Return the value with every array in it read-only and every list a tuple."""
    kind = type(value)
    if kind in FROZEN or value is None:
        return value
    if isinstance(value, np.ndarray):
        value.setflags(write=False)
        return value
    if isinstance(value, tuple):
        items = [freeze(v) for v in value]
        if all(a is b for a, b in zip(items, value, strict=True)):
            return value
        return kind(*items) if hasattr(kind, "_fields") else tuple(items)
    if isinstance(value, list):
        return tuple(freeze(v) for v in value)
    if isinstance(value, dict):
        for item in value.values():
            freeze(item)
    elif dataclasses.is_dataclass(value):
        for f in dataclasses.fields(value):
            freeze(getattr(value, f.name))
    return value
