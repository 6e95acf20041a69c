"""Fields and lines that hold nothing: cells without a value, or what separators leave behind."""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence
from dataclasses import replace
from itertools import pairwise

import numpy as np

from tactile_graph_sources.readers.tables.breaks import EVENLY, FRAME_LINE, signature
from tactile_graph_sources.readers.tables.evidence import rises
from tactile_graph_sources.readers.tables.table import Table, is_blank
from tactile_graph_sources.readers.words.told import Told

_LOOKED_AT = 4000
_FEWEST_CLIMBING = 3


# -- columns -----------------------------------------------------------------------------------


def as_wide_as_told(table: Table, told: Told) -> tuple[Table, str]:
    """Return a table with the columns at its end that hold nothing, as far as they are cells.

    They are where the settings or the words before the table say so many cells; else separators
    that all lines end with.

    Parameters
    ----------
    table : Table
    told : Told
        With what the words before the table say.

    Returns
    -------
    Table
    str
        What to ask where they may be either; empty otherwise.
    """
    if table.named.cells or table.n_fields == table.width or told.columns is None:
        return table, ""
    n, wide = (told.rows or 0) * told.columns, table.width
    lead = _led_by(table)
    if table.width < told.columns <= table.n_fields:
        wide = told.columns
    elif table.width < n + lead <= table.n_fields:
        if table.width == n and not table.clocks and len(table.rows) >= _FEWEST_CLIMBING:
            return table, _of_last_question(n)
        wide = table.width if table.width == n and not table.clocks else n + lead
    return _widened(table, wide), ""


def _led_by(table: Table) -> int:
    """Return how many columns in front of the cells are times or numbers."""
    if table.clocks:
        return len({*table.clocks, *table.dates})
    return next((k for k in range(2) if not rises(table.rows[:, k])), 2) if table.width > 2 else 0


def _widened(table: Table, width: int) -> Table:
    n = width - table.width
    nothing = np.full((len(table.rows), n), np.nan)
    return replace(
        table,
        width=width,
        rows=np.hstack([table.rows, nothing]),
        texts=tuple((*row, *[""] * n) for row in table.texts),
    )


def _of_last_question(n: int) -> str:
    return (
        f"a line is {n} values and an empty field behind them, and the first climbs from line to "
        f"line: {n} cells (then cells=1-{n}), or a time and {n} cells of which the last has no "
        f"value (then time_column=1, cells=2-{n + 1})"
    )


def of_empty_columns(table: Table, n_front: int) -> tuple[str, ...]:
    """Return the note on columns of matrices that hold nothing and are left out.

    One behind all others is but the separator that lines end with, unless cells are blank too.
    """
    n_behind = table.n_fields - table.width
    inside = any(not text.strip() for row in table.texts for text in row[n_front:])
    if not n_front and not (n_behind and inside):
        return ()
    return (f"empty columns left out (give columns={table.n_fields} if they are cells)",)


# -- rows --------------------------------------------------------------------------------------


def may_have_blank_rows(table: Table, lines: Sequence[str]) -> bool:
    """Return whether lines are of separators alone, or nearly, and have as many as the rows."""
    before = lines[max(table.first_line - 2, 0) : table.first_line - 1]
    looked_at = *before, *table.lines[:_LOOKED_AT]
    return not table.named.cells and any(map(table.is_padded, looked_at))


def blank_rows(table: Table, padded: Table, told: Told) -> tuple[bool, tuple[str, ...]]:
    """Return whether lines of separators alone are rows without a value, and the note on it.

    They are where so many rows are told; else where other lines part the matrices, which are of
    one size with them, and the same rows of each are blank. Spreadsheets fill all lines up with
    separators, those that part matrices too: there they are blank lines, and so are those at the
    edge of each matrix where no other line is blank.

    Parameters
    ----------
    table, padded : Table
        With these lines as blank ones, and as rows.
    told : Told
        With what the words before the table say.
    """
    if told.rows is not None:
        if table.width >= told.rows * (told.columns or table.width + 1):
            return False, ()  # a frame a line
        return _has_rows(padded, told.rows) and not _has_rows(table, told.rows), ()
    sizes, fewer, usual = padded.groups[0], _usual(table), _usual(padded)
    taken = "lines of separators alone taken for"
    if len(sizes) > 1 and (not _are_alike(padded, sizes) or fewer == usual or _are_times(padded)):
        return False, ()
    if len(sizes) == 1 and len(table.groups[0]) > 1:
        return False, ()  # nothing else parts the matrices
    if len(sizes) == 1 or _is_filled_up(padded) or _are_edges(padded):
        return False, (f"{taken} blank ones (give rows={usual} if they are rows without a value)",)
    return True, (f"{taken} rows without a value (give rows={fewer} if they are blank lines)",)


def _are_alike(table: Table, sizes: Sequence[int]) -> bool:
    """Return whether matrices are of one size, and the same rows of each are blank."""
    whole = sizes if table.whole else sizes[:-1]  # the first lines end anywhere
    counted = Counter(zip(whole, _blank_at(table, whole), strict=True))
    (usual, _), n = counted.most_common(1)[0]
    return n >= EVENLY * len(whole) and max(sizes) == usual


def _usual(table: Table) -> int:
    return Counter(table.groups[0]).most_common(1)[0][0]


def _has_rows(table: Table, rows: int) -> bool:
    """Return whether matrices have so many rows, also where nothing parts them."""
    sizes = table.groups[0]
    if len(sizes) > 1 or not table.padded:
        return _usual(table) == rows
    n = sizes[0] // rows
    at = Counter(_blank_at(table, [rows] * n))
    return n * rows == sizes[0] or not table.whole if len(at) == 1 else False


def _blank_at(table: Table, sizes: Sequence[int]) -> list[tuple[int, ...]]:
    """Return which rows of each matrix hold at most one value."""
    blank = [table.is_padded(line) for line in table.row_lines]
    ends = np.cumsum([0, *sizes]).tolist()
    return [tuple(k - a for k in range(a, b) if blank[k]) for a, b in pairwise(ends)]


def _are_times(table: Table) -> bool:
    """Return whether numbers alone in front of separators climb, as times of matrices do."""
    alone = [x for line in table.row_lines if table.is_padded(line) and (x := _first(table, line))]
    numbers = [float(x) for x in alone]
    return len(numbers) > 1 and bool((np.diff(numbers) > 0).all())


def _first(table: Table, line: str) -> str:
    return table.dialect.fields(line)[0].strip()


def _is_filled_up(table: Table) -> bool:
    """Return whether lines that part matrices are filled up with separators, too."""
    return any(
        len(table.dialect.fields(line)) >= table.n_fields
        for line in table.lines[:_LOOKED_AT]
        if FRAME_LINE.fullmatch(line) or signature(table.dialect.pointed(line)) in table.breaks
    )


def _are_edges(table: Table) -> bool:
    """Return whether all that lines of separators do is to part matrices, as blank lines would."""
    lines = [*table.lines[:_LOOKED_AT]]
    while lines and not lines[-1]:
        lines.pop()
    if any(is_blank(x) and not table.is_padded(x) for x in lines):
        return False
    held = any(table.is_padded(x) and not is_blank(x) for x in lines)
    size, at = _usual(table), Counter(_blank_at(table, table.groups[0])).most_common(1)[0][0]
    inside = set(range(size)) - {*at}
    return not held and len(inside) == max(inside, default=0) - min(inside, default=0) + 1
