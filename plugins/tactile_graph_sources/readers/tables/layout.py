"""``Layout``: how the numbers lie in a plain table, and in what unit its times are."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field, replace

import numpy as np

from tactile_graph.errors import DataError
from tactile_graph_sources.readers.tables.evidence import Numbers
from tactile_graph_sources.readers.tables.sides import Side
from tactile_graph_sources.readers.tables.table import Table
from tactile_graph_sources.readers.words.compact import HHMMSS, are_hhmmss, stamps_s
from tactile_graph_sources.readers.words.dialect import Dialect, unquoted
from tactile_graph_sources.readers.words.preamble import Described

_DAY_S = 86400.0
_DAYS, _LONGEST_STEP = (20_000.0, 80_000.0), 2e-4
"""From 1954 to 2119, and 17 seconds."""
_DAYS_TO_1900 = 693_960.0
"""What MATLAB's days are more than those of spreadsheets."""


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
    rows_of_sums : int
        Of these, the last ones, which are no cells.
    blank_run : int
        Blank lines that end a matrix.
    breaks : frozenset of str
        Signatures of other lines that do.
    header_line : str
        The line that numbers the columns of a matrix; empty without one.
    n_fields : int
        Of a line of separators alone that is a row without a value; 0 where it is a blank line.
    time_factor : float
        From the column of time to seconds.
    part : (int, float), optional
        Column of what comes on top of the time, and the seconds of one in it.
    date : int, optional
        Column of the date, where that of clock holds times of day alone.
    colon_s : float
        Unit of what stands behind a last colon of times of day; 0 for decimals of a second.
    time_format : str
        Of the column of clock, where the settings say it.
    spacing : (float, float), optional
        Distance of rows and of columns where a long table holds positions, not their numbers.
    unit_cm : (float, float), optional
        Centimetres of what the positions of rows and of columns are in, where that is a length.
    one_line : str
        ``row`` or ``column`` where the first lines lie in one of them alone; empty else.
    sensor : (int, str), optional
        The column that says which sensor a line is of, and the one that is read.
    side : Side, optional
        Which sections are read, where titles say left and right.
    others : tuple of (int, str)
        Columns of a long table that nothing is taken from, and their names.
    unit : (int, str), optional
        The column that says the unit of each line's values, and what it says of all.
    first : (float, float)
        The first row's and the first column's position, where they are positions.
    said : Described
        What the words before the table say.
    why, assumed : str, tuple of str
        How it was recognised, and what nobody said.
    trouble : str
    sensors : tuple of str
        Those of which one is to be named, where that is the trouble.
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
    rows_of_sums: int = 0
    blank_run: int = 1
    breaks: frozenset[str] = frozenset()
    header_line: str = ""
    n_fields: int = 0
    time_factor: float = 1.0
    part: tuple[int, float] | None = None
    date: int | None = None
    time_format: str = ""
    colon_s: float = 0.0
    spacing: tuple[float, float] | None = None
    first: tuple[float, float] = (0.0, 0.0)
    unit_cm: tuple[float, float] | None = None
    one_line: str = ""
    sensor: tuple[int, str] | None = None
    side: Side | None = None
    others: tuple[tuple[int, str], ...] = ()
    unit: tuple[int, str] | None = None
    said: Described = field(default_factory=Described)
    why: str = ""
    assumed: tuple[str, ...] = ()
    trouble: str = ""
    sensors: tuple[str, ...] = ()


def of_sensor(layout: Layout, line: str) -> bool:
    """Return whether a line is of the sensor that is read; any is where nothing parts them."""
    if layout.sensor is None:
        return True
    column, wanted = layout.sensor
    fields = layout.dialect.fields(line)
    return len(fields) <= column or unquoted(fields[column]) == wanted


def refuse_other_unit(layout: Layout, where: str, fields: Sequence[str]) -> None:
    """Refuse a line whose values are in another unit than those of the first lines.

    Raises
    ------
    DataError
        If it says one.
    """
    if layout.unit is None or len(fields) <= layout.unit[0]:
        return
    said = unquoted(fields[layout.unit[0]])
    if said and said != layout.unit[1]:
        raise DataError(where, several_units((layout.unit[1], said)))


def several_units(units: Iterable[str]) -> str:
    """Return what to say of values in several units."""
    return f"its values are in several units ({', '.join(map(repr, units))}); write them in one"


def timed(base: Layout, table: Table) -> Layout:
    """Return the layout with the factor of its time; where nobody says the unit, it is assumed.

    Dates and times of day that are written as one number make the column one of clock.
    """
    if table.named.time_factor is not None:
        return replace(base, time_factor=table.named.time_factor, part=table.named.part)
    times = table.rows[:, base.roles["time"]]
    times = times[np.isfinite(times)]
    clock = {"clock" if role == "time" else role: k for role, k in base.roles.items()}
    if stamps_s(times) is not None:
        return replace(base, roles=clock)
    if are_hhmmss(times):
        note = f"times taken for hours, minutes and seconds ({times[0]:06.0f})"
        assumed = (*base.assumed, note)
        return replace(base, roles=clock, time_format=HHMMSS, assumed=assumed)
    factor, note = assumed_unit(times, table.named.time_unit)
    return replace(base, time_factor=factor, assumed=(*base.assumed, note))


def days_of(times: Numbers) -> str:
    """Return how times count days, as spreadsheets or MATLAB keep dates; empty where they do not.

    As seconds they would be of a recording of more than 5000 frames a second.
    """
    if _are_days(times):
        return "days since 1900, as spreadsheets count them"
    if _are_days(times - _DAYS_TO_1900):
        return "days since the year 0, as MATLAB's datenum counts them"
    return ""


def _are_days(times: Numbers) -> bool:
    steps = np.diff(times)
    low, high = _DAYS
    return bool(
        len(times) > 1
        and low < times[0] <= times[-1] < high
        and (steps >= 0).all()
        and 0.0 < np.median(steps) < _LONGEST_STEP
    )


def assumed_unit(times: Numbers, unknown: str = "") -> tuple[float, str]:
    """Return the factor of times to seconds, and the note on it.

    Parameters
    ----------
    times : ndarray
        Finite ones, as they come.
    unknown : str
        What the file calls their unit, where it is none that is known.
    """
    factor, unit = unit_of(times)
    told = f", as {unknown!r} is no unit of time that is known (give time_unit)" if unknown else ""
    return factor, f"times assumed to be in {unit}{told}"


def unit_of(times: Numbers) -> tuple[float, str]:
    """Return the factor and the name of the unit that times are most likely in."""
    steps = np.diff(times)
    steps = steps[steps > 0]
    if days := days_of(times):
        return _DAY_S, days
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
