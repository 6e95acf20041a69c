"""What the columns of a table are by the names in its header, in the languages of spreadsheets.

A header may name what a frame or a cell is known by (number, time, row, column, value), or the
cells themselves: ``r0c0``, ``S0_0``, ``x3y1``, ``B4``, ``v17``. The places that names of cells
give go before the order of the columns.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field, replace
from fnmatch import fnmatch
from typing import NamedTuple

from tactile_graph.errors import did_you_mean, one_of
from tactile_graph_sources.readers.words.units import UNIT_WORDS, length_unit, value_unit

_UNITS_OF_TIME = {
    1.0: "s sec secs second seconds sekunde sekunden seconde secondes segundos secondi",
    1e-3: "ms msec msecs millis millisecond milliseconds millisekunden millisecondes",
    1e-6: r"us µs μs \xb5s usec usecs micros microsecond microseconds mikrosekunden microsecondes",
    1e-9: "ns nsec nsecs nanos nanosecond nanoseconds nanosekunden nanosecondes",
    60.0: "min mins minute minutes minuten minutos minuti",
    3600.0: "h hr hrs hour hours std stunde stunden heures horas ore",
    86400.0: "d day days tag tage jour jours días dias giorni datenum",
}
SECONDS = {unit: seconds for seconds, units in _UNITS_OF_TIME.items() for unit in units.split()}
"""Seconds in the units of time that files spell."""
_INITIALS = {"h", "d"}
"""Units of time that stand for heights, depths and days of which a column holds the number."""
_ROLES = {
    "frame": "frame frame_index frameindex index frame_no frame_number n nr no num sample scan seq "
    "packet bild bildnr image trame cuadro fotograma muestra quadro #",
    "time": "time t ts timestamp time_stamp seconds elapsed elapsed_time millis micros ms us date "
    "datetime date_time clock epoch epoch_time unix unix_time zeit zeitstempel uhrzeit temps heure "
    "horodatage tiempo hora tempo ora timestamps zeitpunkt instant momento tijd tid czas stamp "
    "systime system_time host_time device_time datenum",
    "row": "row r y i rows row_index zeile reihe ligne rang fila riga line linha rij rad wiersz",
    "column": "column col c x j columns col_index column_index spalte colonne columna colonna "
    "coluna kolom kolumn kolumna",
    "value": "value v val values pressure reading force counts count raw adc z wert messwert druck "
    "kraft valeur pression valor presión presion fuerza valore pressione voltage volts signal "
    "p intensity amplitude resistance spannung tension pressão waarde druk värde wartość",
}
ROLES = {word: role for role, words in _ROLES.items() for word in words.split()}
_UNIT = re.compile(r"^(.*?)\s*(?:\[([^\]\d][^\]]*)\]|\(([^)\d][^)]*)\)|[_/ ]([^\W\d_]+\d?))$")
_BRACKETED = re.compile(r"[\[(]\s*([^\W\d_][^\])]*?)\s*[\])]\s*$")
_LIKE_A_PLACE = re.compile(r"[a-z]+\W?\d+", re.IGNORECASE)
_PARTS = {
    "nsec": 1e-9,
    "nsecs": 1e-9,
    "nanosec": 1e-9,
    "nanosecs": 1e-9,
    "usec": 1e-6,
    "usecs": 1e-6,
}
_WHOLE = {"sec", "secs"}
"""How the two columns are called that ROS and others write a time in, and seconds of the second."""
_ANY_TWO = re.compile(r"\D*(\d+)\D+(\d+)\D*")
_PAIRS = (
    (re.compile(r"\D*?\b[a-z_]*?r(?:ow)?\W?_?(\d+)\W*_?c(?:ol|olumn)?\W?_?(\d+)\W*"), False),
    (re.compile(r"\D*?\b[a-z_]*?c(?:ol|olumn)?\W?_?(\d+)\W*_?r(?:ow)?\W?_?(\d+)\W*"), True),
    (re.compile(r"\W*x\W?_?(\d+)\W*_?y\W?_?(\d+)\W*"), True),
    (re.compile(r"\W*s(?:palte)?\W?_?(\d+)\W*_?z(?:eile)?\W?_?(\d+)\W*"), True),
    (_ANY_TWO, False),
)
"""Names of cells with two numbers, and whether the column comes first."""
_LETTER = re.compile(r"([a-z])(\d+)")
_NUMBER = re.compile(r"\D*(\d{1,7})\D*")
FEWEST_CELLS = 3
MOST_NARROW = 8
"""Columns of a table that may hold one cell a line, whatever else it holds."""
_OF_LINES = ("frame", "time", "row")
"""What a column may say of a whole line of cells."""
_LETTERS = frozenset("nrycxijvzp")
_RANGE = re.compile(r"(\d{1,7})\s*-\s*(\d{1,7})?|(\d{1,7})")


class ColumnsTold(NamedTuple):
    """What the settings say of a table's columns, by name or number from 1; empty: nothing."""

    frame: str = ""
    time: str = ""
    value: str = ""
    cells: str = ""
    time_unit: str = ""
    time_format: str = ""

    @property
    def given(self) -> tuple[str, ...]:
        """The settings that say something, as the source calls them."""
        names = zip(self._fields, self, strict=True)
        return tuple(
            n if n.startswith(("time_", "cells")) else f"{n}_column" for n, v in names if v
        )


