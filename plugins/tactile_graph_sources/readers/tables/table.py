"""A plain table taken apart: the words before it, its header, and the first of its rows."""

from __future__ import annotations

import csv
import math
import re
from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property
from math import isqrt

import numpy as np

from tactile_graph_sources.readers.tables import labview
from tactile_graph_sources.readers.tables.breaks import (
    FRAME_LINE,
    breaks_of,
    is_time,
    opens_matrix,
    signature,
    stamp_of,
)
from tactile_graph_sources.readers.tables.evidence import Numbers, as_numbers, is_count
from tactile_graph_sources.readers.tables.positions import positions_of
from tactile_graph_sources.readers.words.dialect import (
    ERRORS,
    MISSING,
    Dialect,
    is_row,
    without_rules,
)
from tactile_graph_sources.readers.words.moments import clock_s, is_date
from tactile_graph_sources.readers.words.names import (
    ROLES,
    SECONDS,
    ColumnsTold,
    Named,
    as_told,
    named,
)
from tactile_graph_sources.readers.words.preamble import Described, described
from tactile_graph_sources.readers.words.units import value_unit

_BLANK = re.compile(r"[\s,;|]*|\s*[-=*_~]{3,}\s*|[\s|]*:?-{3,}[\s|:-]*")
_COMMENT = ("#", "%", "//")
_FIELD = re.compile(r"[^\s,;|]+")
_LONGEST_NUMBER = 24
OWN = re.compile(
    r"# (\d{1,7}) rows, (\d{1,7}) columns, (?:pitch \((\S+), (\S+)\) cm, )?"
    r"(?:origin \((\S+), (\S+)\) cm, )?(\w+); cells row by row"
)
"""The comment that a table begins with which the project wrote."""
_LOOKED_AT, _SAMPLED = 4000, 400
MOST_DAMAGED = 0.1
"""Share of the first rows that may hold what is no number where others hold one."""
ENDLESS = 1 << 30
"""As a run of blank lines: none ends a matrix, only its last row does."""


def is_blank(line: str) -> bool:
    """Return whether a line holds nothing but separators, or is a ruled line."""
    return _BLANK.fullmatch(line) is not None


def is_comment(line: str) -> bool:
    """Return whether a line is a comment, not a row that begins with a spreadsheet's error."""
    text = line.lstrip()
    return text.startswith(_COMMENT) and not text.lower().startswith(ERRORS)


