"""Display lists as plain data: what the page draws, in cm of the pad."""

from __future__ import annotations

from base64 import b64encode
from collections.abc import Iterable, Iterator
from typing import Any

import numpy as np
from numpy.typing import NDArray

from tactile_graph.draw.display import (
    Area,
    Cells,
    Cross,
    Dots,
    Heat,
    Label,
    Note,
    Number,
    Outline,
    Record,
    Rim,
    printed,
)
from tactile_graph.foreign_text import visible
from tactile_graph.wires import Image, Mask

NO_READING = 255
HIGHEST = 254
MOST_EXACT = 4096
"""Cells of the largest pad whose readings go along exactly, beside their colours."""
SEVEN_DIGITS = 1e7
"""Size below which a number of float32 has its whole digits right."""
LEAST_FLOAT32 = 1e-37
LONGEST_NOTE = 200
MOST_PLACES = 4000
"""Corners or points of one shape, at most: a page is no place for more."""
Plain = dict[str, Any]


def picture(image: Image, low: float | None = None, high: float | None = None) -> Plain:
    """Return an image as the page has it: bytes from ``low`` to ``high``, and where they lie.

    Parameters
    ----------
    image : Image
    low, high : float, optional
        What the bytes 0 and 254 stand for; the image's own range (from 0, where it has no values
        below) if not given.
    """
    values, good = _values(image)
    seen = values if good.all() else values[good]
    low = min(float(seen.min(initial=0.0)), 0.0) if low is None else low
    high = max(float(seen.max(initial=0.0)), low) if high is None else high
    scaled = np.clip((values - low) * (HIGHEST / ((high - low) or 1.0)), 0.0, HIGHEST)
    levels = np.where(good, np.nan_to_num(scaled), NO_READING).astype(np.uint8)
    return {**_grid(image), "quantity": image.quantity, "unit": image.unit,
            "low": low, "high": high, "values": b64encode(levels.tobytes()).decode()}  # fmt: skip


def readings(image: Image) -> str | None:
    """Return what each cell reads: base64 of numbers, least byte first; None for a large pad.

    They are NaN where there is no reading; float32 where seven digits tell each, otherwise float64.
    """
    values, good = _values(image)
    if values.size > MOST_EXACT:
        return None
    values = np.where(good, values, np.nan)
    size = np.abs(values)
    told = (
        np.fmax.reduce(size, axis=None, initial=0.0) < SEVEN_DIGITS
        and not ((size > 0.0) & (size < LEAST_FLOAT32)).any()
    )
    return b64encode(values.astype("<f4" if told else "<f8").tobytes()).decode()


def _values(image: Image) -> tuple[NDArray[np.float64], NDArray[np.bool_]]:
    """Return an image's values, and which of them are readings."""
    values = np.asarray(image.values, dtype=np.float64)
    finite = np.isfinite(values)
    return values, finite if image.valid is None else image.valid & finite


def _grid(grid: Image | Mask) -> Plain:
    return {"rows": grid.rows, "columns": grid.columns,
            "pitch_cm": list(grid.pitch_cm), "origin_cm": list(grid.origin_cm)}  # fmt: skip


def shapes(records: Iterable[Record], node: str = "") -> list[Plain]:
    """Return a display list as plain data; what is nowhere (NaN) is left out."""
    return [shape for record in records for shape in _shapes(record, node)]


def _shapes(record: Record, node: str) -> Iterator[Plain]:
    if isinstance(record, Heat):
        yield {"shape": "heat", "node": node, "image": picture(record.image)}
    elif isinstance(record, Cells):
        yield {"shape": "cells", "node": node, "image": _cells(record.mask)}
    elif isinstance(record, Note):
        text = visible(printed(record.value, LONGEST_NOTE))
        yield {"shape": "note", "node": node, "name": visible(record.name), "value": text}
    else:
        role = getattr(record, "role", "found")
        for told in _drawn(record):
            yield {"role": role, "node": node, **told}


def _cells(mask: Mask) -> Plain:
    values = b64encode(mask.values.astype(np.uint8).tobytes()).decode()
    return {**_grid(mask), "values": values}


def _drawn(record: Record) -> Iterator[Plain]:
    if isinstance(record, Outline) and record.circle is not None:
        circle = record.circle
        at = (circle.x_cm, circle.y_cm, circle.radius_cm)
        if np.isfinite(at).all():
            yield {"shape": "circle", "x": _r(at[0]), "y": _r(at[1]), "radius": _r(at[2])}
    elif isinstance(record, Outline):
        yield {"shape": "polygon" if record.closed else "polyline", "xy": _places(record.xy_cm)}
    elif isinstance(record, Area):
        yield {"shape": "polygon", "xy": _places(record.xy_cm), "fill": True}
    elif isinstance(record, Dots):
        yield {"shape": "points", "xy": _places(record.xy_cm)}
    elif isinstance(record, Rim):
        yield {"shape": "segments", "xy": np.round(record.edges_cm[:MOST_PLACES], 3).tolist()}
    elif isinstance(record, Cross) and np.isfinite((record.x_cm, record.y_cm)).all():
        yield {"shape": "cross", "x": _r(record.x_cm), "y": _r(record.y_cm)}
    elif isinstance(record, Label | Number) and np.isfinite((record.x_cm, record.y_cm)).all():
        text = visible(record.text)[:LONGEST_NOTE]
        yield {"shape": "text", "x": _r(record.x_cm), "y": _r(record.y_cm), "text": text}


def _r(value: float) -> float:
    return round(float(value), 4)


def _places(xy_cm: NDArray[np.float64]) -> list[list[float]]:
    xy = np.asarray(xy_cm, dtype=np.float64).reshape(-1, 2)[:MOST_PLACES]
    found: list[list[float]] = np.round(xy[np.isfinite(xy).all(axis=1)], 4).tolist()
    return found
