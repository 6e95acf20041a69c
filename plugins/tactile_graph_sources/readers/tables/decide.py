"""How the numbers lie in a plain table: one frame a line, stacked matrices, or one cell a line.

A table seldom says what it is. The rules, in order:

1. settings, then the names in a header, then words before the table, say what the columns are;
2. a row, a column and a value: one cell a line;
3. rows and columns told: a line of rows x columns values is a frame, one of columns a row;
4. groups of equal lines between blank lines (or lines such as ``Frame 3``): stacked matrices,
   unless between blank lines each has a time of its own or cells lie together as a frame's do;
5. names of cells, a time or a number before the values: a frame a line;
6. as many lines as columns, or nearly, which have no names: one matrix;
7. a square number of values a line: a frame a line;
8. anything else is asked for, never guessed, and so is what the numbers themselves speak against:
   a first column that climbs, cells that lie together in rows of another length.
"""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Collection, Sequence
from dataclasses import replace

import numpy as np

from tactile_graph.errors import one_of
from tactile_graph_sources.readers.tables.axes_named import axes_question
from tactile_graph_sources.readers.tables.blanks import (
    as_wide_as_told,
    blank_rows,
    may_have_blank_rows,
    of_empty_columns,
)
from tactile_graph_sources.readers.tables.by_numbers import unplaced
from tactile_graph_sources.readers.tables.doubts import doubt_about
from tactile_graph_sources.readers.tables.evidence import counts_up, spacing
from tactile_graph_sources.readers.tables.layout import Layout, days_of, several_units, timed
from tactile_graph_sources.readers.tables.positions import like_positions, pitch_cm, unit_cm
from tactile_graph_sources.readers.tables.sensors import NoneNamedError, is_named, of_one_sensor
from tactile_graph_sources.readers.tables.sides import (
    Side,
    are_numbered_alike,
    asked_of,
    loose_titles,
    names_of,
    of_several,
    of_side,
    sides_of,
)
from tactile_graph_sources.readers.tables.table import Table, table_of
from tactile_graph_sources.readers.words.counter import runs_over
from tactile_graph_sources.readers.words.dialect import unquoted
from tactile_graph_sources.readers.words.moments import colon_unit_s, zone_remedy
from tactile_graph_sources.readers.words.names import ColumnsTold, named, units_of
from tactile_graph_sources.readers.words.told import Told
from tactile_graph_sources.readers.words.units import (
    NO_UNITS,
    UNIT_WORDS,
    length_unit,
    taken_as_they_are,
    value_unit,
)

FEWEST_NAMED = 4
_CLOCK = "clock"
_MARKED_UP = ("<?xml", "<!doctype", "<html")
_TIME_NAME = re.compile(
    r"(?:t|time|zeit|temps|tiempo|tempo)\s*[=_ ]\s*(\d+(?:[.,]\d+)?)\s*(?:s|sec|ms|us|min)?"
    r"|(\d+(?:[.,]\d+)?)\s*(?:s|sec|ms|us|min)"
)


def layout_of(
    lines: Sequence[str], told: Told, whole: bool, names: Sequence[str] = ()
) -> Layout | None:
    """Return how the numbers lie; None where the lines are no table of numbers.

    Parameters
    ----------
    lines : sequence of str
        The first lines of the file.
    told : Told
    whole : bool
        Whether there are no more lines.
    names : sequence of str
        Of the columns, where each line says them.
    """
    if lines and lines[0].lstrip().lower().startswith(_MARKED_UP):
        return None
    sides = sides_of(lines)
    if sides:
        return _of_one_side(lines, sides, told, whole, names)
    layout = _layout_of(lines, told, whole, names)
    loose = loose_titles(lines) if layout is not None else None
    if layout is None or not loose or not (sides := sides_of(lines, loose)):
        return layout
    if layout.trouble == _names_none(told.sensor) or are_numbered_alike(lines, loose):
        return _of_one_side(lines, sides, told, whole, names)
    note = f"lines such as {sides[0].title!r} taken for remarks"
    remedy = f"(give sensor={sides[0].name} if they are titles of sections)"
    return replace(layout, assumed=(*layout.assumed, f"{note} {remedy}"))