NOTHING_TOLD = ColumnsTold()


class Place(NamedTuple):
    """Row and column of a cell, from 0."""

    row: int
    column: int


@dataclass(frozen=True)
class Named:
    """What a header says.

    Parameters
    ----------
    names : tuple of str
        As written, without quotes.
    roles : dict
        The column of ``frame``, ``time``, ``row``, ``column`` and ``value``, where there is one.
    cells : tuple of int
        The columns whose names are those of cells, in the order of the columns.
    places : tuple of Place
        Where those cells lie; empty where their names give no two numbers.
    numbers : tuple of int
        Of cells that have one number each.
    time_factor : float, optional
        From the column of time to seconds; None where its name has no unit.
    time_unit : str
        What stands in brackets behind its name and is no unit of time that is known.
    quantity, factor : str, float
        What the column of values, or what all cells hold, by the unit in their names.
    part : (int, float), optional
        The column that comes on top of the one of time, and the seconds of one in it.
    """

    names: tuple[str, ...] = ()
    roles: dict[str, int] = field(default_factory=dict)
    cells: tuple[int, ...] = ()
    places: tuple[Place, ...] = ()
    numbers: tuple[int, ...] = ()
    time_factor: float | None = None
    time_unit: str = ""
    quantity: str = "raw"
    factor: float = 1.0
    part: tuple[int, float] | None = None

    @property
    def others(self) -> tuple[int, ...]:
        """The columns that are neither cells nor known by their names."""
        return tuple(
            k for k in range(len(self.names)) if k not in self.cells and k not in self._known
        )

    @property
    def _known(self) -> set[int]:
        return {*self.roles.values(), *([self.part[0]] if self.part else [])}

    @property
    def is_long(self) -> bool:
        """Whether each line holds one cell."""
        return {"row", "column", "value"} <= self.roles.keys()


def as_told(named: Named, width: int, told: ColumnsTold) -> Named:
    """Return what the header says, but for what the settings say otherwise.

    Raises
    ------
    ValueError
        If a setting names a column that is not there.
    """
    roles = dict(named.roles)
    for role in ("frame", "time", "value"):
        if wanted := getattr(told, role):
            column = _column(named, width, f"{role}_column", wanted)
            roles = {r: k for r, k in roles.items() if k != column} | {role: column}
    cells, places, numbers = named.cells, named.places, named.numbers
    if told.cells:
        cells, places, numbers = _chosen(named, width, told.cells), (), ()
        roles = {r: k for r, k in roles.items() if k not in cells}
    elif taken := [k for k in roles.values() if k in cells]:
        kept = [k for k, c in enumerate(cells) if c not in taken]
        cells = tuple(cells[k] for k in kept)
        places = tuple(places[k] for k in kept) if places else ()
        numbers = tuple(numbers[k] for k in kept) if numbers else ()
    factor = SECONDS[told.time_unit] if told.time_unit else named.time_factor
    return replace(
        named, roles=roles, cells=cells, places=places, numbers=numbers, time_factor=factor
    )


def _column(named: Named, width: int, setting: str, wanted: str) -> int:
    lower = [n.lower() for n in named.names]
    if wanted.lower() in lower:
        return lower.index(wanted.lower())
    if wanted.isdecimal() and 1 <= int(wanted[:7]) <= width:
        return int(wanted) - 1
    there = one_of(named.names, 8) if named.names else f"no names, {width} columns"
    raise ValueError(
        f"{setting}: there is no column {wanted!r}; there are {there}"
        f"{did_you_mean(wanted, named.names)}"
    )


