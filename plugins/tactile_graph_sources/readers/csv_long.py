"""Tables with one cell a line under a header such as ``frame,row,col,value``, in any order."""

from __future__ import annotations

from array import array
from collections.abc import Iterator

import numpy as np
from numpy.typing import NDArray

from tactile_graph.wires import Frame
from tactile_graph_sources.readers.csv_layout import Layout, is_blank, is_comment
from tactile_graph_sources.readers.dialect import refuse_underscore
from tactile_graph_sources.readers.head import Head
from tactile_graph_sources.readers.reading import Reading

NAME = "table, one cell a line (frame, row, col, value)"
_LARGEST = 1e6


def recognises(head: Head) -> bool:
    """Return whether the file is such a table."""
    return head.layout is not None and head.layout.kind == "long"


def read(reading: Reading) -> Iterator[Frame]:
    """Yield a frame for each frame number, in the order in which the numbers first appear.

    The cells may come in any order, so all are gathered first, as 44 bytes each. A cell the
    file leaves out is invalid. Numbers start at 0 if any row or column is 0, else at 1.
    """
    cells, lines = _gather(reading, reading.head.layout or Layout("long"))
    if not len(cells):
        return
    frame, row, column = cells[:, 0], cells[:, 2].astype(np.intp), cells[:, 3].astype(np.intp)
    first = 0 if min(row.min(), column.min()) == 0 else 1
    rows = reading.told.rows or int(row.max()) + 1 - first
    columns = reading.told.columns or int(column.max()) + 1 - first
    reading.told.agree(str(reading.path), rows, columns)
    numbers, starts, group = np.unique(frame, return_index=True, return_inverse=True)
    reading.report.expect(len(numbers))
    order = np.argsort(group, kind="stable")
    ends = np.cumsum(np.bincount(group))
    for k in np.argsort(starts):
        mine = order[ends[k - 1] if k else 0 : ends[k]]
        place = (row[mine] - first) * columns + column[mine] - first
        inside = (row[mine] < rows + first) & (column[mine] < columns + first)
        kept = _first_of_each(reading, f"frame {numbers[k]:g}", place, inside, lines[mine])
        values = np.full(rows * columns, np.nan)
        values[place[kept]] = cells[mine[kept], 4]
        time_s = cells[mine[0], 1]
        yield reading.frame(
            values.reshape(rows, columns), time_s=None if np.isnan(time_s) else float(time_s)
        )


def _first_of_each(
    reading: Reading,
    name: str,
    place: NDArray[np.intp],
    inside: NDArray[np.bool_],
    lines: NDArray[np.int32],
) -> NDArray[np.intp]:
    """Return which cells of a frame are kept: those on the pad, and the first of each place."""
    if not inside.all():
        stray = int(np.flatnonzero(~inside)[0])
        n = int(np.count_nonzero(~inside))
        reading.damaged(int(lines[stray]), f"{name}: {n} cells outside the told shape")
    candidates = np.flatnonzero(inside)
    _, first = np.unique(place[candidates], return_index=True)
    if len(first) < len(candidates):
        again = int(np.setdiff1d(np.arange(len(candidates)), first)[0])
        reading.report.count("repeated cells dropped", len(candidates) - len(first))
        reading.report.trouble(
            reading.at(int(lines[candidates[again]])),
            f"{name}: {len(candidates) - len(first)} cells come again; the first ones are kept",
        )
    return candidates[first]


def _gather(reading: Reading, layout: Layout) -> tuple[NDArray[np.float64], NDArray[np.int32]]:
    """Return frame, time (s), row, column and value of each cell, shape (N, 5), and its line."""
    dialect, where = layout.dialect, layout.columns
    frame, time = where.get("frame", where.get("time")), where.get("time")
    row, column, value = where["row"], where["column"], where["value"]
    cells, lines = array("d"), array("i")
    started = False
    for number, line in reading.text():
        if is_blank(line) or is_comment(line):
            continue
        fields = dialect.fields(line)
        try:
            refuse_underscore(line)
            index = 0.0 if frame is None else float(fields[frame])
            time_s = np.nan if time is None else float(fields[time]) * layout.time_factor
            r, c = float(fields[row]), float(fields[column])
            v = float(fields[value] or "nan")
            if not (
                0 <= r < _LARGEST and 0 <= c < _LARGEST and r % 1 == c % 1 == 0 == index - index
            ):
                raise ValueError(f"row {r:g} and column {c:g} are no place on a pad")
        except (ValueError, IndexError) as error:
            if started:
                reading.damaged(number, f"no cell: {str(error)[:80]}")
            started = True  # the header
            continue
        cells.extend((index, time_s, r, c, v))
        lines.append(number)
    table = np.frombuffer(cells, dtype=np.float64) if cells else np.empty(0)
    return table.reshape(-1, 5), np.frombuffer(lines, dtype=np.intc) if lines else np.empty(0, "i")
