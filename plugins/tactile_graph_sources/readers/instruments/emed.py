"""novel emed exports (``.lst``)."""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass, field
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from tactile_graph.wires import Frame
from tactile_graph_sources.readers.head import Head
from tactile_graph_sources.readers.reading import Reading
from tactile_graph_sources.readers.recording_format import RecordingFormat
from tactile_graph_sources.readers.words.dialect import floats, refuse_underscore
from tactile_graph_sources.readers.words.units import length_cm

_MATRIX = re.compile(r"Matrix:\s*(\d{1,6})\s*x\s*(\d{1,6})")
_SIZE = re.compile(r"Sensor size:\s*([\d.,]+)\s*x\s*([\d.,]+)\s*(\w+)")
_TIME = re.compile(r"Time/picture:\s*([\d.,]+)\s*ms")
_PICTURE = re.compile(r"Pict-No\.?:\s*(\d{1,9})")
_PAGE = re.compile(r"\f?\s*Page\s+\d+")
_TIE = 0.02  # forces are printed to 0.01 N
N_PER_KPA_CM2 = 0.1


def recognises(head: Head) -> bool:
    """Return whether the file's first page is one of emed's."""
    first = "\n".join(head.first(40))
    return "Pict-No" in first or ("Sensor size:" in first and "Matrix:" in first)


@dataclass
class _Page:
    """One page: a window of the platform, with the labels of its rows and columns."""

    line: int
    columns: list[int] = field(default_factory=list)
    rows: list[int] = field(default_factory=list)
    values: list[list[float]] = field(default_factory=list)
    force_n: float | None = None
    wrong: str = ""


@dataclass
class _State:
    """What the headers said so far, and the picture being gathered."""

    rows: int = 0
    columns: int = 0
    pitch_cm: tuple[float, float] | None = None
    seconds: float | None = None
    number: int | None = None
    page: _Page | None = None
    picture: int | None = None
    pages: list[_Page] = field(default_factory=list)
    broken: tuple[int, frozenset[int]] = (-1, frozenset())


def read(reading: Reading) -> Iterator[Frame]:
    """Yield a frame for each picture, on the whole platform; cells outside its window hold 0.

    A picture whose window needs several pages is put together. Pages without a ``Pict-No.`` are
    summaries and left out, and so are the forces in the last row and column.
    """
    reading.refuse_settings()
    reading.report.expect(reading.count_bytes(b"Pict-No"))
    state = _State()
    for number, line in reading.text():
        if _PAGE.match(line):
            _end_page(reading, state)
            state.number = None
        elif state.page is None:
            _header(reading, state, number, line)
        else:
            _body(reading, state, number, line)
        if state.pages and state.number not in (None, state.picture):
            yield from _flush(reading, state)
    _end_page(reading, state)
    yield from _flush(reading, state)


def _header(reading: Reading, state: _State, number: int, line: str) -> None:
    if found := _MATRIX.search(line):
        state.columns, state.rows = int(found[1]), int(found[2])
        reading.told.agree(str(reading.path), state.rows, state.columns)
    if found := _SIZE.search(line):
        x, y = length_cm(found[1], found[3]), length_cm(found[2], found[3])
        state.pitch_cm = (x, y) if x and y else None
    if found := _TIME.search(line):
        seconds = [s for s in _numbers([found[1]]) if np.isfinite(s)]
        state.seconds = seconds[0] * 1e-3 if seconds else None
    if found := _PICTURE.search(line):
        state.number = int(found[1])
    labels = line.split()
    if len(labels) > 1 and all(w.isdecimal() and len(w) < 7 for w in labels[:-1]):
        last = [labels[-1]] if labels[-1].isdecimal() and len(labels[-1]) < 7 else []
        if state.number is None:
            reading.report.count("summary pages left out")
        elif labels[-1].startswith("Force") or last:
            state.page = _Page(number, [int(w) for w in labels[:-1] + last])


def _numbers(fields: list[str]) -> list[float]:
    try:
        refuse_underscore("".join(fields))
        return floats([f.replace(",", ".") for f in fields])
    except ValueError:
        return []