@dataclass(frozen=True)
class Table:
    """The parts of a table.

    Parameters
    ----------
    dialect : Dialect
    width : int
        Usual number of fields of a line, separators that all lines end with left out.
    first_line : int
        Number of the first row, from 1; what is before it is words.
    lines : tuple of str
        The first lines of the file from that row on.
    named : Named
        What the names right before the first row say, and the settings.
    said : Described
    rows : ndarray, shape (n, width)
        The first rows; NaN where a field is no number.
    texts : tuple of tuple of str
        The same fields as written.
    whole : bool
        Whether the file has no more lines.
    header_line : str
        The line that numbers the columns, which may stand above each matrix; empty without one.
    n_fields : int
        Usual number of fields of a line, with those that separators at its end leave empty.
    padded : bool
        Whether lines of as many separators as rows have are rows, though they hold at most one
        number.
    positions : (float, float), optional
        How far apart columns and rows are by the header line and the first column, which are no
        cells then.
    """

    dialect: Dialect
    width: int
    first_line: int
    lines: tuple[str, ...]
    named: Named
    said: Described
    rows: Numbers
    texts: tuple[tuple[str, ...], ...] = field(repr=False)
    whole: bool
    header_line: str = ""
    n_fields: int = 0
    padded: bool = False
    positions: tuple[float, float] | None = None

    @cached_property
    def n_rows(self) -> int:
        """How many rows the first lines hold."""
        return sum(self._are_rows)

    @cached_property
    def _are_rows(self) -> tuple[bool, ...]:
        return tuple(
            (
                is_row(line)
                and not self._is_lone(line)
                and not self._is_frame_line(line)
                and line != self.header_line
            )
            or (self.padded and self.is_padded(line))
            for line in self.lines
        )

    @property
    def row_lines(self) -> list[str]:
        """The first lines that are rows."""
        return [x for x, one in zip(self.lines, self._are_rows, strict=True) if one]

    def is_padded(self, line: str) -> bool:
        """Return whether a line of as many separators as rows have holds at most one number."""
        return is_padded(line, self.dialect, self.n_fields)

    def _is_frame_line(self, line: str) -> bool:
        """Return whether ``Frame 3;t;12,5`` opens a matrix: it has not as many fields as rows."""
        return (
            FRAME_LINE.fullmatch(line) is not None and len(self.dialect.fields(line)) != self.width
        )

    def _is_lone(self, line: str) -> bool:
        """Return whether a line is a single number where rows hold several."""
        return self.width > 2 and len(line) < _LONGEST_NUMBER and len(_FIELD.findall(line)) == 1

    @cached_property
    def breaks(self) -> frozenset[str]:
        """What lines say that stand after every so many rows, such as the time of a frame.

        Where a header names cells, each line is a frame, whatever stands between.
        """
        if self.named.cells:
            return frozenset()
        kept = [
            (x, one)
            for x, one in zip(self.lines, self._are_rows, strict=True)
            if one or not is_blank(x)
        ]
        return breaks_of([self.dialect.pointed(x) for x, _ in kept], [one for _, one in kept])

    def _is_break(self, line: str) -> bool:
        return signature(self.dialect.pointed(line)) in self.breaks

    @property
    def times_without_unit(self) -> list[float]:
        """The times between matrices whose unit nobody says."""
        stamps = [stamp_of(self.dialect.pointed(x)) for x in self.lines if self._is_break(x)]
        return [s.time for s in stamps if s.time is not None and s.unit_s is None]

    @cached_property
    def clocks(self) -> tuple[int, ...]:
        """Columns that hold dates or times of day."""
        return tuple(k for k in self.words if clock_s(self.texts[0][k]) is not None)

    @cached_property
    def dates(self) -> tuple[int, ...]:
        """Columns that hold dates without a time of day."""
        return tuple(k for k in self.words if is_date(self.texts[0][k]))

    @cached_property
    def labels(self) -> tuple[int, ...]:
        """Columns that hold words without a digit."""
        column = {k: [row[k] for row in self.texts] for k in self.words}
        return tuple(
            k for k, texts in column.items() if not any(c.isdigit() for t in texts for c in t)
        )

    @cached_property
    def empty(self) -> tuple[int, ...]:
        """Columns in front that hold nothing in any row, as spreadsheets leave them free."""
        n = 0
        while n < self.width and not any(row[n].strip() for row in self.texts):
            n += 1
        return tuple(range(n)) if len(self.texts) > 1 else ()

    @cached_property
    def words(self) -> tuple[int, ...]:
        """Columns of which most fields are no numbers and not empty."""
        # Between blanks a line of one value may begin with a dash, as lists are written.
        missing = MISSING - {"-"} if self.dialect.separator is None else MISSING
        wrong = [
            sum(
                math.isnan(value) and row[k].strip().lower() not in missing
                for value, row in zip(self.rows[:, k], self.texts, strict=True)
            )
            for k in range(self.width)
        ]
        return tuple(k for k, n in enumerate(wrong) if 2 * n > len(self.texts))

    @cached_property
    def groups(self) -> tuple[list[int], int]:
        """Sizes of groups of rows, and the number of blank lines that ends a group.

        Where a blank line stands after every row, only two of them end a matrix.
        """
        for run in (1, 2):
            groups, size, blanks = [], 0, 0
            for line, one in zip(self.lines, self._are_rows, strict=True):
                if not one and is_blank(line):
                    blanks += 1
                    continue
                if (
                    blanks >= run
                    or FRAME_LINE.fullmatch(line)
                    or line == self.header_line
                    or (opens_matrix(line) if one else self._is_break(line))
                ):
                    groups.append(size)
                    size = 0
                blanks = 0
                size += one
            groups = [g for g in [*groups, size] if g]
            if not groups or Counter(groups).most_common(1)[0][0] > 1:
                return groups, run
        return [sum(groups)], ENDLESS

    @property
    def n_parts(self) -> int:
        """How many groups the rows are of which numbers are known."""
        starts = np.cumsum([0, *self.groups[0][:-1]])
        return int(np.count_nonzero(starts < len(self.rows)))

    @cached_property
    def is_parted_by_words(self) -> bool:
        """Whether lines such as ``Frame 3`` or brackets say where a matrix begins."""
        return any(FRAME_LINE.fullmatch(line) or opens_matrix(line) for line in self.lines)

    @cached_property
    def is_torn(self) -> bool:
        """Whether no two groups of rows are of one size, as where words stand here and there."""
        sizes = self.groups[0]
        return len(sizes) > 1 and len(set(sizes)) == len(sizes)


