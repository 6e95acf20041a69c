"""How the numbers lie in a plain table: one frame a line, stacked matrices, or one cell a line.

A table seldom says what it is. The rules, in order:

1. settings, then the names in a header, then words before the table, say what the columns are;
2. a row, a column and a value: one cell a line;
3. rows and columns told: a line of rows x columns values is a frame, one of columns a row;
4. groups of equal lines between blank lines (or lines such as ``Frame 3``): stacked matrices;
5. names of cells, a time or a number before the values: a frame a line;
6. as many lines as columns, or nearly: one matrix;
7. a square number of values a line: a frame a line;
8. anything else is asked for, never guessed, and so is what the numbers themselves speak against:
   a first column that climbs, cells that lie together in rows of another length.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from math import isqrt

import numpy as np

from tactile_graph_sources.readers.csv_evidence import (
    CLEAR,
    Numbers,
    counts_up,
    is_sum,
    rises,
    row_length_clarity,
    row_lengths,
)
from tactile_graph_sources.readers.csv_table import ENDLESS, Table, table_of
from tactile_graph_sources.readers.dialect import Dialect
from tactile_graph_sources.readers.frame_shape import shape_of_cells
from tactile_graph_sources.readers.names import ColumnsTold
from tactile_graph_sources.readers.preamble import Described
from tactile_graph_sources.readers.told import Told

SMALLEST_SURE_SQUARE = 64
MOST_COLUMNS_UNTOLD, MOST_LINES_UNTOLD = 63, 256
LONGEST_UNTOLD = 4
"""Times its breadth: a matrix longer than that is more likely many frames."""
_CLOCK = "clock"


@dataclass(frozen=True)
class Layout:
    """What a table is; ``trouble`` says why it cannot be told.

    Parameters
    ----------
    kind : str
        ``long``, ``flat``, ``stacked`` or ``unclear``.
    dialect : Dialect
    width : int
        Fields of a line.
    first_line : int
        Number of the first row, from 1.
    roles : dict
        Columns of frame, time (or clock), row, column and value.
    cells : tuple of int
        Columns that are cells.
    shape : (int, int), optional
        Rows and columns of a frame, where the table itself says so.
    places : tuple of int
        Where each cell lies in a frame, row by row; empty where that is the order of the columns.
    rows : int
        Of a stacked matrix.
    blank_run : int
        Blank lines that end a matrix.
    time_factor : float
        From the column of time to seconds.
    time_format : str
        Of the column of clock, where the settings say it.
    said : Described
        What the words before the table say.
    why, assumed : str, tuple of str
        How it was recognised, and what nobody said.
    trouble : str
    """

    kind: str
    dialect: Dialect = field(default_factory=Dialect)
    width: int = 0
    first_line: int = 1
    roles: dict[str, int] = field(default_factory=dict)
    cells: tuple[int, ...] = ()
    shape: tuple[int, int] | None = None
    places: tuple[int, ...] = ()
    rows: int = 0
    blank_run: int = 1
    time_factor: float = 1.0
    time_format: str = ""
    said: Described = field(default_factory=Described)
    why: str = ""
    assumed: tuple[str, ...] = ()
    trouble: str = ""


def layout_of(lines: Sequence[str], told: Told, whole: bool) -> Layout | None:
    """Return how the numbers lie; None where the lines are no table of numbers.

    Parameters
    ----------
    lines : sequence of str
        The first lines of the file.
    told : Told
    whole : bool
        Whether there are no more lines.
    """
    try:
        table = table_of(lines, told.of_columns, whole)
    except ValueError as error:
        return Layout("unclear", trouble=str(error))
    if table is None:
        return None
    base = Layout("unclear", table.dialect, table.width, table.first_line, said=table.said)
    roles = _roles(table, told.of_columns)
    trouble = _unnamed_value(table, roles) or _strange_column(table, roles)
    if trouble:
        return replace(base, trouble=trouble)
    if table.named.is_long:
        return _long(base, table)
    base = replace(base, roles=roles)
    if roles.get("time") is not None:
        base = _timed(base, table)
    base = replace(base, time_format=told.of_columns.time_format)
    cells = table.named.cells or tuple(
        k for k in range(table.width) if k not in roles.values() and k not in table.labels
    )
    base = replace(base, cells=cells, assumed=(*base.assumed, *_left_out(table, roles, cells)))
    if not cells:
        return None
    if table.named.places:
        return _placed(base, table, told)
    told = told.with_said(table.said.rows, table.said.columns)
    return _unplaced(base, table, told)


# -- columns by their names --------------------------------------------------------------------


def _roles(table: Table, told: ColumnsTold) -> dict[str, int]:
    """Return the columns of frame and time that the header or their form makes known."""
    roles = {k: v for k, v in table.named.roles.items() if k in ("frame", "time")}
    if "frame" in roles:
        numbers = table.rows[:, roles["frame"]]
        steps = np.diff(numbers)
        # A finger is called index too: what numbers frames never goes down.
        if not np.isfinite(numbers).all() or (numbers % 1 != 0).any() or (steps < 0).any():
            del roles["frame"]
    if "time" in roles and told.time_format:
        roles[_CLOCK] = roles.pop("time")
    elif table.clocks:
        roles[_CLOCK] = roles.pop("time", table.clocks[0])
        if roles[_CLOCK] not in table.clocks:
            roles["time"] = roles.pop(_CLOCK)
    return roles


def _unnamed_value(table: Table, roles: dict[str, int]) -> str:
    """Return what to ask where row and column are named and several others could be the value."""
    named = table.named
    if not {"row", "column"} <= named.roles.keys() or named.cells or "value" in named.roles:
        return ""
    taken = {*named.roles.values(), *roles.values(), *table.labels}
    left = [named.names[k] for k in range(table.width) if k not in taken]
    return (
        f"its header names row and column, and the value could be any of {', '.join(left[:6])}; "
        "give value_column"
    )


def _strange_column(table: Table, roles: dict[str, int]) -> str:
    known = {*table.clocks, *table.labels, *roles.values()}
    words = [k for k in table.words if k not in known and k not in table.named.others]
    if not words:
        return ""
    k = words[0]
    text = table.texts[0][k].strip()[:30]
    return f"line {table.first_line}, column {k + 1}: {text!r} is no number"


def _left_out(table: Table, roles: dict[str, int], cells: Sequence[int]) -> tuple[str, ...]:
    """Return the note on columns that are neither cells nor known."""
    taken = {*cells, *roles.values()}
    names = [
        table.named.names[k] if table.named.names else f"column {k + 1}"
        for k in range(table.width)
        if k not in taken
    ]
    return (f"columns left out that are no cells ({', '.join(names[:6])})",) if names else ()


def _timed(base: Layout, table: Table) -> Layout:
    """Return the layout with the factor of its time; where nobody says the unit, it is assumed."""
    if table.named.time_factor is not None:
        return replace(base, time_factor=table.named.time_factor)
    times = table.rows[:, base.roles["time"]]
    factor, unit = unit_of(times[np.isfinite(times)])
    return replace(
        base, time_factor=factor, assumed=(*base.assumed, f"times assumed to be in {unit}")
    )


def unit_of(times: Numbers) -> tuple[float, str]:
    """Return the factor and the name of the unit that times are most likely in."""
    steps = np.diff(times)
    steps = steps[steps > 0]
    if len(times) and times[-1] > 1e17:
        return 1e-9, "nanoseconds"
    if len(times) and times[-1] > 1e14:
        return 1e-6, "microseconds"
    if len(times) and times[-1] > 1e11:
        return 1e-3, "milliseconds"
    if len(steps) and (times % 1 == 0).all() and np.median(steps) >= 5.0:
        # Five seconds from frame to frame is no recording, five milliseconds is one.
        late = np.median(steps) >= 5000.0
        return (1e-6, "microseconds") if late else (1e-3, "milliseconds")
    return 1.0, "seconds"


# -- one cell a line ---------------------------------------------------------------------------


def _long(base: Layout, table: Table) -> Layout:
    roles = dict(table.named.roles)
    if table.clocks and roles.get("time", table.clocks[0]) in table.clocks:
        roles.pop("time", None)
        roles[_CLOCK] = table.clocks[0]
    names = {role: table.named.names[k] for role, k in table.named.roles.items()}
    said = table.said
    if table.named.quantity != "raw":
        said = replace(said, quantity=table.named.quantity, factor=table.named.factor)
    base = replace(base, kind="long", roles=roles, said=said)
    base = _timed(base, table) if "time" in roles else base
    return replace(
        base,
        why=f"its header names row ({names['row']!r}), column ({names['column']!r}) and value "
        f"({names['value']!r})",
    )


# -- a frame a line by the names of its cells --------------------------------------------------


def _placed(base: Layout, table: Table, told: Told) -> Layout:
    places = table.named.places
    rows, columns = max(p.row for p in places) + 1, max(p.column for p in places) + 1
    said = (table.said.rows or rows, table.said.columns or columns)
    wanted = (told.rows or rows, told.columns or columns)
    first = table.named.names[base.cells[0]], table.named.names[base.cells[-1]]
    by_names = f"the names of its cells ({first[0]} to {first[1]}) say {rows} x {columns} cells"
    for shape, who in ((wanted, "the settings"), (said, "the words before the table")):
        if shape != (rows, columns):
            return replace(base, trouble=f"{by_names}, {who} {shape[0]} x {shape[1]}")
    if 2 * len(places) < rows * columns:
        return replace(
            base,
            trouble=f"{by_names}, of which it holds {len(places)}; give cells, rows and columns",
        )
    order = tuple(p.row * columns + p.column for p in places)
    plain = order == tuple(range(rows * columns))
    return replace(
        base, kind="flat", shape=(rows, columns), places=() if plain else order, why=by_names
    )


def _ordered(base: Layout, table: Table, shape: tuple[int, int]) -> tuple[int, ...]:
    """Return the places of cells whose names have a number each; empty where they come in order."""
    numbers = table.named.numbers
    if not numbers or len(numbers) != shape[0] * shape[1]:
        return ()
    rank = {n: k for k, n in enumerate(sorted(numbers))}
    order = tuple(rank[n] for n in numbers)
    return () if order == tuple(range(len(order))) else order


# -- no names of cells: by settings, groups and the numbers themselves ------------------------


def _unplaced(base: Layout, table: Table, told: Told) -> Layout:
    base = _without_extra(base, table, told)
    if told.rows is None and told.columns is None and _is_scan(table, base):
        return replace(base, trouble=_scan_question())
    if base.trouble:
        return base
    width, (groups, run) = len(base.cells), table.groups
    index = table.named.names[base.roles["frame"]] if "frame" in base.roles else "?"
    # What pandas writes before each line numbers frames or the rows of one matrix alike.
    lead = bool(base.roles) and not (table.named.names and not index and len(base.roles) == 1)
    kind, rows, why = _decide(table, base, told, lead)
    if kind == "stacked":
        return replace(
            base,
            kind=kind,
            rows=rows,
            blank_run=run if len(groups) > 1 else ENDLESS,
            roles={},
            why=why,
        )
    if kind == "unclear":
        return replace(base, trouble=base.trouble or why)
    return _flat(base, table, told, width, why)


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
    if len(groups) > 1 and usual > 1:
        return "stacked", usual, f"blank lines or frame lines after every {usual} rows"
    if lead:
        return "flat", 0, "a time or a number before the values"
    return _by_numbers(table, base, n)


def _by_numbers(table: Table, base: Layout, n: int) -> tuple[str, int, str]:
    """Return what `_decide` returns where nothing but the numbers can tell."""
    cells = table.rows[:, base.cells]
    width = cells.shape[1]
    square = _is_square(width)
    lengths = row_lengths(cells) if n > 1 else []
    framed = bool(lengths) and width >= 16
    long = max(n, width) > LONGEST_UNTOLD * min(n, width)
    matrix_like = n > 1 and not long and n <= MOST_LINES_UNTOLD and table.whole
    question = (
        f"{n} lines of {width} values could be one matrix or a frame a line"
        + (f" (of {lengths[0][0]} x {lengths[0][1]} cells, as they lie)" if framed else "")
        + "; give the settings rows and columns"
    )
    if n == width:
        return ("unclear", 0, question) if framed else ("stacked", n, "as many lines as columns")
    if square and not matrix_like:
        return "flat", 0, f"{width} values a line, a square number"
    if square:
        clarity = row_length_clarity(cells, isqrt(width))
        if clarity < CLEAR or (np.isnan(clarity) and width >= SMALLEST_SURE_SQUARE):
            return "flat", 0, f"{width} values a line, which lie together as a square"
        return "unclear", 0, question
    if matrix_like and width <= MOST_COLUMNS_UNTOLD and not framed:
        return "stacked", n, f"{n} lines of {width} values"
    return "unclear", 0, question


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


def _without_extra(base: Layout, table: Table, told: Told) -> Layout:
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
    if len(table.groups[0]) > 1:
        return _row_numbers(base, table)
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


def _row_numbers(base: Layout, table: Table) -> Layout:
    """Return the layout of stacked matrices without a first column that numbers their rows."""
    size = Counter(table.groups[0]).most_common(1)[0][0]
    first = table.rows[: size * (len(table.rows) // size), base.cells[0]].reshape(-1, size)
    if size < 3 or not len(first) or not all(counts_up(m) for m in first):
        return base
    if first[0][0] not in (0.0, 1.0):
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
    return _timed(base, table) if time is not None else base


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
