"""Tables with one cell a line under a header such as ``frame,row,col,value``, in any order."""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator
from itertools import islice

import numpy as np
from numpy.typing import NDArray

from tactile_graph.errors import DataError
from tactile_graph.wires import Frame
from tactile_graph_sources.readers.head import Head
from tactile_graph_sources.readers.reading import FEWEST_COUNTED, Reading
from tactile_graph_sources.readers.recording_format import RecordingFormat
from tactile_graph_sources.readers.tables.layout import Layout, of_sensor, refuse_other_unit
from tactile_graph_sources.readers.tables.sides import of_side
from tactile_graph_sources.readers.tables.table import is_blank, is_comment
from tactile_graph_sources.readers.text.cell_places import (
    first_number,
    refuse_no_grid,
    stated_origin_cm,
)
from tactile_graph_sources.readers.text.several_pads import refuse_several_pads
from tactile_graph_sources.readers.text.stamps import Stamps
from tactile_graph_sources.readers.words.dialect import floats, refuse_underscore
from tactile_graph_sources.readers.words.own_number import number_text

Cells = NDArray[np.float64]
_LARGEST = 1e6
STRAY, FAR = 0.1, 1.0
"""Share of the usual number of cells of a row that makes it one of them, and how far beyond the
others, in their own extent, a row must lie to be none."""
_BATCH = 4096


def recognises(head: Head) -> bool:
    """Return whether the file is such a table."""
    return head.layout is not None and head.layout.kind == "long"


def read(reading: Reading) -> Iterator[Frame]:
    """Yield a frame for each frame number, in the order in which the numbers first appear.

    The cells may come in any order, so all are gathered first, as 48 bytes each. Where the cells
    of several frames come mixed, the frames follow one another by time and number. A cell the
    file leaves out is invalid. Numbers start as `first_number` says; cells whose places
    are lengths lie where these say. Without a number, cells of one time are a frame,
    or those until the first place comes again.

    Raises
    ------
    DataError
        If nothing says where a frame ends, or its places are no grid.
    """
    layout = reading.head.layout or Layout("long")
    cells, lines = _gather(reading, layout)
    if not len(cells):
        return
    cells, lines = _without_strays(reading, cells, lines)
    origin_cm = None
    if layout.spacing is not None:
        lowest = cells[:, 2:4].min(axis=0)
        cells[:, 2:4] -= lowest
        origin_cm = stated_origin_cm(reading, layout, lowest)
    else:
        cells, lines = _from_zero(reading, cells, lines)
    row, column = cells[:, 2].astype(np.intp), cells[:, 3].astype(np.intp)
    places = np.unique(cells[:, 2:4], axis=0)
    first = first_number(reading, layout, places)
    rows = reading.told.rows or layout.said.rows or int(row.max()) + 1 - first
    columns = reading.told.columns or layout.said.columns or int(column.max()) + 1 - first
    reading.told.agree(str(reading.path), rows, columns)
    refuse_no_grid(reading, layout, (rows, columns), places)
    place = (row - first) * columns + column - first
    frame, how = _frame_of_each(reading, layout, cells, place)
    reading.recognised(f"{layout.why}; {how}", layout.assumed)
    said = layout.said
    numbers, starts, group = np.unique(frame, return_index=True, return_inverse=True)
    refuse_several_pads(reading, layout, group, row * (column.max() + 1) + column, lines)
    reading.report.expect(len(numbers))
    order = np.argsort(group, kind="stable")
    ends = np.cumsum(np.bincount(group))
    left_out = _unlisted(reading, cells, place, group)
    mixed = np.count_nonzero(np.diff(group)) >= len(numbers)
    by_number = np.lexsort((numbers, cells[starts, 1])) if mixed else np.argsort(starts)
    for k in by_number:
        mine = order[ends[k - 1] if k else 0 : ends[k]]
        on_grid = (row[mine] < rows + first) & (column[mine] < columns + first)
        name = f"frame {number_text(numbers[k])}"
        kept = _first_of_each(reading, name, place[mine], on_grid, lines[mine])
        values = np.full(rows * columns, left_out)
        values[place[mine[kept]]] = cells[mine[kept], 4]
        time_s = cells[mine[0], 1]
        yield reading.frame(
            values.reshape(rows, columns),
            time_s=None if np.isnan(time_s) else float(time_s),
            pitch_cm=said.pitch_cm,
            origin_cm=origin_cm,
            quantity=said.quantity,
            factor=said.factor,
            own_number=float(cells[mine[0], 0]) if "frame" in layout.roles else None,
        )


def _unlisted(
    reading: Reading, cells: Cells, place: NDArray[np.intp], group: NDArray[np.intp]
) -> float:
    """Return the value of cells that a frame does not list: 0 where only loaded ones are listed.

    They are where no value is 0 or less and frames differ in what they list; a cell that is broken
    is missing in all.
    """
    n_listed = np.bincount(group)
    sparse = bool((cells[:, 4] > 0).all()) and np.mean(n_listed < len(np.unique(place))) > 0.5
    if sparse and len(np.unique(n_listed)) > 1:
        reading.assume("cells that are not listed taken as 0, as only values above 0 are listed")
        return 0.0
    return math.nan