def _chosen(named: Named, width: int, pattern: str) -> tuple[int, ...]:
    """Return the columns that a setting such as ``2-65`` or ``v*`` names, in their order."""
    chosen: set[int] = set()
    for part in (p.strip() for p in pattern.split(",")):
        found = _RANGE.fullmatch(part)
        if found is not None:
            first = int(found[1] or found[3])
            last = int(found[2] or (found[3] or width))
            chosen |= set(range(max(first, 1) - 1, min(last, width)))
        else:
            chosen |= {k for k, n in enumerate(named.names) if fnmatch(n.lower(), part.lower())}
    if not chosen:
        there = one_of(named.names, 8) if named.names else f"no names, {width} columns"
        raise ValueError(f"cells: no column is {pattern!r}; there are {there}")
    return tuple(sorted(chosen))


def named(header: Sequence[str]) -> Named:
    """Return what the names of a header say of the columns."""
    names = tuple(n.strip("\0").strip().strip("\"'").strip() for n in header)
    cells, places, numbers = _cells(names)
    roles: dict[str, int] = {}
    factor, unknown, quantity, scale = None, "", "raw", 1.0
    for k, name in enumerate(names):
        base, unit = _parts(name)
        role = ROLES.get(name.lower()) or ROLES.get(base)
        if role is None or role in roles or k in cells:
            continue
        if len(names) > MOST_NARROW and (role not in _OF_LINES or name.lower() in _LETTERS):
            continue  # of many columns called a, b, c, … none is the rows
        if role == "value" and _is_height(name, names):
            continue
        roles[role] = k
        if role == "time":
            factor = SECONDS.get(unit.rstrip(".")) or SECONDS.get(name.lower())
            found = _BRACKETED.search(name)
            unknown = found[1] if found is not None and factor is None else ""
        elif role == "value":
            quantity, scale = value_unit(unit or base)
    part = _in_parts(names)
    if part is not None and part[0] not in cells:
        roles["time"], factor = part[0], 1.0
    for k, name in enumerate(names[:2]):
        unit = found[1].lower() if (found := _BRACKETED.search(name)) else ""
        if "time" not in roles and k not in cells and unit in SECONDS.keys() - _INITIALS:
            # X(s) of an oscilloscope
            roles["time"], factor = k, SECONDS[unit]
    if names and not names[0] and "frame" not in roles and cells[:1] != (0,):
        roles["frame"] = 0  # as pandas writes an index
    if {"row", "column"} <= roles.keys() and "value" not in roles:
        worded = [k for k, n in enumerate(names) if k not in roles.values() and _is_value(n)]
        if len(worded) == 1:
            roles["value"] = worded[0]
            quantity, scale = value_unit(_parts(names[worded[0]])[1])
    if {"row", "column"} <= roles.keys() and "value" not in roles:
        left = [k for k, n in enumerate(names) if k not in roles.values() and n]
        left = [k for k in left if names[k].lower() not in UNIT_WORDS]
        left = [k for k in left if not _is_height(names[k], names)]
        if len(left) == 1:
            roles["value"] = left[0]
            quantity, scale = value_unit(_parts(names[left[0]])[1] or names[left[0]])
    if cells:
        quantity, scale = _unit_of_cells([names[k] for k in cells])
    return Named(
        names, roles, cells, places, numbers, factor, unknown, quantity, scale,
        part[1:] if part else None,
    )  # fmt: skip


def _in_parts(names: Sequence[str]) -> tuple[int, int, float] | None:
    """Return the columns of whole seconds and of what comes on top, and its unit in seconds."""
    ends = [re.split(r"[\W_]+", name.lower())[-1] for name in names]
    whole = next((k for k, end in enumerate(ends) if end in _WHOLE), None)
    part = next((k for k, end in enumerate(ends) if end in _PARTS), None)
    return None if whole is None or part is None else (whole, part, _PARTS[ends[part]])


def _unit_of_cells(names: Sequence[str]) -> tuple[str, float]:
    """Return the quantity and factor of the unit that stands in brackets behind every name."""
    units = units_of(names)
    return value_unit(units.pop()) if len(units) == 1 else ("raw", 1.0)


def units_of(names: Sequence[str]) -> set[str]:
    """Return what stands in brackets behind names; an empty text for those without."""
    return {_unit_behind(n)[1] for n in names}


def _unit_behind(name: str) -> tuple[str, str]:
    """Return the name of a cell and what stands in brackets behind it: ``R1C1 (N/cm2)``.

    A unit with a digit, which is none of the cell's, needs no brackets.
    """
    if found := _BRACKETED.search(name):
        return name[: found.start()].rstrip(), found[1]
    base, _, last = name.rpartition(" ")
    has_digit = any(c.isdecimal() for c in last)
    return (base, last) if base and has_digit and value_unit(last)[0] != "raw" else (name, "")