def _of_one_side(
    lines: Sequence[str], sides: Sequence[Side], told: Told, whole: bool, names: Sequence[str]
) -> Layout | None:
    """Return what `layout_of` does of a table with sections of the left and the right."""
    try:
        side = asked_of(sides, told.sensor)
    except ValueError as error:
        return Layout("unclear", trouble=str(error), sensors=names_of(sides))
    if side is None and (told.sensor or len(sides) > 1):
        both = names_of(sides)
        there = f"no sensor {told.sensor!r}; " if told.sensor else ""
        return Layout("unclear", trouble=there + of_several(both), sensors=both)
    alone = replace(told, sensor="")
    if len(sides) == 1 and whole and (side is None or side.which == sides[0].which):
        return _layout_of(lines, alone, whole, names)
    if whole and side is not None and side.which not in {s.which for s in sides}:
        return Layout("unclear", trouble=_names_none(told.sensor))
    side = side or replace(sides[0], alone=True)
    known = side if side.which in {s.which for s in sides} else sides[0]
    mine = [line for _, line in of_side(enumerate(lines), replace(known, alone=False), "")]
    layout = _layout_of(mine, alone, whole, names)
    return None if layout is None else replace(layout, side=side)


def _names_none(sensor: str) -> str:
    return f"no sensor {sensor!r} is told apart by columns, lines or titles of it; leave sensor out"


def _layout_of(
    lines: Sequence[str], told: Told, whole: bool, names: Sequence[str]
) -> Layout | None:
    """Return what `layout_of` does of lines that are of one sensor, but for columns of others."""
    try:
        table = table_of(lines, told.of_columns, whole, names)
    except ValueError as error:
        return Layout("unclear", trouble=str(error))
    if table is None:
        return None
    shape = told.with_said(table.said.rows, table.said.columns)
    if table.positions is not None and _are_told(table, shape):
        table = table_of(lines, told.of_columns, whole, names, placed=False) or table
    of_blanks: tuple[str, ...] = ()
    if may_have_blank_rows(table, lines):
        table, of_blanks = _with_blank_rows(table, shape, lines, told, names)
    table, of_width = as_wide_as_told(table, shape)
    base = Layout("unclear", table.dialect, table.width, table.first_line, said=table.said)
    base = replace(base, n_fields=table.n_fields if table.padded else 0, assumed=of_width)
    if table.positions is not None:
        base = _placed_apart(base, table, lines, told)
    try:
        table, sensor = of_one_sensor(table, told)
    except NoneNamedError as error:
        return replace(base, trouble=str(error), sensors=error.names)
    except ValueError as error:
        return replace(base, trouble=str(error))
    if told.sensor and not is_named(table, lines, told.sensor):
        return replace(base, trouble=_names_none(told.sensor))
    base = replace(base, sensor=sensor)
    roles = _roles(table, told.of_columns)
    trouble = (
        doubt_about(lines, table.dialect)
        or _unnamed_value(table, roles)
        or _strange_time(table, roles)
        or _strange_column(table, roles)
        or _several_units(table)
        or _cells_by_line(table, roles)
        or _frames_by_column(table)
        or ("" if told.of_columns.cells else axes_question(table))
    )
    if trouble:
        return replace(base, trouble=trouble)
    base = _in_unit(base, table)
    if base.trouble:
        return base
    if table.named.is_long:
        return _long(base, table, told)
    base = replace(base, assumed=(*base.assumed, *_strange_unit(base, table)))
    date = table.dates[0] if table.dates and _CLOCK in roles else None
    base = replace(base, roles=roles, date=date, colon_s=_colon_s(table, roles))
    if roles.get("time") is not None:
        base = timed(base, table)
    base = replace(base, time_format=told.of_columns.time_format or base.time_format)
    n_told = (shape.rows or 0) * (shape.columns or 0)
    empty = () if table.width in (n_told, shape.columns) else table.empty
    apart = {*roles.values(), *table.labels, *table.dates, *empty}
    apart |= set() if table.positions is None else {0}
    apart |= {base.unit[0]} if base.unit else set()
    cells = table.named.cells or tuple(k for k in range(table.width) if k not in apart)
    read = {*cells, *roles.values(), *(() if date is None else (date,))}
    read |= {base.part[0]} if base.part else set()
    read |= {base.unit[0]} if base.unit else set()
    base = replace(base, cells=cells, assumed=(*base.assumed, *_left_out(table, read)))
    if not cells:
        return None
    if table.named.places:
        return _placed(base, table, told)
    layout = unplaced(base, table, shape)
    if layout.kind != "stacked":
        return layout
    n = len(table.rows) // layout.rows
    matrices = table.rows[: n * layout.rows, list(layout.cells)]
    matrices = matrices.reshape(n, layout.rows, len(layout.cells))
    notes = (*of_blanks, *filter(None, [like_positions(matrices)]))
    if shape.columns is None:
        notes += of_empty_columns(table, len(empty))
    return replace(layout, assumed=(*layout.assumed, *notes))