def _without_strays(
    reading: Reading, cells: Cells, lines: NDArray[np.intp]
) -> tuple[Cells, NDArray[np.intp]]:
    """Return the cells without those of a row or column far beyond all others, seen next to never.

    One digit too many in a row's number would otherwise make every frame as large as it says.
    """
    kept = np.ones(len(cells), dtype=bool)
    for axis in (2, 3):
        found, n = np.unique(cells[:, axis], return_counts=True)
        usual = found[n > STRAY * np.median(n)]
        far = FAR * (usual.max() - usual.min() + 1)
        beyond = found[(found > usual.max() + far) | (found < min(usual.min(), 0.0) - far)]
        kept &= ~np.isin(cells[:, axis], beyond)
    for number in lines[~kept]:
        what = "no cell: its row or column is far beyond all others"
        reading.damaged(int(number), what, n_frames=0)
    return cells[kept], lines[kept]


def _from_zero(
    reading: Reading, cells: Cells, lines: NDArray[np.intp]
) -> tuple[Cells, NDArray[np.intp]]:
    """Return the cells with no row or column below 0, as where the origin lies within the pad.

    Those few below 0 where no other is are damaged, and so is the one place that means none.
    """
    signed = {}
    for axis in (2, 3):
        found, n = np.unique(cells[:, axis], return_counts=True)
        lowest = float(found[n > STRAY * np.median(n)].min())
        below = cells[cells[:, axis] < 0.0, 2:4]
        if lowest < 0.0 and (below != below[0]).any():
            signed[axis] = float(found.min())
    kept = np.ones(len(cells), dtype=bool)
    for axis in {2, 3} - signed.keys():
        kept &= cells[:, axis] >= 0.0
    for number in lines[~kept]:
        what = "no cell: its row or column is below 0, those of others are not"
        reading.damaged(int(number), what, n_frames=0)
    cells, lines = cells[kept], lines[kept]
    if signed:
        row, column = (signed.get(axis, min(1.0, cells[:, axis].min())) for axis in (2, 3))
        cells[:, 2:4] -= row, column
        reading.assume(f"rows counted from {row:g} and columns from {column:g}")
    return cells, lines


def _frame_of_each(
    reading: Reading, layout: Layout, cells: Cells, place: NDArray[np.intp]
) -> tuple[Cells, str]:
    """Return the number of each cell's frame, and how it was found, in words."""
    if "frame" in layout.roles:
        return _run_on(cells[:, 0]), "frames by their numbers"
    scan = _scans(place)
    if "time" not in layout.roles and "clock" not in layout.roles:
        if scan is None:
            raise DataError(
                str(reading.path),
                "cells come again in no steady order and no column numbers the frames; "
                "give frame_column",
            )
        return scan, "a frame ends where its first place comes again"
    _, by_time = np.unique(cells[:, 1], return_inverse=True)
    sizes = np.bincount(by_time)
    n_places = len(np.unique(place))
    most = np.median(sizes) > 0.5 * n_places and sizes.max() <= n_places
    if np.median(sizes) == n_places or (scan is None and most):
        return by_time.astype(np.float64), "cells of one time are a frame"
    if scan is not None:
        return scan, "a frame ends where its first place comes again"
    raise DataError(
        str(reading.path),
        f"its times change after {np.median(sizes):g} cells, its {n_places} places come in no "
        "steady order, and no column numbers the frames; give frame_column",
    )


def _run_on(numbers: Cells) -> Cells:
    """Return numbers of frames as if their counter had not begun anew."""
    extent = float(np.ptp(numbers)) + 1.0
    begun = np.diff(numbers, prepend=numbers[0]) < -0.9 * extent
    # Mixed lines fall back as often as there are frames.
    few = np.count_nonzero(begun) * FEWEST_COUNTED < len(np.unique(numbers))
    return numbers + extent * np.cumsum(begun) if few else numbers


def _scans(place: NDArray[np.intp]) -> Cells | None:
    """Return the number of the scan each cell belongs to; None where the order is not steady.

    A scan ends where the next cell stands no later than the last one in the order of the first.
    """
    _, first_seen, which = np.unique(place, return_index=True, return_inverse=True)
    rank = np.argsort(np.argsort(first_seen))[which]
    scan = np.concatenate([[0], np.cumsum(np.diff(rank) <= 0)])
    sizes = np.bincount(scan)
    # In no steady order scans break off everywhere: then they hold half of the places or fewer.
    steady = np.median(sizes) > 0.5 * len(first_seen)
    return scan.astype(np.float64) if steady else None


