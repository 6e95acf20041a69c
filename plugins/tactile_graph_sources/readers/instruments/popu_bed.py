"""Bed-mat recordings in JSON: ``snapshots`` of ``tactilus_readings``."""

from __future__ import annotations

import json
from collections.abc import Iterator
from typing import Any

import numpy as np

from tactile_graph.errors import DataError
from tactile_graph.wires import Frame
from tactile_graph_sources.readers.head import Head
from tactile_graph_sources.readers.reading import Reading
from tactile_graph_sources.readers.recording_format import RecordingFormat

SHAPE = (64, 27)
_KEY = "tactilus_readings"


def recognises(head: Head) -> bool:
    """Return whether the file is a JSON object with such readings."""
    raw = head.raw.removeprefix(b"\xef\xbb\xbf").lstrip()
    return raw.startswith(b"{") and (_KEY.encode() in raw or b'"snapshots"' in raw)


def read(reading: Reading) -> Iterator[Frame]:
    """Yield a frame for each snapshot with the right number of readings.

    Raises
    ------
    DataError
        If the file is no JSON, or has no ``snapshots``.
    """
    reading.refuse_settings()
    where = str(reading.path)
    try:
        with reading.path.open(encoding=reading.head.encoding) as file:
            record = json.load(file)
        snapshots = record["snapshots"]
        entries = snapshots.items() if isinstance(snapshots, dict) else enumerate(snapshots)
        listed = [(str(name), entry) for name, entry in entries]
    except (ValueError, KeyError, TypeError, RecursionError) as error:
        raise DataError(where, f"no JSON object with snapshots: {error}") from error
    rows = _size(record, "tactilus_rows", reading.told.rows or SHAPE[0])
    columns = _size(record, "tactilus_columns", reading.told.columns or SHAPE[1])
    reading.told.agree(where, rows, columns)
    reading.recognised("a JSON object with snapshots of tactilus_readings")
    reading.report.expect(len(listed))
    for name, entry in listed:
        values = _values(entry)
        if values is None or values.size != rows * columns:
            got = "no list of numbers" if values is None else f"{values.size} readings"
            reading.damaged(f"snapshot {name}", f"{got}, not {rows} x {columns}")
        else:
            yield reading.frame(values.reshape(rows, columns))


def _size(record: dict[str, Any], key: str, otherwise: int) -> int:
    size = record.get(key)
    return size if isinstance(size, int) and not isinstance(size, bool) else otherwise


def _values(entry: object) -> np.ndarray[Any, np.dtype[np.float64]] | None:
    readings = entry.get(_KEY) if isinstance(entry, dict) else None
    if not isinstance(readings, list) or not all(type(v) in (int, float) for v in readings):
        return None
    try:
        return np.array(readings, dtype=np.float64)
    except (ValueError, OverflowError):
        return None


FORMAT = RecordingFormat("bed mat .json (tactilus_readings)", recognises, read)