def _are_told(table: Table, shape: Told) -> bool:
    """Return whether rows or columns that are told are those with what may be positions."""
    sizes = Counter(table.groups[0])
    return shape.columns == table.width or shape.rows == sizes.most_common(1)[0][0] + 1


def _placed_apart(base: Layout, table: Table, lines: Sequence[str], told: Told) -> Layout:
    """Return the layout with the pitch that positions beside the cells give, and the note on it."""
    x, y = positions = table.positions or (1.0, 1.0)
    corner, words = table.dialect.fields(table.header_line)[0], lines[: table.first_line - 1]
    unit = unit_cm(corner, words)
    note = f"positions beside the cells, {x:g} x {y:g} apart"
    pitch = None if told.pitch_cm or base.said.pitch_cm else pitch_cm(positions, unit)
    if pitch is not None:
        base = replace(base, said=replace(base.said, pitch_cm=pitch))
        taken = "taken for mm" if unit is None else f"a pitch of {pitch[0]:g} x {pitch[1]:g} cm"
        note = f"{note}, {taken} (else give pitch_cm)"
    return replace(base, assumed=(*base.assumed, note))


def _with_blank_rows(
    table: Table, shape: Told, lines: Sequence[str], told: Told, names: Sequence[str]
) -> tuple[Table, tuple[str, ...]]:
    """Return the table with its lines of separators alone as what they are, and the note on it."""
    padded = table_of(lines, told.of_columns, table.whole, names, True, table.positions is not None)
    if padded is None:
        return table, ()
    are_rows, notes = blank_rows(table, padded, shape)
    return (padded if are_rows else table), notes


# -- columns by their names --------------------------------------------------------------------


def _roles(table: Table, told: ColumnsTold) -> dict[str, int]:
    """Return the columns of frame and time that the header or their form makes known."""
    roles = {k: v for k, v in table.named.roles.items() if k in ("frame", "time")}
    if roles.get("time") in table.dates:
        del roles["time"]  # its time of day stands elsewhere
    if "frame" in roles:
        numbers = table.rows[:, roles["frame"]]
        falls = np.flatnonzero(np.diff(numbers) < 0)
        # A finger is called index too: what numbers frames goes down only where it runs over.
        down = not all(runs_over(numbers[k], numbers[k + 1]) for k in falls)
        if not np.isfinite(numbers).all() or (numbers % 1 != 0).any() or down:
            del roles["frame"]
    if "time" not in roles and not table.clocks:
        days = [k for k in table.named.others if days_of(table.rows[:, k])]
        roles.update([("time", k) for k in days[:1]])
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


def _colon_s(table: Table, roles: dict[str, int]) -> float:
    """Return the unit of what stands behind the last colon of times; 0 where it is decimals."""
    return colon_unit_s(row[roles[_CLOCK]] for row in table.texts) if _CLOCK in roles else 0.0


def _strange_time(table: Table, roles: dict[str, int]) -> str:
    """Return what to ask where the column of times holds neither numbers nor known times of day."""
    k = roles.get("time", table.named.roles.get("time"))
    if k is None or k not in table.words or k in (*table.clocks, *table.dates):
        return ""
    if roles.get(_CLOCK) is not None:
        return ""
    name = f"{table.named.names[k]!r}" if table.named.names else f"{k + 1}"
    text = table.texts[0][k].strip()
    remedy = zone_remedy(text) or (
        "say how it is written as strptime takes it, such as time_format='%H:%M:%S'"
    )
    return f"its column {name} says {text[:30]!r}, no number and no time that is known; {remedy}"


def _strange_column(table: Table, roles: dict[str, int]) -> str:
    known = {*table.clocks, *table.dates, *table.labels, *roles.values()}
    words = [k for k in table.words if k not in known and k not in table.named.others]
    if not words:
        return ""
    k = words[0]
    wrong = next((j for j, x in enumerate(table.rows[:, k]) if np.isnan(x)), 0)
    text = table.texts[wrong][k].strip()[:30]
    line = "" if wrong else f"line {table.first_line}, "
    if "[[" in table.lines[0] and not table.lines[0].lstrip().startswith("[["):
        return (
            f"{line}words stand before a matrix in brackets; leave them out, so that each line is "
            "a list of rows: [[1, 2], [3, 4]]"
        )
    return (
        f"{line}column {k + 1}: {text!r} is no number; write numbers with a decimal point and "
        "without marks between thousands (a cell without a value is left empty, or NaN), or say "
        "which columns are cells, such as cells=2-65"
    )


