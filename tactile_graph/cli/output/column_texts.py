"""Columns of cells as text: numbers as Python writes them, and lines of CSV."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from functools import cache
from typing import Any

import numpy as np

from tactile_graph.foreign_text import csv_line

LEAST_PLAIN, LEAST_LARGE = 1e-4, 1e16
"""Sizes from which on and below which numbers are written without an exponent, by everybody."""


def number_texts(numbers: Sequence[int] | Sequence[float]) -> Sequence[str]:
    """Return numbers of one type, ``int`` or ``float``, each as ``repr`` writes it.

    With orjson, which the extra ``fast`` brings, floats take a tenth of the time.
    """
    dumps = _dumps()
    if dumps is None or not numbers or numbers[0].__class__ is not float:
        return [*map(repr, numbers)]
    texts: list[str] = dumps(numbers)[1:-1].decode().split(",")
    sizes = np.abs(np.array(numbers))
    plain = ((sizes >= LEAST_PLAIN) & (sizes < LEAST_LARGE)) | (sizes == 0.0)
    for i in np.flatnonzero(~plain).tolist():
        texts[i] = repr(numbers[i])
    return texts


@cache
def _dumps() -> Callable[[Any], Any] | None:
    try:
        import orjson
    except ImportError:
        return None
    dumps: Callable[[Any], Any] = orjson.dumps
    return dumps


def csv_lines(columns: Sequence[Sequence[Any]]) -> str:
    """Return lines of CSV by their columns, each line as `csv_line` gives it."""
    lines = map(",".join, zip(*map(_csv_texts, columns), strict=True))
    return "\n".join([*lines, ""])


def _csv_texts(cells: Sequence[Any]) -> Sequence[str]:
    kinds = {cell.__class__ for cell in cells}
    filled = kinds - {type(None)}
    if filled <= {str}:
        told = {cell: _csv_text(cell) for cell in {*cells}}
        return [told[cell] for cell in cells]
    if filled not in ({int}, {float}):
        return [*map(_csv_text, cells)]
    if filled == kinds:
        return number_texts(cells)
    numbers = iter(number_texts([cell for cell in cells if cell is not None]))
    return ["" if cell is None else next(numbers) for cell in cells]


def _csv_text(cell: Any) -> str:
    return csv_line([cell, None])[:-2]  # alone an empty one would be in quotes
