"""Tables with one matrix row a line: matrices between blank lines, or so many rows each."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field

import numpy as np

from tactile_graph.errors import DataError
from tactile_graph.wires import Frame
from tactile_graph_sources.readers.head import Head
from tactile_graph_sources.readers.reading import Reading
from tactile_graph_sources.readers.tables.dialect import floats, is_row, refuse_underscore
from tactile_graph_sources.readers.tables.layout import Layout
from tactile_graph_sources.readers.tables.table import ENDLESS, FRAME_LINE, is_blank, is_comment

NAME = "table of stacked matrices"


def recognises(head: Head) -> bool:
    """Return whether the file is such a table."""
    return head.layout is not None and head.layout.kind == "stacked"


@dataclass
class _Matrix:
    """The matrix being gathered."""

    line: int = 0
    index: int | None = None
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
    reading.told.agree(str(reading.path), layout.rows, len(layout.cells))
    reading.recognised(layout.why, layout.assumed)
    endless, matrix, blanks = layout.blank_run == ENDLESS, _Matrix(), 0
    for number, line in reading.text():
        if is_blank(line):
            blanks += 1
            continue
        label, before = FRAME_LINE.fullmatch(line), number < layout.first_line
        if label or blanks >= layout.blank_run or (endless and matrix.n_lines == layout.rows):
            yield from _flush(reading, layout, matrix)
            matrix = _Matrix(index=int(label[1]) if label else None)
        blanks = 0
        if not (label or is_comment(line) or (before and not _is_damaged(layout, line))):
            _take(layout, matrix, number, line)
    yield from _flush(reading, layout, matrix)


def _is_damaged(layout: Layout, line: str) -> bool:
    """Return whether a line before the first row is a row that is too long or too short."""
    return is_row(line) and len(layout.dialect.fields(line)) != layout.width


def _take(layout: Layout, matrix: _Matrix, number: int, line: str) -> None:
    matrix.line = matrix.line or number
    matrix.n_lines += 1
    try:
        fields = layout.dialect.texts(line, layout.width)
        refuse_underscore(line)
        row = floats([fields[k] for k in layout.cells])
    except ValueError as error:
        matrix.wrong = matrix.wrong or f"line {number}: {error}"
    else:
        if len(matrix.rows) <= layout.rows:
            matrix.rows.append(row)


def _flush(reading: Reading, layout: Layout, matrix: _Matrix) -> Iterator[Frame]:
    if not matrix.n_lines:
        return
    if matrix.n_lines != layout.rows and not matrix.wrong:
        matrix.wrong = f"a matrix of {matrix.n_lines} rows, not {layout.rows}"
    if matrix.wrong:
        reading.damaged(matrix.line, matrix.wrong)
    elif matrix.index is None or not reading.is_repeat(
        matrix.line, matrix.index, f"frame {matrix.index}"
    ):
        said = layout.said
        n = reading.index - reading.start
        yield reading.frame(
            np.array(matrix.rows),
            pitch_cm=said.pitch_cm,
            quantity=said.quantity,
            factor=said.factor,
            time_s=None if said.frame_s is None else n * said.frame_s,
        )
