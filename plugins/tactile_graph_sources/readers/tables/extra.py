"""Columns before or behind the cells that no header names: numbers, times, sums."""

from __future__ import annotations

from collections import Counter
from dataclasses import replace
from math import isqrt

import numpy as np

from tactile_graph_sources.readers.tables.evidence import (
    SURE_STEPS,
    Numbers,
    climbs_in_parts,
    counts_up,
    is_sum,
    line_period,
    rises,
    row_lengths,
)
from tactile_graph_sources.readers.tables.layout import Layout, timed
from tactile_graph_sources.readers.tables.table import Table
from tactile_graph_sources.readers.words.told import Told

FEWEST_TIMED = 3
"""Matrices whose lines all begin with a time that climbs, for it to be one."""


def without_extra(base: Layout, table: Table, told: Told) -> Layout:
    """Return the layout without the columns before or behind the cells that nobody named.

    They are found by what they hold: a number or a time climbs, a sum adds up.
    """
    if table.named.cells or base.roles or not base.cells:
        return base
    told_cells = (told.rows or 0) * (told.columns or 0)
    cells, width = base.cells, len(base.cells)
    if told_cells:
        extra = width - told_cells
        if extra <= 0 or extra > 2 or told.columns == width:
            return base
    elif told.columns is not None or told.rows is not None:
        return base
    else:
        extra = 0 if _is_square(width) else 1 if _is_square(width - 1) and width > 9 else 0
    if len(table.groups[0]) > 1 and not table.is_torn and not told_cells:
        return _before_groups(base, table, extra)
    values = table.rows
    first, last = values[:, cells[0]], values[:, cells[-1]]
    if extra == 0:
        return _doubted(base, table) if not told_cells and rises(first) else base
    if extra == 2 and rises(first) and rises(values[:, cells[1]]):
        return _timed_by(replace(base, cells=cells[2:]), table, cells[0], cells[1])
    if extra == 1 and rises(first):
        return _led(base, table, cells)
    if extra == 1 and rises(last):
        return _timed_by(replace(base, cells=cells[:-1]), table, None, cells[-1])
    if extra == 1 and is_sum(last, values[:, cells[:-1]]):
        note = "columns left out that are no cells (the last, a sum)"
        return replace(base, cells=cells[:-1], assumed=(*base.assumed, note))
    if told_cells:
        return replace(base, trouble=_surplus(width, told_cells))
    return base


def _led(base: Layout, table: Table, cells: tuple[int, ...]) -> Layout:
    """Return the layout of a table whose first column climbs."""
    numbers = counts_up(table.rows[:, cells[0]])
    if numbers and table.n_rows == len(cells) - 1:
        n = table.n_rows
        question = (
            f"{n} lines of {n + 1} values could be one matrix behind the numbers of its rows, or "
            "frames behind their numbers; give rows and columns, or a header"
        )
        return replace(base, trouble=question)
    frame, time = (cells[0], None) if numbers else (None, cells[0])
    return _timed_by(replace(base, cells=cells[1:]), table, frame, time)


def _doubted(base: Layout, table: Table) -> Layout:
    """Return the layout with the question whether a climbing first column is a cell at all."""
    width = len(base.cells)
    if width < 9 or not any((width - 1) % k == 0 for k in range(2, isqrt(width - 1) + 1)):
        return base
    side = isqrt(width)
    square = f"{side} x {side} cells" if side * side == width else f"{width} cells"
    question = (
        f"{width} values a line: {square}, or a time or number (the first column climbs from line "
        f"to line) and {width - 1} cells; give rows and columns, or a header"
    )
    return replace(base, trouble=question)


def _before_groups(base: Layout, table: Table, extra: int) -> Layout:
    """Return the layout of groups of lines without the columns in front that are no cells.

    They number the rows of each matrix, or are numbers or times of lines or of whole groups.
    """
    numbered, cells = _row_numbers(base, table), base.cells
    if numbered is not base or table.is_parted_by_words:
        return numbered
    first, last = table.rows[:, cells[0]], table.rows[:, cells[-1]]
    size = Counter(table.groups[0]).most_common(1)[0][0]
    if extra == 1 and climbs_in_parts(first, table.n_parts):
        # A column of cells may climb in each matrix, but then lines lie together as its rows do.
        rest = table.rows[:, cells[1:]]
        if row_lengths(rest) and line_period(rest) != size:
            return _led(base, table, cells)
    if _is_of_groups(first, size) and not _is_of_groups(last, size):
        return _timed_by(replace(base, cells=cells[1:]), table, None, cells[0])
    if len(cells) < 3 or not _climbs_on(first) or _climbs_on(last):
        return base
    if _climbs_on(table.rows[:, cells[1]]):
        return _timed_by(replace(base, cells=cells[2:]), table, cells[0], cells[1])
    return _led(base, table, cells)


def _is_of_groups(column: Numbers, size: int) -> bool:
    """Return whether a column says the same of all lines of a group, and climbs between groups."""
    n = len(column) // size
    groups = column[: n * size].reshape(n, size)
    return n >= FEWEST_TIMED and bool(
        (groups == groups[:, :1]).all() and (np.diff(groups[:, 0]) > 0.0).all()
    )


def _climbs_on(column: Numbers) -> bool:
    """Return whether a column goes up from line to line, as the cells of no matrices do."""
    steps = np.diff(column)
    return len(steps) >= SURE_STEPS and bool((steps > 0.0).all())


def _row_numbers(base: Layout, table: Table) -> Layout:
    """Return the layout of stacked matrices without a first column that numbers their rows."""
    size = Counter(table.groups[0]).most_common(1)[0][0]
    first = table.rows[: size * (len(table.rows) // size), base.cells[0]].reshape(-1, size)
    if size < 3 or not len(first) or not all(counts_up(m) for m in first):
        return base
    if first[0][0] not in (0.0, 1.0) or (first[:, 0] != first[0][0]).any():
        return base
    note = "columns left out that are no cells (the first, the numbers of rows)"
    return replace(base, cells=base.cells[1:], assumed=(*base.assumed, note))


def _surplus(width: int, n_cells: int) -> str:
    return (
        f"a line is {width} values, {n_cells} of them cells by the settings or the words before "
        "the table, and nothing says which; give cells, such as cells='2-' for all but the first"
    )


def _timed_by(base: Layout, table: Table, frame: int | None, time: int | None) -> Layout:
    roles = {k: v for k, v in (("frame", frame), ("time", time)) if v is not None}
    base = replace(base, roles=roles)
    return timed(base, table) if time is not None else base


def _is_square(n: int) -> bool:
    return n > 1 and isqrt(n) ** 2 == n
