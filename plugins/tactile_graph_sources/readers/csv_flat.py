"""Tables with one frame a line, a time or a frame number before the values or not."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from tactile_graph.errors import DataError
from tactile_graph.wires import Frame
from tactile_graph_sources.readers.csv_layout import Layout, is_blank, is_comment
from tactile_graph_sources.readers.head import Head
from tactile_graph_sources.readers.reading import Reading

NAME = "table, one frame a line"


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
    rows, columns = reading.told.shape_of(str(reading.path), layout.width - lead)
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
        frame = _frame(reading, layout, number, row, (rows, columns), lead)
        if frame is not None:
            yield frame


def _frame(
    reading: Reading,
    layout: Layout,
    number: int,
    row: list[float],
    shape: tuple[int, int],
    lead: int,
) -> Frame | None:
    """Return the frame of one line; None where its number was there before."""
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
    return reading.frame(np.array(row[lead:]).reshape(shape), time_s=time_s)