def is_padded(line: str, dialect: Dialect, n_fields: int) -> bool:
    """Return whether a line of so many fields holds at most one number."""
    if dialect.separator is None or len(line) > n_fields + _LONGEST_NUMBER:
        return False
    held = _FIELD.findall(line)
    if len(held) > 1 or not all(map(_is_number, held)):
        return False
    return len(dialect.fields(line)) == n_fields > 2


def table_of(
    lines: Sequence[str],
    told: ColumnsTold,
    whole: bool,
    names: Sequence[str] = (),
    padded: bool = False,
    placed: bool = True,
) -> Table | None:
    """Return the parts of a table; None where the lines are none.

    Parameters
    ----------
    lines : sequence of str
        The first lines of the file.
    told : ColumnsTold
    whole : bool
        Whether there are no more lines.
    names : sequence of str
        Of the columns, where each line says them.
    padded : bool
        Whether lines of as many separators as rows have are rows.
    placed : bool
        Whether positions may stand beside the cells.

    Raises
    ------
    ValueError
        If a setting names a column that is not there.
    """
    begin = labview.end_of_header(lines[:_LOOKED_AT])
    rows = [
        (k, line)
        for k, line in enumerate(lines[:_LOOKED_AT])
        if k >= begin and not is_blank(line) and not is_comment(line) and is_row(line)
    ]
    if not rows:
        return None
    written = [line for _, line in rows[:200]]
    dialect = Dialect.of([x for x in written if not FRAME_LINE.fullmatch(x)] or written)
    fields = [(k, dialect.fields(line)) for k, line in rows[:2000]]
    width, n_fields = _width([f for _, f in fields])
    full = _full(fields, width)
    if not width or not full:
        return None
    wide = max(
        _named_width(dialect, lines[: full[0][0]], width, n_fields), _asked_width(told, n_fields)
    )
    if wide > width:
        width, full = wide, _full(fields, wide)
    if padded:
        full = _with_padded(full, lines[:_LOOKED_AT], dialect, n_fields)
    start = full[0][0]
    content = sum(1 for x in lines[start:_LOOKED_AT] if not is_blank(x) and not is_comment(x))
    if 2 * sum(k >= start for k, _ in rows) < content or len(rows) * width < start:
        return None  # a text that holds a few numbers
    header_line = ""
    header, unit = _header(dialect, lines[:start], width)
    if header and _changes(lines[:start], lines[start:_LOOKED_AT]):
        header, unit = (), ""
    if len(names) == width:
        header = tuple(names)
    if not header and len(full) > 1 and _is_numbered(full[0][1]):
        others = [(k, f) for k, f in full if lines[k] != lines[start]]
        if others:  # numbers that never change are readings
            header, header_line = tuple(full[0][1]), lines[start]
            full, start = others, others[0][0]
    placed = placed and not header and not told.cells
    positions = positions_of([f for _, f in full]) if placed else None
    if positions is not None:
        header_line = lines[start]
        full = [(k, f) for k, f in full if lines[k] != header_line]
        start = full[0][0]
    sample = [tuple(f) for _, f in full[:_SAMPLED]]
    sample, numbers = _sound(sample)
    rest, words = tuple(lines[start:]), [line for line in lines[:start] if not is_blank(line)]
    said = described(words)
    if unit and said.quantity == "raw":
        quantity, factor = value_unit(unit)
        said = replace(said, quantity=quantity, factor=factor)
    if labview.is_labview(lines):
        has_times = any(f[0].strip() for f in sample)
        header, cells, said, rest = labview.first_segment(header, lines, start, said, has_times)
        told = told._replace(cells=told.cells or cells)
    columns = as_told(named(header) if header else Named(), width, told)
    if columns.cells and said.quantity == "raw":
        said = replace(said, quantity=columns.quantity, factor=columns.factor)
    return Table(
        dialect,
        width,
        start + 1,
        rest,
        columns,
        said,
        numbers,
        tuple(sample),
        whole,
        header_line,
        n_fields,
        padded,
        positions,
    )


