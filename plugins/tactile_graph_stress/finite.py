"""Find what is not finite in whatever a step gives."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import fields, is_dataclass
from typing import Any

import numpy as np

from tactile_graph.wires import Image, Mask, Points


def not_finite(value: Any) -> str:
    """Return which field holds NaN or infinity, in words; empty if all is finite."""
    for path, number in numbers(value, "output"):
        if isinstance(number, float):
            if not math.isfinite(number):
                return f"{path} is {number}"
        elif not np.isfinite(number).all():
            bad = int(number.size - np.count_nonzero(np.isfinite(number)))
            return f"{path}: {bad} of {number.size} values not finite"
    return ""


def numbers(value: Any, path: str) -> Iterator[tuple[str, Any]]:
    """Yield all floats, arrays and masks in a record, of those within it too, with their paths."""
    if isinstance(value, (float, np.floating)):
        yield path, float(value)
    elif isinstance(value, np.ndarray):
        if value.dtype.kind == "f":
            yield path, value
    elif isinstance(value, (Image, Mask)):
        yield f"{path}.values", value.values
        yield f"{path}.pitch_cm", np.asarray(value.pitch_cm, dtype=np.float64)
        yield f"{path}.origin_cm", np.asarray(value.origin_cm, dtype=np.float64)
    elif isinstance(value, Points):
        yield f"{path}.xy_cm", value.xy_cm
    elif is_dataclass(value) and not isinstance(value, type):
        for field in fields(value):
            if not field.name.startswith("_"):  # what a record keeps for itself is no output
                yield from numbers(getattr(value, field.name), f"{path}.{field.name}")
    elif isinstance(value, (tuple, list)):
        names = getattr(value, "_fields", range(len(value)))
        for name, item in zip(names, value, strict=True):
            yield from numbers(item, f"{path}.{name}")
