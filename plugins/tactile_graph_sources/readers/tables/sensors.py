"""Which columns or lines of a table belong to which sensor, where one file holds several.

Columns are told apart by how their names begin (``left_r0_c0``, ``palm_12``, ``sensor2_taxel7``),
lines by a column that is called ``sensor`` or the like.
"""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import replace
from math import isqrt
from typing import NamedTuple

import numpy as np

from tactile_graph.errors import did_you_mean, one_of
from tactile_graph_sources.readers.tables.breaks import FRAME_LINE, stamp_of
from tactile_graph_sources.readers.tables.sides import loose_titles
from tactile_graph_sources.readers.tables.table import Table, is_comment
from tactile_graph_sources.readers.words.dialect import is_row, unquoted
from tactile_graph_sources.readers.words.names import Named, as_told, named
from tactile_graph_sources.readers.words.told import Told

_PLACE = re.compile(
    r"(.*?)(?:[\W_]*r(?:ow)?[\W_]*\d+[\W_]*c(?:ol(?:umn)?)?[\W_]*\d+"
    r"|[\W_]*x[\W_]*\d+[\W_]*y[\W_]*\d+"
    r"|[\W_]*\d+[\W_]+\d+"
    r"|[\W_]+[^\W\d_]*\d+"
    r"|\d+)\W*",
    re.IGNORECASE,
)
"""The beginning of a cell's name, and the place on its sensor that follows."""
_TWO_NUMBERS = re.compile(r"([^\W\d]*?_?\d+)[\W_]+(\d+)\W*")
_WORDS = {
    "sensor", "sensors", "device", "dev", "pad", "finger", "hand", "foot", "insole", "glove",
    "module", "mod", "board", "array", "unit", "capteur", "sensore", "matte", "fuß", "fuss",
    "main", "mano", "pied", "triangle", "patch",
}  # fmt: skip
"""What sensors that are numbered are called; other numbered words are rows and columns."""
_LINE_COLUMNS = {
    "sensor", "sensor_id", "sensorid", "sensor_name", "sensorname", "sensor_no", "device",
    "device_id", "deviceid", "pad", "pad_id", "padid", "side", "foot", "hand", "finger",
    "location", "capteur", "sensore", "seite", "finger_id", "hand_id", "foot_id", "insole", "glove",
}  # fmt: skip
"""What a column is called that says of each line which sensor it is of."""
_PARTS = {
    "patch", "patch_id", "patchid", "module", "module_id", "moduleid", "taxel_group", "array",
    "array_id", "board", "board_id",
}  # fmt: skip
"""The same, or which part of one sensor: what its cells are wired to."""
FULL = 0.9
"""Share of a grid's cells that must be there for parts to make it up."""
_JOINTS = " _-.:/[("
FEWEST_CELLS, LEAST_SHARE = 6, 0.1
"""Of a sensor: cells, and their number over that of the largest one. Fewer are something else,
such as temperatures."""
MOST_SENSORS = 32
LONGEST_NAME = 80
SMALLEST_SQUARE, LONGEST = 16, 4
"""Cells of a row that may as well be a whole sensor, and how much longer than broad the grid must
be else."""


class Sensors(NamedTuple):
    """The columns of each sensor by its name; ``doubt`` is what else they could be, or empty."""

    columns: Mapping[str, tuple[int, ...]]
    doubt: str = ""

    def names(self) -> str:
        """Return what they are called, and how many cells they have."""
        return ", ".join(f"{n} ({len(c)} cells)" for n, c in self.columns.items())


NONE = Sensors({})


class NoneNamedError(ValueError):
    """There are several sensors, called ``names``, and none of them is asked for."""

    def __init__(self, text: str, names: Iterable[str]) -> None:
        super().__init__(text)
        self.names = tuple(names)


