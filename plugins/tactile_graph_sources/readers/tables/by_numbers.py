"""How the numbers lie in a table whose header names no places: by settings, groups, the numbers."""

from __future__ import annotations

from collections import Counter
from dataclasses import replace
from math import isqrt
from typing import Any

import numpy as np

from tactile_graph_sources.readers.tables.evidence import (
    CLEAR,
    climbs_in_parts,
    is_one_row,
    is_sum,
    line_period,
    row_length_clarity,
    row_lengths,
)
from tactile_graph_sources.readers.tables.extra import without_extra
from tactile_graph_sources.readers.tables.frame_shape import shape_of_cells
from tactile_graph_sources.readers.tables.layout import Layout, assumed_unit
from tactile_graph_sources.readers.tables.nameless import are_nameless
from tactile_graph_sources.readers.tables.table import ENDLESS, Table
from tactile_graph_sources.readers.words.moments import clock_s
from tactile_graph_sources.readers.words.told import Told

SMALLEST_SURE_SQUARE = 64
FEWEST_SUMMED = 3
MOST_COLUMNS_UNTOLD, MOST_LINES_UNTOLD = 63, 256
LEAST_FRAMED = 16
"""Values of a line that may be a frame by how they lie together."""
FEWEST_NAMED, CELL_AND_VALUE = 4, 2
LONGEST_UNTOLD = 4
"""Times its breadth: a matrix longer than that is more likely many frames."""


def unplaced(base: Layout, table: Table, told: Told) -> Layout:
    """Return the layout of a table that does not say where each cell lies."""
    if len(base.cells) == CELL_AND_VALUE and table.named.names and _is_listed(table, base):
        names = [table.named.names[k] for k in base.cells]
        return replace(base, trouble=_by_cell_question(names))
    by_row = _by_row_numbers(base, table, told)
    if by_row is not None:
        return by_row
    base = without_extra(base, table, told)
    if told.rows is None and told.columns is None and _is_scan(table, base):
        return replace(base, trouble=_scan_question())
    if base.trouble:
        return base
    width, (groups, run) = len(base.cells), table.groups
    # What pandas writes before each line numbers frames or the rows of one matrix alike.
    index, header = base.roles.get("frame"), table.named.names
    is_index = index is not None and bool(header) and not header[index]
    lead = bool(base.roles) and not (is_index and len(base.roles) == 1)
    kind, rows, why = _decide(table, base, told, lead)
    if kind == "stacked":
        if len(groups) < 2 and told.rows is None and told.columns is None:
            note = f"{rows} lines of {width} values assumed to be the rows of one matrix"
            base = replace(base, assumed=(*base.assumed, note))
        if told.rows is None and told.columns is None:
            base = _without_sums(base, table, rows)
        base = _of_lines_told(base, table)
        return replace(
            base,
            kind=kind,
            rows=rows,
            blank_run=run if len(groups) > 1 else ENDLESS,
            roles={role: k for role, k in base.roles.items() if role == "time"},
            breaks=table.breaks,
            header_line=table.header_line,
            why=why,
            **_time_unit(base, table),
        )
    if kind == "unclear":
        return replace(base, trouble=base.trouble or why)
    return _flat(base, table, told, width, why)


def _of_lines_told(base: Layout, table: Table) -> Layout:
    """Return the layout of matrices with what of their lines' numbers and clocks is not read."""
    said, apart = table.named.names, sorted(k for r, k in base.roles.items() if r != "time")
    if not apart:
        return base
    names = [(said[k] if said else "") or f"column {k + 1}" for k in apart]
    note = f"columns left out that are no cells ({', '.join(names)})"
    return replace(base, assumed=(*base.assumed, note))


def _decide(table: Table, base: Layout, told: Told, lead: bool) -> tuple[str, int, str]:
    """Return the kind of table, the rows of a matrix where it is stacked, and why."""
    width, groups = len(base.cells), table.groups[0]
    usual = Counter(groups).most_common(1)[0][0] if groups else 0
    n, said = sum(groups), "rows and columns are told"
    if told.columns is not None:
        if width != told.columns or told.rows == 1:
            return "flat", 0, said
        clear = told.rows or len(groups) > 1 or table.whole
        question = f"how many lines of {width} values make a matrix? give rows"
        return ("stacked", told.rows or usual, said) if clear else ("unclear", 0, question)
    if told.rows is not None:
        if usual == told.rows > 1:
            return "stacked", usual, said
        if width % told.rows == 0 or len(groups) < 2:
            return "flat", 0, said
    if len(groups) > 1 and usual > 1 and not (lead and table.is_torn):
        return _by_groups(table, base, usual)
    if lead:
        return "flat", 0, "a time or a number before the values"
    return _by_numbers(table, base, n)