def _several_units(table: Table) -> str:
    """Return what to ask where cells are of several units, by their names."""
    units = sorted(_units(table) - {""})
    if len({value_unit(u) for u in units}) < 2:
        return ""
    return (
        f"its cells are in several units ({one_of(map(repr, units))}); write them in one, or say "
        "which columns are cells, such as cells=2-65"
    )


def _units(table: Table) -> set[str]:
    """Return the units that the names of cells or values say, an empty text for none."""
    named = table.named
    columns = [named.roles["value"]] if named.is_long else named.cells
    return units_of([named.names[k] for k in columns]) if named.names else set()


def _strange_unit(base: Layout, table: Table) -> tuple[str, ...]:
    """Return the notes on words before the table, and on a unit that is of no known quantity."""
    units = _units(table)
    unit = units.pop() if len(units) == 1 else ""
    if not unit or base.said.quantity != "raw":
        return base.said.notes
    return *taken_as_they_are(unit), *base.said.told


def _in_unit(base: Layout, table: Table) -> Layout:
    """Return the layout of a table of which a column says the unit of the values."""
    k = next((k for k, n in enumerate(table.named.names) if n.lower() in UNIT_WORDS), None)
    if k is None or k not in table.words or k in table.named.cells:
        return base
    units = list(dict.fromkeys(filter(None, (unquoted(row[k]) for row in table.texts))))
    known = {value_unit(unit) for unit in units} - {("raw", 1.0)}
    if not known and not (len(units) == 1 and units[0].lower() in NO_UNITS):
        return base  # of a device, or of nobody knows what: it is told as left out
    if len(units) > 1:
        return replace(base, trouble=several_units(units))
    base, said = replace(base, unit=(k, units[0])), base.said
    if not known:
        return base
    quantity, factor = known.pop()
    others = {(said.quantity, said.factor), (table.named.quantity, table.named.factor)}
    if others - {("raw", 1.0), (quantity, factor)}:
        what = f"its column {table.named.names[k]!r} says {units[0]!r}, other words of it another"
        return replace(base, trouble=f"{what} unit; leave out what is not so")
    return replace(base, said=replace(said, quantity=quantity, factor=factor))


def _cells_by_line(table: Table, roles: dict[str, int]) -> str:
    """Return what to ask where each line is named as a cell, so that its numbers are its times."""
    for k in table.words:
        texts = [row[k] for row in table.texts]
        if k in roles.values() or k in table.clocks or len(texts) < FEWEST_NAMED:
            continue
        places = named(texts).places
        rows, columns = ({p[axis] for p in places} for axis in (0, 1))
        if len(places) == len(texts) > len(rows) * len(columns) / 2 and len(columns) > 1:
            return (
                f"its lines look like cells ({texts[0].strip()}, {texts[1].strip()}, …) and its "
                "columns like frames; exchange them (in a spreadsheet: paste, transposed), so that "
                "each line is a frame"
            )
    return ""


def _frames_by_column(table: Table) -> str:
    """Return what to ask where the columns are named as frames: ``t=0.1s``, ``0.2 s``, …."""
    names = [table.named.names[k] for k in table.named.cells if table.named.names]
    found = [_TIME_NAME.fullmatch(n.strip().lower()) for n in names]
    times = [float((m[1] or m[2]).replace(",", ".")) for m in found if m is not None]
    if len(times) < max(FEWEST_NAMED, len(names)) or any(np.diff(times) <= 0):
        return ""
    return (
        f"its columns are named as times ({names[0]}, {names[1]}, …), so that each would be a "
        "frame; exchange lines and columns (in a spreadsheet: paste, transposed)"
    )


def _left_out(table: Table, taken: Collection[int]) -> tuple[str, ...]:
    """Return the note on columns that nothing is taken from."""
    names = [
        table.named.names[k] if table.named.names else f"column {k + 1}"
        for k in range(table.width)
        if k not in taken
    ]
    return (f"columns left out that are no cells ({', '.join(names[:6])})",) if names else ()


# -- one cell a line ---------------------------------------------------------------------------