def sensors_of(names: Sequence[str]) -> Sensors:
    """Return the sensors that a header's names tell apart; none where there is only one."""
    found: dict[str, list[int]] = {}
    for k, name in enumerate(names):
        match = _PLACE.fullmatch(name.strip()) if len(name) <= LONGEST_NAME else None
        stem = match[1].rstrip(_JOINTS) if match else ""
        if stem:
            found.setdefault(stem, []).append(k)
    most = max(map(len, found.values()), default=0)
    kept = {
        stem: tuple(columns)
        for stem, columns in found.items()
        if len(columns) >= max(FEWEST_CELLS, LEAST_SHARE * most)
    }
    if 1 < len(kept) <= MOST_SENSORS and _are_sensors(kept):
        return Sensors(kept)
    return _perhaps(names)


def _are_sensors(stems: Mapping[str, tuple[int, ...]]) -> bool:
    """Return whether names that begin so are those of sensors, not of rows or columns."""
    # Z1S and Z2S are rows as much as Z1 and Z2 are, sensor1_t and sensor2_t are none.
    words = {re.sub(r"[\W_]*\d[\W\d_]*[^\W\d_]*[\W_]*$|[\W_]+$", "", s).lower() for s in stems}
    if len(words) == 1:
        return words <= _WORDS
    letters = sorted(words)
    one_each = all(len(word) == 1 for word in letters) and len(words) == len(stems)
    in_a_row = ord(letters[-1][-1:] or "a") - ord(letters[0][-1:] or "a") == len(letters) - 1
    return not (one_each and in_a_row)


def _perhaps(names: Sequence[str]) -> Sensors:
    """Return the few long rows of a grid that may as well be square sensors."""
    found: dict[str, list[int]] = {}
    for k, name in enumerate(names):
        match = _TWO_NUMBERS.fullmatch(name.strip()) if len(name) <= LONGEST_NAME else None
        if match:
            found.setdefault(match[1], []).append(k)
    sizes = {len(columns) for columns in found.values()}
    n = next(iter(sizes), 0)
    square = isqrt(n) ** 2 == n >= SMALLEST_SQUARE
    if len(sizes) != 1 or not square or not 1 < len(found) < n / LONGEST:
        return NONE
    doubt = f"one grid of {len(found)} x {n} cells (then give rows={len(found)}, columns={n})"
    return Sensors({stem: tuple(columns) for stem, columns in found.items()}, doubt)


def chosen(names: Sequence[str], sensor: str) -> str:
    """Return the one of several sensors that a setting means, by its name or part of it.

    Raises
    ------
    ValueError
        If it names none, or several.
    """
    asked = sensor.lower()
    found = [n for n in names if n.lower() == asked] or [n for n in names if asked in n.lower()]
    if len(found) == 1:
        return found[0]
    if found:
        raise ValueError(f"sensor={sensor} may be any of {one_of(found)}; name one of them in full")
    raise ValueError(
        f"no sensor {sensor!r}, there are: {one_of(names)}{did_you_mean(sensor, names)}"
    )


def lines_of_sensors(
    names: Sequence[str], texts: Sequence[Sequence[str]]
) -> tuple[int, tuple[str, ...]] | None:
    """Return the column that says of each line which sensor it is of, and what it names.

    Parameters
    ----------
    names : sequence of str
        The header.
    texts : sequence of sequence of str
        The fields of the first lines.

    Returns
    -------
    (int, tuple of str) or None
        None where no column does, or all lines are of one sensor.
    """
    for k, name in enumerate(names):
        if found := labels_of_lines(name, (unquoted(row[k]) for row in texts)):
            return k, found
    return None


def labels_of_lines(name: str, said: Iterable[str]) -> tuple[str, ...]:
    """Return the sensors that a column or key of such a name tells apart by what it says.

    None where it is not called so, or says the same of all, or hardly anything twice.
    """
    if name.strip().lower() not in _LINE_COLUMNS | _PARTS:
        return ()
    counted = Counter(said)
    often = sorted(n for n, times in counted.items() if times > 1)
    return tuple(often) if 1 < len(often) == len(counted) <= MOST_SENSORS else ()