def _sound(sample: list[tuple[str, ...]]) -> tuple[list[tuple[str, ...]], Numbers]:
    """Return rows without the few that are damaged, and their numbers.

    What columns hold is told by the others; who reads the rows tells the damage.
    """
    numbers = as_numbers([[_number(t) for t in f] for f in sample])
    wrong = np.isnan(numbers)
    for row, k in np.argwhere(wrong):
        wrong[row, k] = sample[row][k].strip().lower() not in MISSING
    wrong[:, wrong.mean(axis=0) > MOST_DAMAGED] = False  # words, or times of day
    damaged = wrong.any(axis=1)
    if not damaged.any() or damaged.mean() > MOST_DAMAGED:
        return sample, numbers
    return [sample[k] for k in np.flatnonzero(~damaged)], numbers[~damaged]


def _number(text: str) -> float:
    try:
        return float(text)
    except ValueError:
        return math.nan


def _is_number(text: str) -> bool:
    return not math.isnan(_number(text))


def _full(fields: Sequence[tuple[int, list[str]]], width: int) -> list[tuple[int, list[str]]]:
    """Return the rows that are whole, without what looks like one but holds names."""
    full = [(k, f[:width]) for k, f in fields if len(f) >= width and not any(f[width:])]
    if len(full) > 1 and width > 1 and not any(map(_is_number, full[0][1])):
        return full[1:]  # names with numbers in them look like a row
    return full


def _with_padded(
    full: Sequence[tuple[int, list[str]]], lines: Sequence[str], dialect: Dialect, n_fields: int
) -> list[tuple[int, list[str]]]:
    """Return the rows with those that hold nothing, also right before the first of them."""
    width, first = len(full[0][1]), full[0][0]
    while first and is_padded(lines[first - 1], dialect, n_fields):
        first -= 1
    found = dict(full)
    for k in range(first, len(lines)):
        if k not in found and is_padded(lines[k], dialect, n_fields):
            found[k] = dialect.fields(lines[k])[:width]
    return sorted(found.items())


def _width(fields: Sequence[Sequence[str]]) -> tuple[int, int]:
    """Return the usual number of fields, without those at the end that all lines leave empty."""
    usual = Counter(len(f) for f in fields).most_common(1)[0][0]
    alike = [f for f in fields if len(f) == usual]
    extra = 0
    while extra < usual and not any(f[usual - 1 - extra].strip() for f in alike):
        extra += 1
    return usual - extra, usual


def _named_width(dialect: Dialect, before: Sequence[str], width: int, n_fields: int) -> int:
    """Return the width with columns that hold nothing, as far as the header says they are cells.

    Spare columns have names, too: cells are those with which the names fill a grid, and whatever
    is named by row and column.
    """
    for wide in range(n_fields, width, -1):
        header, _ = _header(dialect, before, wide)
        found = named(header) if header else Named()
        if _fill_a_grid(found) and (found.places or not _fill_a_grid(found, width)):
            return wide
    return width