def _without_units(names: Sequence[str]) -> list[str]:
    """Return names without units behind numbers: known ones, or the one that all of them have."""
    parts = [_unit_behind(n) for n in names]
    parts = [(b, u if any(c.isdecimal() for c in b) else "") for b, u in parts]
    units = {u for _, u in parts} - {""}
    alike = len(units) == 1 and not any(map(_LIKE_A_PLACE.fullmatch, units))
    return [
        base if unit and (alike or value_unit(unit)[0] != "raw") else name
        for name, (base, unit) in zip(names, parts, strict=True)
    ]


def _is_value(name: str) -> bool:
    """Return whether a name of several words begins with one for values: ``Pression relevée``."""
    first = re.split(r"[\W_]+", name.lower(), maxsplit=1)[0]
    return len(first) > 1 and ROLES.get(first) == "value"


def _is_height(name: str, names: Sequence[str]) -> bool:
    """Return whether a column such as ``z_mm`` is a height, as another one holds the values."""
    if _parts(name)[0] != "z" and length_unit(name) is None:
        return False
    others = [_parts(n) for n in names if n != name and length_unit(n) is None]
    return any(ROLES.get(b) == "value" or value_unit(u or b)[0] != "raw" for b, u in others)


def _parts(name: str) -> tuple[str, str]:
    """Return a name in lower case without the unit at its end, and that unit."""
    found = _UNIT.match(name)
    if found is None:
        return name.lower(), ""
    unit = next((u for u in found.groups()[1:] if u), "")
    return found[1].strip().lower().removesuffix(" in"), unit.strip().lower()


def _cells(names: Sequence[str]) -> tuple[tuple[int, ...], tuple[Place, ...], tuple[int, ...]]:
    """Return the columns that are cells by their names, with their places or their numbers."""
    lower = [n.lower() for n in _without_units(names)]
    for pattern, column_first in _PAIRS:
        found = [(k, m) for k, n in enumerate(lower) if (m := pattern.fullmatch(n))]
        if len(found) >= FEWEST_CELLS and 2 * len(found) > len(names):
            pairs = [(int(m[1][:6]), int(m[2][:6])) for _, m in found]
            if pattern is _ANY_TWO and _is_of_one_device(found):
                return tuple(k for k, _ in found), (), tuple(b for _, b in pairs)
            if len(set(pairs)) == len(pairs):
                pairs = [(b, a) for a, b in pairs] if column_first else pairs
                return tuple(k for k, _ in found), tuple(_from_zero(pairs)), ()
    lettered = [(k, m) for k, n in enumerate(lower) if (m := _LETTER.fullmatch(n))]
    if len(lettered) >= FEWEST_CELLS and len({m[1] for _, m in lettered}) > 1:
        pairs = [(ord(m[1]) - ord("a"), int(m[2][:6])) for _, m in lettered]
        if len(set(pairs)) == len(pairs):
            # B4 is row B in some houses and column B in others: what changes from one name to
            # the next is the column.
            turned = pairs[0][1] == pairs[1][1]
            pairs = [(b, a) for a, b in pairs] if turned else pairs
            return tuple(k for k, _ in lettered), tuple(_from_zero(pairs)), ()
    return _numbered(lower)


def _is_of_one_device(found: Sequence[tuple[int, re.Match[str]]]) -> bool:
    """Return whether the first of two numbers is a device's: ``Dev1/ai0``, ``Dev1/ai1``, …."""
    between = {m.string[m.end(1) : m.start(2)].strip("\\/_-. [](){},;:") for _, m in found}
    words = {m[1] for _, m in found}
    return len(words) == len(between) == 1 and between.pop() not in {"", *ROLES}


def _numbered(names: Sequence[str]) -> tuple[tuple[int, ...], tuple[Place, ...], tuple[int, ...]]:
    stems: dict[str, list[tuple[int, int]]] = {}
    for k, name in enumerate(names):
        found = _NUMBER.fullmatch(name)
        if found:
            stems.setdefault(re.sub(r"\d+", "#", name), []).append((k, int(found[1])))
    best = max(stems.values(), key=len, default=[])
    numbers = [n for _, n in best]
    if len(best) < FEWEST_CELLS or 2 * len(best) <= len(names) or len(set(numbers)) < len(numbers):
        return (), (), ()
    return tuple(k for k, _ in best), (), tuple(numbers)


def _from_zero(pairs: Sequence[tuple[int, int]]) -> Iterator[Place]:
    """Yield places that count from 0, where either of them counts from 1."""
    row_0, column_0 = (min(1, *(p[k] for p in pairs)) for k in (0, 1))
    for row, column in pairs:
        yield Place(row - row_0, column - column_0)
