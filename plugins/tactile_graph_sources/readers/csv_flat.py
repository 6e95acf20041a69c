"""Tables with one frame a line, a time or a frame number before the values or not."""

from __future__ import annotations

import re
from collections.abc import Iterator
from typing import NamedTuple

import numpy as np

from tactile_graph.errors import DataError
from tactile_graph.wires import Frame
from tactile_graph.wires.image import QUANTITIES
from tactile_graph_sources.readers.csv_layout import Layout, is_blank, is_comment
from tactile_graph_sources.readers.head import Head
from tactile_graph_sources.readers.reading import Reading
from tactile_graph_sources.readers.told import Told

NAME = "table, one frame a line"
_OWN = re.compile(
    r"# (\d{1,7}) rows, (\d{1,7}) columns, pitch \((\S+), (\S+)\) cm, "
    r"(?:origin \((\S+), (\S+)\) cm, )?(\w+); cells row by row"
)
"""The comment that a table begins with which the project wrote."""


class _Lines(NamedTuple):
    """How a line becomes a frame.

    ``lead`` counts the columns before the values; ``own`` is what the table says of itself.
    """

    layout: Layout
    shape: tuple[int, int]
    lead: int
    own: Told


def recognises(head: Head) -> bool:
    """Return whether the file is such a table."""
    return head.layout is not None and head.layout.kind in ("flat", "unclear")


def read(reading: Reading) -> Iterator[Frame]:
    """Yield a frame for each line that holds the right number of numbers.

    Raises
    ------
    DataError
        If rows and columns are needed and not told, or do not fit.
    """
    layout = reading.head.layout or Layout("unclear")
    if layout.trouble:
        raise DataError(str(reading.path), layout.trouble)
    lead = max(layout.columns.values(), default=-1) + 1
    own = _own_word(reading.head, layout.width - lead)
    lines = _Lines(layout, _shape(reading, own, layout.width - lead), lead, own)
    reading.report.expect(reading.count_bytes(b"\n"))
    header = layout.header
    for number, line in reading.text():
        if is_blank(line) or is_comment(line):
            continue
        try:
            row = layout.dialect.row(line, layout.width)
        except ValueError as error:
            if not header:
                reading.damaged(number, str(error))
            header = False
            continue
        frame = _frame(reading, lines, number, row)
        if frame is not None:
            yield frame


def _own_word(head: Head, n_values: int) -> Told:
    """Return what a table of the project's own says of itself; of any other, nothing."""
    found = _OWN.fullmatch(head.lines[0].strip()) if head.lines else None
    if found is None:
        return Told()
    rows, columns, quantity = int(found[1]), int(found[2]), found[7]
    try:
        x, y, left, top = (float(w or 0) for w in found.group(3, 4, 5, 6))
    except ValueError:
        return Told()
    true = rows * columns == n_values and quantity in QUANTITIES and min(x, y) > 0
    if not true or not np.isfinite([x, y, left, top]).all():
        return Told()  # somebody changed the table, so its comment may be wrong in all
    return Told(rows, columns, (x, y), (left, top), quantity)


def _shape(reading: Reading, own: Told, n_values: int) -> tuple[int, int]:
    told = reading.told
    if own.rows is not None and own.columns is not None:
        told.agree(str(reading.path), own.rows, own.columns)
        return own.rows, own.columns
    return told.shape_of(str(reading.path), n_values)


def _frame(reading: Reading, lines: _Lines, number: int, row: list[float]) -> Frame | None:
    """Return the frame of one line; None where its number was there before."""
    layout, shape, lead, own = lines
    if "frame" in layout.columns:
        index = row[layout.columns["frame"]]
        if reading.is_repeat(number, index, f"frame {index:g}"):
            return None
    time_s = None
    if "time" in layout.columns:
        time_s = row[layout.columns["time"]] * layout.time_factor
        if not np.isfinite(time_s):
            reading.damaged(number, "the time is no number")
            return None
    return reading.frame(
        np.array(row[lead:]).reshape(shape),
        pitch_cm=own.pitch_cm,
        origin_cm=own.origin_cm,
        quantity=own.quantity or "raw",
        time_s=time_s,
    )
