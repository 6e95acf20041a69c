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
from dataclasses import replace
from math import isqrt

import numpy as np

from tactile_graph_sources.readers.tables.evidence import (
    CLEAR,
    row_length_clarity,
    row_lengths,
    spacing,
)
from tactile_graph_sources.readers.tables.extra import without_extra
from tactile_graph_sources.readers.tables.frame_shape import shape_of_cells
from tactile_graph_sources.readers.tables.layout import Layout, timed
from tactile_graph_sources.readers.tables.names import ColumnsTold
from tactile_graph_sources.readers.tables.sensors import of_one_sensor
from tactile_graph_sources.readers.tables.table import ENDLESS, Table, table_of
from tactile_graph_sources.readers.told import Told
from tactile_graph_sources.readers.units import length_unit

SMALLEST_SURE_SQUARE = 64
MOST_COLUMNS_UNTOLD, MOST_LINES_UNTOLD = 63, 256
LONGEST_UNTOLD = 4
"""Times its breadth: a matrix longer than that is more likely many frames."""
_CLOCK = "clock"


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
    try:
        table, sensor = of_one_sensor(table, told)
    except ValueError as error:
        return replace(base, trouble=str(error))
    base = replace(base, sensor=sensor)
    roles = _roles(table, told.of_columns)
    trouble = _unnamed_value(table, roles) or _strange_column(table, roles)
    if trouble:
        return replace(base, trouble=trouble)
    if table.named.is_long:
        return _long(base, table)
    base = replace(base, roles=roles)
    if roles.get("time") is not None:
        base = timed(base, table)
    base = replace(base, time_format=told.of_columns.time_format)
    n_told = (told.rows or 0) * (told.columns or 0)
    empty = () if table.width in (n_told, told.columns) else table.empty
    cells = table.named.cells or tuple(
        k
        for k in range(table.width)
        if k not in roles.values() and k not in table.labels and k not in empty
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
    base = timed(base, table) if "time" in roles else base
    factors = {role: length_unit(names[role]) for role in ("row", "column")}
    apart = [spacing(table.rows[:, roles[r]], bool(f)) for r, f in factors.items()]
    if apart[0] is None or apart[1] is None:
        role = "row" if apart[0] is None else "column"
        what = (
            f"its header names row ({names['row']!r}) and column ({names['column']!r}), but what "
            f"stands under {names[role]!r} are no places on a grid"
        )
        return replace(base, kind="unclear", trouble=what)
    base = _spaced(base, table, (apart[0], apart[1]))
    return replace(
        base,
        why=f"its header names row ({names['row']!r}), column ({names['column']!r}) and value "
        f"({names['value']!r})",
    )


def _spaced(base: Layout, table: Table, apart: tuple[float, float]) -> Layout:
    """Return the layout of a long table whose places are so far apart, and the pitch they give."""
    if apart == (1.0, 1.0):
        return base
    factors = [length_unit(table.named.names[base.roles[role]]) for role in ("row", "column")]
    said = base.said
    if factors[0] and factors[1] and said.pitch_cm is None:
        said = replace(said, pitch_cm=(apart[1] * factors[1], apart[0] * factors[0]))
    first = table.rows[0, base.roles["row"]], table.rows[0, base.roles["column"]]
    return replace(base, spacing=apart, first=(float(first[0]), float(first[1])), said=said)


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
    base = without_extra(base, table, told)
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