def _long(base: Layout, table: Table, told: Told) -> Layout:
    roles = dict(table.named.roles)
    if "time" in roles and told.of_columns.time_format:
        roles[_CLOCK] = roles.pop("time")
    elif table.clocks and roles.get("time", table.clocks[0]) in (*table.clocks, *table.dates):
        roles.pop("time", None)
        roles[_CLOCK] = table.clocks[0]
    base = replace(base, date=table.dates[0] if table.dates and _CLOCK in roles else None)
    base = replace(base, colon_s=_colon_s(table, roles))
    names = {role: table.named.names[k] for role, k in table.named.roles.items()}
    said = base.said
    if table.named.quantity != "raw":
        said = replace(said, quantity=table.named.quantity, factor=table.named.factor)
    base = replace(base, kind="long", roles=roles, said=said)
    base = replace(base, time_format=told.of_columns.time_format)
    base = timed(base, table) if "time" in roles else base
    base = replace(base, others=_unread(base, table))
    left_out = ", ".join(name for _, name in base.others[:6])
    notes = *_strange_unit(base, table), *([f"columns left out ({left_out})"] if left_out else [])
    base = replace(base, assumed=(*base.assumed, *notes))
    apart = _apart(table, roles)
    if apart[0] is None or apart[1] is None or not any(apart):
        role = "row" if apart[0] is None else "column"
        what = (
            f"its header names row ({names['row']!r}) and column ({names['column']!r}), but what "
            f"stands under {names[role]!r} are no places on a grid; cells that lie anywhere, as on "
            "a skin, are not read: resample each frame to a grid, in Python with "
            "scipy.interpolate.griddata; where they lie on one, write the numbers of rows and "
            "columns there"
        )
        return replace(base, kind="unclear", trouble=what)
    if not all(apart):
        base = _in_one_line(base, "column" if apart[0] else "row", told)
    base = _spaced(base, table, (apart[0], apart[1]))
    return replace(
        base,
        why=f"its header names row ({names['row']!r}), column ({names['column']!r}) and value "
        f"({names['value']!r})",
    )


def _apart(table: Table, roles: dict[str, int]) -> list[float | None]:
    """Return how far apart rows and columns are, as `spacing` does."""
    axes = [table.rows[:, roles[role]] for role in ("row", "column")]
    seen_whole = table.whole and table.n_rows == len(table.rows)
    of_line = [seen_whole and len(np.unique(p[np.isfinite(p)])) == 1 for p in axes]
    units = _centimetres(table, roles)
    return [spacing(axes[k], bool(units[k]), of_line[1 - k]) for k in (0, 1)]


def _centimetres(table: Table, roles: dict[str, int]) -> list[float | None]:
    """Return the units of the positions of rows and columns in cm; None where there are none."""
    return [length_unit(table.named.names[roles[role]]) for role in ("row", "column")]


def _in_one_line(base: Layout, line: str, told: Told) -> Layout:
    """Return the layout of cells that all lie in one row or column, as those of a strip do."""
    base = replace(base, one_line=line)
    if told.pitch_cm or base.said.pitch_cm:
        return base
    other = "column" if line == "row" else "row"
    note = f"{line}s taken to be as far apart as {other}s, as there is one {line} alone"
    return replace(base, assumed=(*base.assumed, note))


def _unread(base: Layout, table: Table) -> tuple[tuple[int, str], ...]:
    """Return the columns of a long table that nothing is taken from, and their names.

    What pandas writes before each line, and empty columns, hold nothing.
    """
    read = {*base.roles.values(), *table.named.roles.values()}
    read |= {found[0] for found in (base.part, base.sensor, base.unit) if found is not None}
    read |= set() if base.date is None else {base.date}
    named = table.named.names
    return tuple(
        (k, name or f"column {k + 1}")
        for k, name in enumerate(named)
        if k not in read
        and any(row[k].strip() for row in table.texts)
        and (name or not counts_up(table.rows[:, k]))
    )


def _spaced(base: Layout, table: Table, apart: tuple[float, float]) -> Layout:
    """Return the layout of a long table whose places are so far apart, and the pitch they give.

    Where 0 says that an axis has but one place, the other one's distance is taken.
    """
    factors = _centimetres(table, base.roles)
    ratio = factors[0] / factors[1] if factors[0] and factors[1] else 1.0
    apart = (apart[0] or apart[1] / ratio, apart[1] or apart[0] * ratio)
    places = table.rows[:, [base.roles["row"], base.roles["column"]]]
    whole = (np.nanmedian(np.round(places, 6) % 1, axis=0) == 0.0).all()
    if apart == (1.0, 1.0) and whole and not all(factors):
        return base
    said = base.said
    if factors[0] and factors[1]:
        base = replace(base, unit_cm=(factors[0], factors[1]))
        pitch_cm = (apart[1] * factors[1], apart[0] * factors[0])
        said = replace(said, pitch_cm=said.pitch_cm or pitch_cm)
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