def _first_of_each(
    reading: Reading,
    name: str,
    place: NDArray[np.intp],
    on_grid: NDArray[np.bool_],
    lines: NDArray[np.intp],
) -> NDArray[np.intp]:
    """Return which cells of a frame are kept: those on the pad, and the first of each place."""
    if not on_grid.all():
        stray = int(np.flatnonzero(~on_grid)[0])
        n = int(np.count_nonzero(~on_grid))
        what = f"{name}: {n} cells outside the told shape"
        reading.damaged(int(lines[stray]), what, n_frames=0)
    candidates = np.flatnonzero(on_grid)
    _, first = np.unique(place[candidates], return_index=True)
    if len(first) < len(candidates):
        again = int(np.setdiff1d(np.arange(len(candidates)), first)[0])
        reading.report.count("repeated cells dropped", len(candidates) - len(first))
        reading.report.trouble(
            reading.at(int(lines[candidates[again]])),
            f"{name}: {len(candidates) - len(first)} cells come again; the first ones are kept",
        )
    return candidates[first]


def _gather(reading: Reading, layout: Layout) -> tuple[Cells, NDArray[np.intp]]:
    """Return frame, time (s), row, column and value of each cell, shape (N, 5), and its line."""
    text = (
        (number, line)
        for number, line in of_side(reading.text(), layout.side, str(reading.path))
        if number >= layout.first_line and of_sensor(layout, line)
    )
    stamps = Stamps(reading, layout)
    cells, numbers = [np.empty((0, 5))], [np.empty(0, dtype=np.intp)]
    while batch := list(islice(text, _BATCH)):
        found = _at_once(layout, [line for _, line in batch])
        if found is None:
            found, kept = _one_by_one(reading, layout, stamps, batch)
        else:
            kept = [number for number, _ in batch]
        cells.append(found)
        numbers.append(np.array(kept, dtype=np.intp))
    return np.concatenate(cells), np.concatenate(numbers)


def _content(lines: Iterable[tuple[int, str]]) -> Iterator[tuple[int, str]]:
    return ((n, line) for n, line in lines if not is_blank(line) and not is_comment(line))


def _chosen(layout: Layout, table: Cells) -> Cells | None:
    """Return a table's columns in our order; None where a row or column is no place on a pad."""
    where = layout.roles
    chosen = np.empty((len(table), 5))
    chosen[:, 0] = table[:, where["frame"]] if "frame" in where else 0.0
    chosen[:, 1] = table[:, where["time"]] * layout.time_factor if "time" in where else np.nan
    if layout.part is not None:
        chosen[:, 1] += table[:, layout.part[0]] * layout.part[1]
    chosen[:, 2:] = table[:, [where["row"], where["column"], where["value"]]]
    return chosen if _are_places(layout, chosen) else None


def _are_places(layout: Layout, cells: Cells) -> bool:
    """Return whether all cells are places on a pad, positions made whole numbers in place."""
    places = cells[:, 2:4]
    if not (np.isfinite(cells[:, 0]).all() and np.isfinite(places).all()):
        return False
    if layout.spacing is not None:
        steps = places / layout.spacing
        # The first position need not be a multiple of the spacing: 2.5, 7.5, 12.5.
        offset = np.array(layout.first) / layout.spacing
        places[:] = np.rint(steps - offset)
        return bool((np.abs(steps - offset - places) < 1e-2).all() and (places < _LARGEST).all())
    return bool(((np.abs(places) < _LARGEST) & (places % 1 == 0)).all())


def _at_once(layout: Layout, lines: list[str]) -> Cells | None:
    """Return the cells of lines that are all in order, several times faster than one by one."""
    separator = layout.dialect.separator
    text = "" if separator is None else separator.join(lines)
    if (
        separator is None
        or "_" in text
        or "clock" in layout.roles
        or layout.dialect.thousands
        or any(line.count(separator) != layout.width - 1 for line in lines)
    ):
        return None
    if layout.dialect.decimal_comma and separator != ",":
        text = text.replace(",", ".")
    try:
        numbers = np.array(list(map(float, text.split(separator))))
    except ValueError:
        return None
    return _chosen(layout, numbers.reshape(len(lines), layout.width))


def _one_by_one(
    reading: Reading, layout: Layout, stamps: Stamps, batch: list[tuple[int, str]]
) -> tuple[Cells, list[int]]:
    """Return the cells of the lines that are in order, and report the others."""
    cells, numbers = [np.empty((0, 5))], []
    where = [layout.roles[role] for role in ("row", "column", "value")]
    for number, line in _content(batch):
        try:
            fields = layout.dialect.texts(line, layout.width)
            refuse_other_unit(layout, reading.at(number), fields)
            texts = [fields[k] for k in where]
            refuse_underscore(" ".join(texts))
            values = floats(texts)
            index = floats([fields[layout.roles["frame"]]])[0] if "frame" in layout.roles else 0.0
            timed = "time" in layout.roles or "clock" in layout.roles
            time_s = stamps.time_s(fields) if timed else None
        except ValueError as error:
            reading.damaged(number, f"no cell: {str(error)[:80]}", n_frames=0)
            continue
        cell = np.array([[index, np.nan if time_s is None else time_s, *values]])
        if not _are_places(layout, cell):
            what = f"no cell: {line.strip()[:60]!r} names no place on a pad"
            reading.damaged(number, what, n_frames=0)
        else:
            cells.append(cell)
            numbers.append(number)
    return np.concatenate(cells), numbers


FORMAT = RecordingFormat(
    "table, one cell a line (row, column, value)", recognises, read, plain=True
)
