"""How the numbers lie in a plain table: one frame a line, stacked matrices, or one cell a line.

A table seldom says what it is. The rules, in order:

1. a header that names frame (or time), row, column and value: one cell a line;
2. rows and columns told: a line of rows x columns values is a frame, one of columns a row;
3. groups of equal lines between blank lines (or lines such as ``Frame 3``): stacked matrices;
4. as many lines as columns: one square matrix;
5. a square number of values a line (with a time or number before them or not): a frame a line;
6. up to 63 columns and up to 256 lines: one matrix;
7. anything else is asked for, never guessed.
"""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass, field
from itertools import pairwise
from math import isqrt

from tactile_graph_sources.readers.dialect import Dialect, is_numeric
from tactile_graph_sources.readers.told import Told

LONG_NAMES = {
    "frame": ("frame", "frame_index", "index", "frame_no", "n"),
    "time": ("time_s", "time", "t", "t_s", "timestamp", "seconds", "time_ms", "t_ms", "time_us"),
    "row": ("row", "r", "y", "i"),
    "column": ("column", "col", "c", "x", "j"),
    "value": ("value", "v", "val", "pressure", "reading", "force", "counts", "raw"),
}
FRAME_LINE = re.compile(r"\W*frame\W*(\d{1,9})\b.{0,80}", re.IGNORECASE | re.DOTALL)
_BLANK = re.compile(r"[\s,;]*")
ENDLESS = 1 << 30  # as a run of blank lines: none ends a matrix, only its last row does
SMALLEST_SURE_SQUARE = 64
MOST_COLUMNS_UNTOLD, MOST_LINES_UNTOLD = 63, 256


@dataclass(frozen=True)
class Layout:
    """What a table is; ``trouble`` says why it cannot be told."""

    kind: str
    dialect: Dialect = field(default_factory=Dialect)
    width: int = 0
    rows: int = 0
    blank_run: int = 1
    header: bool = False
    columns: dict[str, int] = field(default_factory=dict)
    time_factor: float = 1.0
    trouble: str = ""


def is_blank(line: str) -> bool:
    """Return whether a line holds nothing but separators."""
    return _BLANK.fullmatch(line) is not None


def is_comment(line: str) -> bool:
    """Return whether a line is a comment."""
    return line.lstrip().startswith(("#", "%", "//"))


def name_columns(header: str) -> tuple[dict[str, int], float]:
    """Return which column is what by a header line, and the factor from its time to seconds.

    A row of numbers names none.
    """
    separator = next((s for s in (";", "\t", ",") if s in header), None)
    names = [n.strip().strip('"').lower() for n in header.split(separator)]
    columns: dict[str, int] = {}
    factor = 1.0
    for place, name in enumerate(names):
        for what, spelled in LONG_NAMES.items():
            if name in spelled and what not in columns:
                columns[what] = place
                if what == "time":
                    factor = {"_ms": 1e-3, "_us": 1e-6}.get(name[-3:], 1.0)
                break
    return columns, factor


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
    content = [line for line in lines if not is_blank(line) and not is_comment(line)]
    named, factor = name_columns(content[0]) if content else ({}, 1.0)
    if {"row", "column", "value"} <= named.keys():
        return _long(content[1:1000], named, factor)
    numeric = [line for line in content if is_numeric(line)]
    if not numeric or 2 * len(numeric) < len(content):
        return None
    dialect = Dialect.of(numeric[:200])
    header = bool(named) or _is_header(dialect, content[0], numeric)
    width = _width(dialect, numeric)
    lead = {k: v for k, v in named.items() if k in ("frame", "time") and v < 2}
    groups, run = _groups(lines, dialect)
    if width == 0:
        return None
    kind, rows = _decide(width, groups, told, bool(lead), whole)
    if kind != "flat":
        run = run if len(groups) > 1 else ENDLESS
        trouble = _question(kind, width, groups)
        return Layout(kind, dialect, width, rows, run, header, trouble=trouble)
    if not lead:
        lead = _lead(dialect, numeric, width, told)
    return Layout("flat", dialect, width, header=header, columns=lead, time_factor=factor)


