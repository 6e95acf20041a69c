"""Tekscan I-Scan and F-Scan exports (``.asf``, ``.csv``)."""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass, field

import numpy as np

from tactile_graph.errors import DataError
from tactile_graph.wires import Frame
from tactile_graph_sources.readers.head import Head
from tactile_graph_sources.readers.reading import Reading
from tactile_graph_sources.readers.recording_format import RecordingFormat
from tactile_graph_sources.readers.words.dialect import Dialect
from tactile_graph_sources.readers.words.units import length_cm, pressure_unit, taken_as_they_are

_FRAME = re.compile(r"Frame\s+(\d{1,9})\b[\s,;]*(\d[\d.]*)?", re.IGNORECASE)
_RAW_SUM = re.compile(r"Raw Sum=?[\s,;]*(\d[\d.]*)", re.IGNORECASE)
_BLANKS = " \t,;"


def recognises(head: Head) -> bool:
    """Return whether the file has a Tekscan header."""
    first = head.first(200)
    return any(line.startswith("ASCII_DATA") for line in first) or (
        bool(first) and first[0].startswith("DATA_TYPE ")
    )


@dataclass
class _Block:
    """The rows between one ``Frame`` line and the next."""

    line: int
    number: int
    title: str
    time_s: float | None
    rows: list[tuple[int, str]] = field(default_factory=list)


@dataclass(frozen=True)
class _Header:
    rows: int
    columns: int
    pitch_cm: tuple[float, float] | None
    quantity: str
    factor: float
    seconds_per_frame: float | None
    dialect: Dialect


def read(reading: Reading) -> Iterator[Frame]:
    """Yield a frame for each ``Frame`` block that has all its rows.

    ``B`` says that the sensor has no cell there; such cells are invalid. Times are those of the
    ``Frame`` lines, else the frame's number times ``SECONDS_PER_FRAME``.
    """
    reading.refuse_settings()
    lines = reading.text()
    keys: dict[str, str] = {}
    for _, line in lines:
        key, _, value = line.strip(_BLANKS).partition(" ")
        if key == "ASCII_DATA":
            break
        keys.setdefault(key, value.strip())
    header = _header(reading, keys)
    block: _Block | None = None
    for number, line in lines:
        text = line.strip()
        start = _start(header.dialect, text)
        if start or text.startswith("@@"):
            yield from _flush(reading, header, block)
            block = _open(header, number, start) if start else None
            if not start:
                break
        elif text.strip(_BLANKS):
            if block is None:
                what = f"expected a Frame line, got {text[:40]!r}"
                reading.damaged(number, what, n_frames=0)
            else:
                block.rows.append((number, text))
    yield from _flush(reading, header, block)


def _header(reading: Reading, keys: dict[str, str]) -> _Header:
    where = str(reading.path)
    try:
        rows = reading.told.rows or int(keys["ROWS"].strip(_BLANKS))
        columns = reading.told.columns or int(keys["COLS"].strip(_BLANKS))
    except (KeyError, ValueError) as error:
        raise DataError(
            where, f"the Tekscan header gives no ROWS and COLS ({error}); give rows and columns"
        ) from error
    reading.told.agree(where, rows, columns)
    x, y = length_cm(keys.get("COL_SPACING", "")), length_cm(keys.get("ROW_SPACING", ""))
    unit = keys.get("UNITS", "raw").strip(_BLANKS)
    quantity, factor = pressure_unit(unit)
    for note in taken_as_they_are(unit):
        reading.assume(note)
    first, last = keys.get("START_FRAME", ""), keys.get("END_FRAME", "")
    if first.isdecimal() and last.isdecimal() and 0 <= int(last[:9]) - int(first[:9]) < 10**7:
        reading.report.expect(int(last[:9]) - int(first[:9]) + 1)
    seconds = _number(keys.get("SECONDS_PER_FRAME", ""))
    pitch_cm = (x, y) if x and y else None
    return _Header(rows, columns, pitch_cm, quantity, factor, seconds, _dialect(reading.head))


def _dialect(head: Head) -> Dialect:
    """Return how the first rows are written: vendors part the cells by commas, others by tabs."""
    lines = head.first(200)
    start = next((k for k, line in enumerate(lines) if line.startswith("ASCII_DATA")), -1)
    texts = [line.strip() for line in lines[start + 1 :]]
    rows = [text for text in texts if not (_FRAME.match(text) or text.startswith("@@"))]
    return Dialect.of([row.replace("B", "0") for row in rows] or [","])


def _number(text: str) -> float | None:
    try:
        number = float(text.strip(_BLANKS).replace(",", "."))
    except ValueError:
        return None
    return number if np.isfinite(number) else None


def _open(header: _Header, line: int, start: re.Match[str]) -> _Block:
    number = int(start[1])
    time_s = _number(start[2]) if start[2] else None
    if time_s is None and header.seconds_per_frame is not None:
        time_s = (number - 1) * header.seconds_per_frame
    return _Block(line, number, start.string, time_s)


def _start(dialect: Dialect, text: str) -> re.Match[str] | None:
    """Return number and time of a frame that a line opens; what follows the number parts them."""
    start = _FRAME.match(text)
    behind = start.end(1) + 1 if start else 0
    return start and _FRAME.match(text[:behind] + dialect.pointed(text[behind:]))


def _flush(reading: Reading, header: _Header, block: _Block | None) -> Iterator[Frame]:
    if block is None:
        return
    name = f"frame {block.number}"
    if len(block.rows) != header.rows:
        reading.damaged(block.line, f"{name} has {len(block.rows)} rows, not {header.rows}")
        return
    values = np.empty((header.rows, header.columns))
    for k, (number, text) in enumerate(block.rows):
        try:
            values[k] = header.dialect.row(text.replace("B", "nan"), header.columns)
        except ValueError as error:
            reading.damaged(number, f"{name}: {error}")
            return
    if reading.is_repeat(block.line, block.number, name):
        return
    frame = reading.frame(
        values,
        pitch_cm=header.pitch_cm,
        quantity=header.quantity,
        factor=header.factor,
        time_s=block.time_s,
        own_number=block.number,
    )
    _check_sum(reading, block, frame, header.quantity)
    yield frame


def _check_sum(reading: Reading, block: _Block, frame: Frame, quantity: str) -> None:
    """Note a frame whose values do not add up to what the vendor says; it is kept."""
    said = _RAW_SUM.search(block.title)
    if said and quantity == "raw" and abs((_number(said[1]) or 0.0) - frame.image.total) > 0.5:
        reading.report.count("sums that differ from the vendor's")
        reading.report.trouble(
            reading.at(block.line),
            f"frame {block.number} adds up to {frame.image.total:g}, "
            f"its Raw Sum says {said[1]}; the frame is kept",
        )


FORMAT = RecordingFormat("Tekscan .asf/.csv", recognises, read)