def is_named(table: Table, lines: Sequence[str], sensor: str) -> bool:
    """Return whether a table says that it is of a sensor: a column, each line, or its first words.

    Words say it where no others between the rows may name another one.

    Parameters
    ----------
    table : Table
    lines : sequence of str
        The first lines of the file.
    sensor : str
        What is asked for.
    """
    asked, names = sensor.lower(), table.named.names
    said = [n for n in names if _PLACE.fullmatch(n.strip())]
    columns = [k for k, n in enumerate(names) if n.strip().lower() in _LINE_COLUMNS | _PARTS]
    said += [row[k] for row in table.texts[:1] for k in columns]
    if any(asked in text.lower() for text in said):
        return True
    if loose_titles(lines):
        return False
    word = re.compile(rf"(?<![^\W_]){re.escape(asked)}(?![^\W_])", re.IGNORECASE)
    above, below = lines[: table.first_line - 1], table.lines
    others = (line for line in below if not word.search(line))
    return any(map(word.search, above)) and not any(map(_may_name, others))


def _may_name(line: str) -> bool:
    plain = is_row(line) or is_comment(line) or FRAME_LINE.fullmatch(line)
    return not plain and any(c.isalpha() for c in line) and stamp_of(line).time is None


def of_one_sensor(table: Table, told: Told) -> tuple[Table, tuple[int, str] | None]:
    """Return a table as it is for the one of its sensors that is asked for.

    Returns
    -------
    Table
        Without the lines, and without the names of cells, of the others.
    (int, str) or None
        The column that says which sensor a line is of, and what it then says.

    Raises
    ------
    NoneNamedError
        If there are several sensors and none of them is asked for.
    ValueError
        If what is asked for is none of them.
    """
    names = table.named.names
    lines = lines_of_sensors(names, table.texts)
    if lines is not None and not (not told.sensor and _are_of_one_grid(table, lines[0])):
        column, labels = lines
        if not told.sensor:
            raise NoneNamedError(
                f"its lines are those of several sensors, as column {names[column]!r} says: "
                f"{one_of(labels)}; name one with sensor",
                labels,
            )
        sensor = chosen(labels, told.sensor)
        mine = [k for k, row in enumerate(table.texts) if unquoted(row[column]) == sensor]
        texts = tuple(table.texts[k] for k in mine)
        return replace(table, rows=table.rows[mine], texts=texts), (column, sensor)
    sensors = NONE if told.of_columns.cells else sensors_of(names)
    n_cells = sum(map(len, sensors.columns.values()))
    if not sensors.columns or (told.rows or 0) * (told.columns or 0) == n_cells:
        return table, None
    if not told.sensor:
        doubt = f", or of {sensors.doubt}" if sensors.doubt else ""
        raise NoneNamedError(
            f"its columns are those of several sensors: {sensors.names()}{doubt}; name one with "
            "sensor",
            sensors.columns,
        )
    sensor = chosen(tuple(sensors.columns), told.sensor)
    return replace(table, named=_named_alone(table, sensors, sensor, told)), None


def _are_of_one_grid(table: Table, column: int) -> bool:
    """Return whether a column names parts of one grid, which fill it and share no cell."""
    named = table.named
    if not named.is_long or named.names[column].strip().lower() not in _PARTS:
        return False
    row, across = (table.rows[:, named.roles[role]] for role in ("row", "column"))
    cells = set(zip(row.tolist(), across.tolist(), strict=True))
    parts = {(*cell, text[column]) for *cell, text in zip(row, across, table.texts, strict=True)}
    n_grid = len(np.unique(row)) * len(np.unique(across))
    return len(parts) == len(cells) >= FULL * n_grid


def _named_alone(table: Table, sensors: Sensors, sensor: str, told: Told) -> Named:
    """Return what a header says when the columns of the other sensors are not looked at."""
    mine = sensors.columns[sensor]
    others = {k for name, columns in sensors.columns.items() if name != sensor for k in columns}
    kept = [k for k in range(table.width) if k not in others]
    names = [n.strip() for n in table.named.names]
    alone = named(
        [names[k][len(sensor) :].lstrip(_JOINTS) if k in mine else names[k] for k in kept]
    )
    whole = replace(
        alone,
        names=table.named.names,
        roles={role: kept[k] for role, k in alone.roles.items()},
        cells=tuple(kept[k] for k in alone.cells) or mine,
    )
    return as_told(whole, table.width, told.of_columns)