def _by_groups(table: Table, base: Layout, usual: int) -> tuple[str, int, str]:
    """Return what `_decide` returns of lines in groups: rows of matrices, unless lines are frames.

    They are where each has a time or a number of its own and its cells lie together as those of a
    frame do. One of the two is asked about, unless lines are alike again from group to group.
    """
    cells = table.rows[:, base.cells]
    width = cells.shape[1]
    if width == 1:
        return "unclear", 0, _one_a_line_question(usual)
    why = f"blank lines or frame lines after every {usual} rows"
    if width < LEAST_FRAMED:
        return "stacked", usual, why
    lengths = row_lengths(cells)
    if table.breaks and lengths:
        between = "a line of words"
    elif table.is_parted_by_words or line_period(cells) == usual:
        return "stacked", usual, why
    else:
        between = "a line of words" if table.breaks else "a blank line"
    timed = _lines_are_timed(table, base)
    if not lengths and not timed:
        return "stacked", usual, why
    if lengths and timed:
        return "flat", 0, "a time or a number before each line, whose cells lie as a frame's do"
    framed = (
        f"frames of {lengths[0][0]} x {lengths[0][1]}, as cells lie together"
        if lengths
        else "a frame a line, as a time or a number climbs before each"
    )
    question = (
        f"every {usual} lines of {width} values {between}: matrices (then rows={usual}, "
        f"columns={width}), or {framed}; give rows and columns"
    )
    return "unclear", 0, question


def _lines_are_timed(table: Table, base: Layout) -> bool:
    """Return whether each line has a time or a number of its own."""
    column = base.roles.get("clock")
    if column is None:
        led = [k for role, k in base.roles.items() if role in ("time", "frame")]
        return any(climbs_in_parts(table.rows[:, k], table.n_parts) for k in led)
    times = [clock_s(row[column]) for row in table.texts]
    known = np.array([t for t in times if t is not None])
    return climbs_in_parts(known, table.n_parts)


def _by_row_numbers(base: Layout, table: Table, told: Told) -> Layout | None:
    """Return the layout of matrices of which each line says the number of its row.

    None where no column says it, or where the settings say what a line is.
    """
    column = table.named.roles.get("row")
    if column is None or told.rows is not None or told.columns is not None:
        return None
    numbers = table.rows[:, column]
    if not np.isfinite(numbers).all() or (numbers % 1 != 0).any():
        return None
    ends = np.flatnonzero(np.diff(numbers) <= 0) + 1
    name, n = table.named.names[column], len(numbers)
    if not len(ends):
        question = (
            f"its column {name!r} numbers {n} lines of {len(base.cells)} values: the rows of one "
            "matrix, or frames; give rows and columns"
        )
        return replace(base, trouble=question) if table.whole else None
    rows = Counter(np.diff([0, *ends]).tolist()).most_common(1)[0][0]
    roles = {role: k for role, k in base.roles.items() if role == "time"} | {"row": column}
    left_out = tuple(x for x in base.assumed if not x.startswith("columns left out"))
    return replace(
        base,
        kind="stacked",
        rows=rows,
        blank_run=ENDLESS,
        roles=roles,
        assumed=left_out,
        why=f"its column {name!r} numbers the rows of each matrix",
    )


def _without_sums(base: Layout, table: Table, rows: int) -> Layout:
    """Return the layout of matrices without a last column, and a last row, of sums."""
    n = len(table.rows) // rows
    cells = table.rows[: n * rows, base.cells].reshape(n, rows, len(base.cells))
    if (
        not n
        or min(cells.shape[1:]) <= FEWEST_SUMMED
        or not is_sum(cells[..., -1].ravel(), cells[..., :-1].reshape(n * rows, -1))
    ):
        return base
    note = "columns left out that are no cells (the last, a sum)"
    base = replace(base, cells=base.cells[:-1], assumed=(*base.assumed, note))
    last, above = cells[:, -1, :-1], np.moveaxis(cells[:, :-1, :-1], 1, -1)
    if not is_sum(last.ravel(), above.reshape(last.size, -1)):
        return base
    note = "rows left out that are no cells (the last of each matrix, a sum)"
    return replace(base, rows_of_sums=1, assumed=(*base.assumed, note))


def _time_unit(base: Layout, table: Table) -> dict[str, Any]:
    """Return what is assumed of times between matrices whose unit nobody says."""
    times = table.times_without_unit
    if not times:
        return {}
    factor, note = assumed_unit(np.array(times))
    return {"time_factor": factor, "assumed": (*base.assumed, note)}


