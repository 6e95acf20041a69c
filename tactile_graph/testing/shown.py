"""Find what an answer says of itself that cannot be shown: columns, drawing, errors."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from functools import partial
from typing import Any

import numpy as np

from tactile_graph.draw.display import display_list
from tactile_graph.engine.tables.rows import scalars
from tactile_graph.engine.tables.truth import errors_against, shape_kind
from tactile_graph.errors import text_of
from tactile_graph.wires import TrueObject


def unshown(value: Any) -> str:
    """Return what of an answer cannot be shown to people, and why; "" where all can."""
    for what, attempt in _shows(value):
        try:
            attempt()
        except Exception as error:  # a plugin's own code may raise anything
            return f"its {what} cannot be had: {type(error).__name__}: {_line(error)}"
    return ""


def _shows(value: Any) -> Iterator[tuple[str, Callable[[], Any]]]:
    yield "columns", lambda: scalars("value", value)
    yield "drawing", lambda: _drawn(value)
    for item in value if isinstance(value, list | tuple) else (value,):
        if shape_kind(type(item)) is not None:
            yield "error against the truth", partial(_measured, item)


def _drawn(value: Any) -> None:
    for record in display_list(value):
        xy = np.asarray(getattr(record, "xy_cm", np.zeros((0, 2))))
        if xy.ndim != 2 or xy.shape[1] != 2:
            raise ValueError(f"places have the shape {xy.shape}, (places, 2) is needed")


def _measured(shape: Any) -> None:
    """Hold a shape against itself: it is not off."""
    for name, off in errors_against(shape, TrueObject(shape)).items():
        if math.isfinite(off) and abs(off) > 1e-9:
            raise ValueError(f"{name} of a shape against itself is {off:g}, not 0")


def _line(error: Exception) -> str:
    return " ".join(text_of(error).split())