def _fill_a_grid(header: Named, width: int = ENDLESS) -> bool:
    """Return whether the named cells of the first columns fill a grid, a square if unplaced."""
    within = [k < width for k in header.cells]
    if not header.places:
        return isqrt(sum(within)) ** 2 == sum(within)
    places = [place for place, one in zip(header.places, within, strict=True) if one]
    rows, columns = ({place[axis] for place in places} for axis in (0, 1))
    return len(places) == len(rows) * len(columns)


def _asked_width(told: ColumnsTold, n_fields: int) -> int:
    """Return up to which column the settings say cells by number."""
    asked = [int(n[:7]) for n in re.findall(r"\d+", told.cells)]
    by_number = re.fullmatch(r"[\d\s,-]*", told.cells) is not None
    return min(max(asked, default=0), n_fields) if by_number else 0


def _header(dialect: Dialect, before: Sequence[str], width: int) -> tuple[tuple[str, ...], str]:
    """Return the names in the last line of words before the rows, and the unit of most of them.

    A line of units may stand below the names: those of time are put behind their names.
    """
    names = _names(dialect, before, width)
    units = [n.strip("\"'[]() ") for n in names]
    if len(units) < 2 or not all(u == "-" or not u or _is_unit(u) for u in units):
        return names, ""
    written = max(k for k, line in enumerate(before) if not is_blank(line))
    above = _names(dialect, before[:written], width)
    if not above or not any(units):
        return names, ""
    timed = [f"{n} [{u}]" if u.lower() in SECONDS else n for n, u in zip(above, units, strict=True)]
    others = Counter(u for u in units if u and u != "-" and u.lower() not in SECONDS)
    return tuple(timed), others.most_common(1)[0][0] if others else ""


def _changes(before: Sequence[str], behind: Sequence[str]) -> bool:
    """Return whether the last of the words before rows comes again with other numbers.

    It names no columns then, but tells of each matrix: ``Index,3,,,``.
    """
    line = next(x for x in reversed(before) if not is_blank(x)).strip()
    said, alike = signature(line), (x.strip() for x in behind if x[:1] == line[:1])
    return any(x.lower() != line.lower() and signature(x) == said and not is_row(x) for x in alike)


def _is_unit(text: str) -> bool:
    return text.lower() in SECONDS or value_unit(text)[0] != "raw"


def _names(dialect: Dialect, before: Sequence[str], width: int) -> tuple[str, ...]:
    """Return the names in the last line of words, if it has as many as the rows have fields."""
    line = next((x for x in reversed(before) if not is_blank(x)), "")
    text = line.lstrip().lstrip("#%/ ") if is_comment(line) else line
    quoted = tuple(n.strip() for n in next(csv.reader([text]))) if '"' in text else ()
    if len(quoted) == width > 1 and dialect.separator == "," and not any(map(_is_number, quoted)):
        return quoted  # as pandas writes names that are pairs: "(0, 1)"
    if not text or is_row(text) or FRAME_LINE.fullmatch(text) or is_time(text) or width < 2:
        return ()
    separator = dialect.separator
    if separator is None or separator not in text:
        separator = next((s for s in (";", "\t", "|", ",") if s in text), None)
    text = without_rules(text) if separator == "|" else text.strip("\r\n")
    names = tuple(n.strip() for n in text.split(separator))
    while len(names) > width and names[-1].lower() in ("", "comment"):  # as LabVIEW ends a header
        names = names[:-1]
    return names if len(names) == width else ()


def _is_numbered(first: Sequence[str]) -> bool:
    """Return whether a first row counts the columns, as tables without names are written."""
    texts = [t.strip().strip('"') for t in first]
    led = next((k for k, t in enumerate(texts) if t.isdecimal()), 0)
    rest = texts[led:]
    if led > 1 and not all(t.lower() in ROLES for t in texts[:led]):
        return False
    if len(rest) < 3 or not all(t.isdecimal() for t in rest):
        return False
    return is_count(np.array([float(t[:9]) for t in rest]))
