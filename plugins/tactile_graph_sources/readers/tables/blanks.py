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


def as_wide_as_told(table: Table, told: Told) -> tuple[Table, tuple[str, ...]]:
    """Return a table with the columns at its end that hold nothing, as far as they are cells.

    They are where only with them there are as many cells as the settings or the words before the
    table say; else separators that all lines end with.

    Parameters
    ----------
    table : Table
    told : Told
        With what the words before the table say.

    Returns
    -------
    Table
    tuple of str
        The note where as many cells are there without the empty columns, but may be told with
        them.
    """
    if table.named.cells or table.n_fields == table.width or told.columns is None:
        return table, ()
    n, width = (told.rows or 0) * told.columns, table.width
    if width < told.columns <= table.n_fields:
        return _widened(table, told.columns), ()
    known = {*table.clocks, *table.dates, *table.named.roles.values()}
    lead = 1 + max(known) if known else _n_climbing(table)
    if not width < n + lead <= table.n_fields:
        return table, ()
    if not known and width in (n, n + 1):  # most such files end their lines with a separator
        return table, (_of_first_cell(n, lead) if len(table.rows) >= _FEWEST_CLIMBING else ())
    return _widened(table, n + lead), ()


def _n_climbing(table: Table) -> int:
    """Return how many columns in front may be a number and a time, as they climb."""
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


def _of_first_cell(n: int, lead: int) -> tuple[str, ...]:
    remedy = "time_column=1" if lead == 1 else "frame_column=1 and time_column=2"
    return (
        f"lines of {n} cells read without the empty field behind them, though the first cell "
        f"climbs (give {remedy} if it is none and the last cell has no value)",
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
    one size with them, and the same rows of each, with others before and behind them, are blank.
    At the edge of matrices they may as well be blank lines, and surely are where a spreadsheet
    filled up the lines that part matrices, too.

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
    if not fewer:
        return False, ()
    lone = any(padded.is_padded(x) and not is_blank(x) for x in padded.row_lines)
    taken = f"lines of separators {'and one number' if lone else 'alone'} taken for"
    if len(sizes) > 1 and (not _are_alike(padded, sizes) or fewer == usual or _are_times(padded)):
        return False, ()
    if len(sizes) == 1 and len(table.groups[0]) > 1:
        return False, ()  # nothing else parts the matrices
    if len(sizes) > 1 and not _are_edges(padded):
        return True, (f"{taken} rows without a value (give rows={fewer} if they are blank lines)",)
    if usual == fewer + 1 and _is_filled_up(padded):
        return False, ()
    return False, (f"{taken} blank ones (give rows={usual} if they are rows without a value)",)


def _are_alike(table: Table, sizes: Sequence[int]) -> bool:
    """Return whether matrices are of one size, and the same rows of each are blank."""
    whole = sizes if table.whole else sizes[:-1]  # the first lines end anywhere
    counted = Counter(zip(whole, _blank_at(table, whole), strict=True))
    (usual, _), n = counted.most_common(1)[0]
    return n >= EVENLY * len(whole) and max(sizes) == usual


def _usual(table: Table) -> int:
    return next((size for size, _ in Counter(table.groups[0]).most_common(1)), 0)


def _has_rows(table: Table, rows: int) -> bool:
    """Return whether matrices have so many rows, also where nothing parts them."""
    sizes = table.groups[0]
    if len(sizes) != 1 or not table.padded:
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
    """Return whether lines of separators alone stand before or behind the values of matrices.

    A lone number may stand behind them, as their sum.
    """
    size, at = _usual(table), Counter(_blank_at(table, table.groups[0])).most_common(1)[0][0]
    inside = sorted(set(range(size)) - {*at})
    if not inside:
        return True
    return inside[-1] - inside[0] < len(inside) and all(map(is_blank, table.row_lines[: inside[0]]))