def _body(reading: Reading, state: _State, number: int, line: str) -> None:
    page = state.page
    fields = line.split()
    if page is None or not fields:
        return
    if fields[0] == "Force":
        forces = _numbers(fields[1:])
        page.force_n = forces[-1] if len(forces) == len(page.columns) + 1 else None
        _end_page(reading, state)
        return
    values = _numbers(fields[1 : len(page.columns) + 1])
    in_order = fields[0].isdecimal() and len(fields[0]) < 7
    if not in_order or len(values) != len(page.columns) or len(fields) > len(values) + 2:
        page.wrong = page.wrong or (
            f"line {number}: expected a row number and {len(page.columns)} values, "
            f"got {line.strip()[:40]!r}"
        )
        return
    page.rows.append(int(fields[0]))
    page.values.append(values)


def _end_page(reading: Reading, state: _State) -> None:
    """Put a page that is whole to its picture."""
    page, state.page = state.page, None
    if page is None or state.number is None:
        return
    if page.force_n is None and not page.wrong:
        page.wrong = "the page ends before its row of forces"
    labels = ((page.rows, state.rows, "row"), (page.columns, state.columns, "column"))
    for numbers, most, what in labels:
        if not numbers or not 1 <= min(numbers) <= max(numbers) <= most:
            page.wrong = page.wrong or f"{what} numbers outside 1 to {most}"
        elif any(b != a + 1 for a, b in pairwise(numbers)):
            page.wrong = page.wrong or f"{what} numbers that are not consecutive"
    if page.wrong:
        first = state.broken[0] != state.number  # of the pages of a picture
        what = f"picture {state.number}: {page.wrong}"
        reading.damaged(page.line, what, n_frames=int(first))
        state.broken = (state.number, frozenset(page.columns))
        return
    if state.pages and state.picture == state.number and _overlap(page, state.pages):
        reading.repeated(page.line, f"picture {state.number}")
        return
    state.picture = state.number
    state.pages.append(page)


def _overlap(page: _Page, others: list[_Page]) -> bool:
    rows, columns = set(page.rows), set(page.columns)
    return any(rows & set(o.rows) and columns & set(o.columns) for o in others)


def _flush(reading: Reading, state: _State) -> Iterator[Frame]:
    pages, state.pages = state.pages, []
    if not pages or state.picture is None:
        return
    name = f"picture {state.picture}"
    held = {c for page in pages for c in page.columns}
    if state.broken[0] == state.picture and not state.broken[1] <= held:
        return  # one of its pages is missing; that page's damage is reported
    if reading.is_repeat(pages[0].line, state.picture, name):
        return
    values = np.zeros((state.rows, state.columns))
    for page in pages:
        values[
            page.rows[0] - 1 : page.rows[0] - 1 + len(page.rows),
            page.columns[0] - 1 : page.columns[0] - 1 + len(page.columns),
        ] = page.values
    time_s = None if state.seconds is None else (state.picture - 1) * state.seconds
    frame = reading.frame(
        values,
        pitch_cm=state.pitch_cm,
        quantity="kilopascal",
        time_s=time_s,
        own_number=state.picture,
    )
    _check_force(reading, name, pages, values, state.pitch_cm)
    yield frame


def _check_force(
    reading: Reading,
    name: str,
    pages: list[_Page],
    values: NDArray[np.float64],
    pitch_cm: tuple[float, float] | None,
) -> None:
    """Note a picture whose values do not add up to the vendor's force; it is kept."""
    if len(pages) != 1 or pages[0].force_n is None or pitch_cm is None:
        return
    force_n = float(np.nansum(values)) * pitch_cm[0] * pitch_cm[1] * N_PER_KPA_CM2
    if abs(force_n - pages[0].force_n) > _TIE + 1e-3 * abs(force_n):
        reading.report.count("sums that differ from the vendor's")
        reading.report.trouble(
            reading.at(pages[0].line),
            f"{name} adds up to {force_n:.2f} N, the page says {pages[0].force_n:.2f} N; "
            "the frame is kept",
        )


FORMAT = RecordingFormat("novel emed .lst", recognises, read)
