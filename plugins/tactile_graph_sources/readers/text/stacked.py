"""Tables with one matrix row a line: matrices between blank lines, or so many rows each."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass, field

import numpy as np

from tactile_graph.errors import DataError
from tactile_graph.wires import Frame
from tactile_graph_sources.readers.head import Head
from tactile_graph_sources.readers.reading import Reading
from tactile_graph_sources.readers.recording_format import RecordingFormat
from tactile_graph_sources.readers.tables.breaks import (
    FRAME_LINE,
    Stamp,
    opens_matrix,
    signature,
    stamp_of,
)
from tactile_graph_sources.readers.tables.layout import Layout
from tactile_graph_sources.readers.tables.sides import of_side
from tactile_graph_sources.readers.tables.table import ENDLESS, is_blank, is_comment, is_padded
from tactile_graph_sources.readers.words.dialect import floats, is_row, refuse_underscore

_DAY_S = 86400.0


def recognises(head: Head) -> bool:
    """Return whether the file is such a table."""
    return head.layout is not None and head.layout.kind == "stacked"


@dataclass
class _Matrix:
    """The matrix being gathered."""

    line: int = 0
    stamp: Stamp = field(default_factory=Stamp)
    number: float = -math.inf
    rows: list[list[float]] = field(default_factory=list)
    n_lines: int = 0
    wrong: str = ""


def read(reading: Reading) -> Iterator[Frame]:
    """Yield a frame for each matrix that has all its rows.

    Raises
    ------
    DataError
        If the settings say another shape.
    """
    layout = reading.head.layout or Layout("stacked")
    if layout.trouble:
        raise DataError(str(reading.path), layout.trouble)
    n_rows = layout.rows - layout.rows_of_sums
    reading.told.agree(str(reading.path), n_rows, len(layout.cells))
    reading.recognised(layout.why, layout.assumed)
    endless, matrix, blanks = layout.blank_run == ENDLESS, _Matrix(), 0
    times = _Times(layout)
    for number, line in of_side(reading.text(), layout.side, str(reading.path)):
        if is_blank(line) and not _is_blank_row(layout, line):
            blanks += 1
            continue
        between, before = _is_between(layout, line), number < layout.first_line
        row = None if between or before else _row_number(layout, line)
        ended = blanks >= layout.blank_run or (endless and matrix.n_lines == layout.rows)
        again = row is not None and row <= matrix.number
        if matrix.n_lines and (between or ended or again or opens_matrix(line)):
            yield from _flush(reading, layout, matrix, times)
            matrix = _Matrix()
        blanks = 0
        matrix.number = matrix.number if row is None else row
        if between:
            matrix.stamp = _joined(matrix.stamp, stamp_of(layout.dialect.pointed(line)))
        elif not (is_comment(line) or (before and not _is_damaged(layout, line))):
            _take(layout, matrix, number, line)
    yield from _flush(reading, layout, matrix, times)


class _Times:
    """Makes seconds of what lines between matrices say; times of day count from the first."""

    def __init__(self, layout: Layout) -> None:
        self._layout = layout
        self._first: float | None = None
        self._last = -math.inf

    def of(self, stamp: Stamp, n: int) -> float | None:
        """Return the time of the ``n``-th matrix; None where nobody says it."""
        if stamp.time is None:
            frame_s = self._layout.said.frame_s
            return None if frame_s is None else n * frame_s
        if not stamp.is_clock:
            factor = self._layout.time_factor if stamp.unit_s is None else stamp.unit_s
            return stamp.time * factor
        at = stamp.time
        while at < self._last - _DAY_S / 2:
            at += _DAY_S
        self._last = at
        self._first = at if self._first is None else self._first
        return round(at - self._first, 6)


def _is_blank_row(layout: Layout, line: str) -> bool:
    """Return whether a line of separators alone is a row without a value."""
    return layout.n_fields > 0 and is_padded(line, layout.dialect, layout.n_fields)


def _is_between(layout: Layout, line: str) -> bool:
    """Return whether a line stands between matrices and says something of the next one."""
    if FRAME_LINE.fullmatch(line) or (layout.header_line and line == layout.header_line):
        return True
    first = signature(line[: len(line) - len(line.lstrip()) + 1])
    if not any(b.startswith(first) for b in layout.breaks):  # as most rows of numbers
        return False
    return signature(layout.dialect.pointed(line)) in layout.breaks


def _joined(one: Stamp, other: Stamp) -> Stamp:
    """Return what several lines between two matrices say."""
    timed = one if other.time is None else other
    return timed._replace(frame=one.frame if other.frame is None else other.frame)


def _row_number(layout: Layout, line: str) -> float | None:
    """Return the number of its row that a line says; None where lines say none, or no number."""
    if "row" not in layout.roles or is_comment(line):
        return None
    try:
        return floats([layout.dialect.texts(line, layout.width)[layout.roles["row"]]])[0]
    except ValueError:
        return None


def _is_damaged(layout: Layout, line: str) -> bool:
    """Return whether a line before the first row is a row that is too long or too short."""
    return is_row(line) and len(layout.dialect.fields(line)) != layout.width


def _take(layout: Layout, matrix: _Matrix, number: int, line: str) -> None:
    matrix.line = matrix.line or number
    matrix.n_lines += 1
    try:
        fields = layout.dialect.texts(line, layout.width)
        refuse_underscore(line)
        if "time" in layout.roles and not matrix.rows:
            time = floats([fields[layout.roles["time"]]])[0]
            matrix.stamp = matrix.stamp._replace(time=time if math.isfinite(time) else None)
        row = floats([fields[k] for k in layout.cells])
    except ValueError as error:
        matrix.wrong = matrix.wrong or f"line {number}: {error}"
    else:
        if len(matrix.rows) <= layout.rows:
            matrix.rows.append(row)


def _flush(reading: Reading, layout: Layout, matrix: _Matrix, times: _Times) -> Iterator[Frame]:
    if not matrix.n_lines:
        return
    if matrix.n_lines != layout.rows and not matrix.wrong:
        matrix.wrong = f"a matrix of {matrix.n_lines} rows, not {layout.rows}"
    if matrix.wrong:
        reading.damaged(matrix.line, matrix.wrong)
    elif (index := matrix.stamp.frame) is None or not reading.is_repeat(
        matrix.line, index, f"frame {index}"
    ):
        said = layout.said
        n = reading.index - reading.start
        yield reading.frame(
            np.array(matrix.rows[: layout.rows - layout.rows_of_sums]),
            pitch_cm=said.pitch_cm,
            quantity=said.quantity,
            factor=said.factor,
            time_s=times.of(matrix.stamp, n),
            own_number=index,
        )


FORMAT = RecordingFormat("table of stacked matrices", recognises, read, plain=True)
