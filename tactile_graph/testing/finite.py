"""Find what is not finite in an answer."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from dataclasses import fields, is_dataclass
from typing import Any

import numpy as np

from tactile_graph.wires import Image, Mask, Points


def not_finite(value: Any) -> str:
    """Return which part of an answer is NaN or infinite, in words; "" where none is.

    What a record keeps for itself (``_name``) is no answer, and the values of invalid and of masked
    cells count for nothing.
    """
    for path, number in numbers(value, ""):
        where = path.lstrip(".") or "the answer"
        if isinstance(number, float):
            if not math.isfinite(number):
                return f"{where} is {number}"
        elif not np.isfinite(number).all():
            bad = int(number.size - np.count_nonzero(np.isfinite(number)))
            return f"{where} holds {bad} of {number.size} numbers that are not finite"
    return ""


def numbers(value: Any, path: str) -> Iterator[tuple[str, Any]]:
    """Yield the floats and arrays of floats of an answer, each with its path: ``.circle.x_cm``."""
    if isinstance(value, float | np.floating):
        yield path, float(value)
    elif isinstance(value, np.ndarray):
        if value.dtype.kind == "f":
            yield path, value.compressed() if isinstance(value, np.ma.MaskedArray) else value
    elif isinstance(value, Image | Mask):
        yield f"{path}.values", value.filled() if isinstance(value, Image) else value.values
        yield f"{path}.pitch_cm", np.asarray(value.pitch_cm, dtype=np.float64)
        yield f"{path}.origin_cm", np.asarray(value.origin_cm, dtype=np.float64)
    elif isinstance(value, Points):
        yield f"{path}.xy_cm", value.xy_cm
    elif is_dataclass(value) and not isinstance(value, type):
        for field in fields(value):
            if not field.name.startswith("_"):
                yield from numbers(getattr(value, field.name), f"{path}.{field.name}")
    elif isinstance(value, Mapping):
        for name, item in value.items():
            yield from numbers(item, f"{path}.{name}")
    elif isinstance(value, tuple | list):
        for name, item in zip(getattr(value, "_fields", range(len(value))), value, strict=True):
            yield from numbers(item, f"{path}.{name}")