def _long(content: Sequence[str], named: dict[str, int], time_factor: float) -> Layout | None:
    numeric = [line for line in content if is_numeric(line)]
    if not numeric:
        return None
    dialect = Dialect.of(numeric[:200])
    least = 1 + max(named.values())  # a header of more names than there are numbers is damage
    width = max(_width(dialect, numeric), least)
    return Layout("long", dialect, width, columns=named, time_factor=time_factor)


def _is_header(dialect: Dialect, line: str, numeric: Sequence[str]) -> bool:
    """Return whether a first line that is no row of numbers has as many names as a row numbers."""
    if is_numeric(line) or FRAME_LINE.fullmatch(line):
        return False
    return (
        abs(len(line.split(dialect.separator)) - len(dialect.fields(numeric[-1])))
        <= 1
        < len(dialect.fields(numeric[-1]))
    )


def _question(kind: str, width: int, groups: Sequence[int]) -> str:
    """Return the question to ask where the layout cannot be told, else an empty text."""
    if kind != "unclear":
        return ""
    return (
        f"{sum(groups)} lines of {width} values could be one matrix or a frame a line; "
        "give the settings rows and columns"
    )


def _width(dialect: Dialect, numeric: Sequence[str]) -> int:
    """Return the usual number of values of a line, without separators that all lines end with."""
    fields = [dialect.fields(line) for line in numeric[:2000]]
    usual = Counter(len(f) for f in fields).most_common(1)[0][0]
    fields = [f for f in fields if len(f) == usual]
    extra = 0
    while extra < usual and not any(f[usual - 1 - extra].strip() for f in fields):
        extra += 1
    return usual - extra


def _groups(lines: Sequence[str], dialect: Dialect) -> tuple[list[int], int]:
    """Return the sizes of groups of lines and the number of blank lines that ends a group.

    Where a blank line stands after every row, only two of them end a matrix.
    """
    for run in (1, 2):
        groups, size, blanks = [], 0, 0
        for line in lines:
            if is_blank(line):
                blanks += 1
                continue
            if blanks >= run or FRAME_LINE.fullmatch(line):
                groups.append(size)
                size = 0
            blanks = 0
            size += is_numeric(line)
        groups = [g for g in [*groups, size] if g]
        if not groups or Counter(groups).most_common(1)[0][0] > 1:
            return groups, run
    return [sum(groups)], ENDLESS


def _decide(
    width: int, groups: Sequence[int], told: Told, named: bool, whole: bool
) -> tuple[str, int]:
    """Return the kind of table and, where it is stacked, the rows of a matrix."""
    usual = Counter(groups).most_common(1)[0][0] if groups else 0
    if told.columns is not None:
        if width != told.columns or told.rows == 1:
            return "flat", 0
        clear = told.rows or len(groups) > 1 or whole
        return ("stacked", told.rows or usual) if clear else ("unclear", 0)
    if told.rows is not None:
        if usual == told.rows > 1:
            return "stacked", usual
        if width % told.rows == 0 or len(groups) < 2:
            return "flat", 0
    if len(groups) > 1 and usual > 1:
        return "stacked", usual
    n = sum(groups)
    if named:
        return "flat", 0
    if n == width:
        return "stacked", n
    square = _is_square(width)
    if square and (width >= SMALLEST_SURE_SQUARE or n % width):
        return "flat", 0
    if _is_square(width - 1) and width > SMALLEST_SURE_SQUARE:
        return "flat", 0
    if not square and width <= MOST_COLUMNS_UNTOLD and n <= MOST_LINES_UNTOLD and whole:
        return "stacked", n
    return "unclear", 0


def _is_square(n: int) -> bool:
    return n > 1 and isqrt(n) ** 2 == n


def _lead(dialect: Dialect, numeric: Sequence[str], width: int, told: Told) -> dict[str, int]:
    """Return what stands before the cells where no header says it: nothing, a number or a time."""
    cells = (told.rows or 0) * (told.columns or 0)
    one_more = width == cells + 1 if cells else _is_square(width - 1) and not _is_square(width)
    if not one_more:
        return {}
    try:
        first = [float(dialect.fields(line)[0]) for line in numeric[:50]]
    except ValueError:
        return {"time": 0}
    steps = [b - a for a, b in pairwise(first)]
    return {"frame": 0} if steps and Counter(steps).most_common(1)[0][0] == 1.0 else {"time": 0}