def _by_numbers(table: Table, base: Layout, n: int) -> tuple[str, int, str]:
    """Return what `_decide` returns where nothing but the numbers can tell."""
    cells = table.rows[:, base.cells]
    width = cells.shape[1]
    square = _is_square(width)
    lengths = row_lengths(cells) if n > 1 else []
    framed = bool(lengths) and width >= LEAST_FRAMED
    # Where cells of a line lie together as those of a frame do, it is one.
    clear = square and row_length_clarity(cells, isqrt(width)) < CLEAR
    period = None if clear else line_period(cells)
    long = max(n, width) > LONGEST_UNTOLD * min(n, width)
    matrix_like = n > 1 and not long and n <= MOST_LINES_UNTOLD and table.whole
    names = _names_of_cells(table, base)
    question = (
        f"{n} lines of {width} values could be one matrix or a frame a line"
        + (f" (of {lengths[0][0]} x {lengths[0][1]} cells, as they lie)" if framed else "")
        + (f"; its columns have names ({names[0]}, {names[1]}, …), as cells have" if names else "")
        + "; give the settings rows and columns"
    )
    if period is not None:
        return (
            "unclear",
            0,
            (
                f"{n} lines of {width} values, of which each {period}th is alike: frames, or "
                f"matrices of {period} rows and {width} columns; give rows and columns"
            ),
        )
    if square and n > 1 and n != width and not lengths and is_one_row(cells, isqrt(width)):
        side = isqrt(width)
        return (
            "unclear",
            0,
            (
                f"{n} lines of {width} values: {side} x {side} cells each by their number, a row "
                f"of {width} cells by which lie together; give rows and columns"
            ),
        )
    if n == width:
        why = "as many lines as columns"
        return ("unclear", 0, question) if framed or names else ("stacked", n, why)
    if square and not matrix_like:
        return "flat", 0, f"{width} values a line, a square number"
    if square:
        clarity = row_length_clarity(cells, isqrt(width))
        if clarity < CLEAR or (np.isnan(clarity) and width >= SMALLEST_SURE_SQUARE):
            return "flat", 0, f"{width} values a line, which lie together as a square"
        return "unclear", 0, question
    if matrix_like and width <= MOST_COLUMNS_UNTOLD and not framed and not names:
        return "stacked", n, f"{n} lines of {width} values"
    return "unclear", 0, question


def _names_of_cells(table: Table, base: Layout) -> list[str]:
    """Return the names of the columns of cells; none where they are nameless."""
    said = table.named.names
    names = [said[k] for k in base.cells] if said and len(base.cells) > 1 else []
    return [] if are_nameless(names) else names


def _flat(base: Layout, table: Table, told: Told, width: int, why: str) -> Layout:
    """Return the layout of frames of ``width`` cells a line, their shape told, named or square."""
    base = replace(base, kind="flat", why=why)
    if (told.rows or told.columns) and told.fits(width) is None:
        return base  # the error names the settings
    found = shape_of_cells(table.rows[:, base.cells], told)
    if found.shape is None:
        return replace(base, trouble=found.trouble)
    return replace(
        base,
        shape=found.shape,
        places=_ordered(base, table, found.shape),
        assumed=(*base.assumed, *found.assumed),
    )


def _one_a_line_question(n: int) -> str:
    return (
        f"a frame is {n} lines of one value, and nothing says its shape; put the values of a frame "
        "on one line, or as rows (ROS: ros2 topic echo --csv), and give rows and columns"
    )


def _is_listed(table: Table, base: Layout) -> bool:
    """Return whether of two columns the first numbers cells again and again."""
    numbers = table.rows[:, base.cells[0]]
    if not np.isfinite(numbers).all() or (numbers % 1 != 0).any():
        return False
    again = np.flatnonzero(numbers == numbers[0])
    return len(again) > 1 and len(np.unique(np.diff(again))) == 1 and again[1] > FEWEST_NAMED


def _by_cell_question(names: list[str]) -> str:
    cell, value = names
    return (
        f"each line looks like one cell, by its number ({cell!r}), and its value ({value!r}); "
        "make a line of each frame, in Python: pandas.read_csv(…).pivot(index=…, "
        f"columns={cell!r}, values={value!r}).to_csv('out.csv')"
    )


def _is_scan(table: Table, base: Layout) -> bool:
    """Return whether lines of three or four values are places on a grid and what was there."""
    if len(base.cells) not in (3, 4) or len(table.rows) < 4:
        return False
    places = table.rows[:, list(base.cells[-3:-1])]
    if not np.isfinite(places).all() or (places % 1 != 0).any() or (places < 0).any():
        return False
    seen = np.unique(places, axis=0)
    sizes = [len(np.unique(places[:, k])) for k in (0, 1)]
    return min(sizes) > 1 and len(seen) * 2 > sizes[0] * sizes[1] and len(seen) > 3


def _scan_question() -> str:
    return (
        "its lines could be rows of a matrix, or cells as row, column and value; put a header "
        "such as 'row,column,value' before them, or give rows and columns"
    )


def _is_square(n: int) -> bool:
    return n > 1 and isqrt(n) ** 2 == n


def _ordered(base: Layout, table: Table, shape: tuple[int, int]) -> tuple[int, ...]:
    """Return the places of cells whose names have a number each; empty where they come in order."""
    numbers = table.named.numbers
    if not numbers or len(numbers) != shape[0] * shape[1]:
        return ()
    rank = {n: k for k, n in enumerate(sorted(numbers))}
    order = tuple(rank[n] for n in numbers)
    return () if order == tuple(range(len(order))) else order
