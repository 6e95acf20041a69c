"""What lines of a table may mean besides what they seem to: asked, never guessed."""

from __future__ import annotations

import re
from collections.abc import Sequence
from itertools import zip_longest

from tactile_graph_sources.readers.tables.table import OWN, is_comment
from tactile_graph_sources.readers.words.dialect import Dialect, is_row, unquoted
from tactile_graph_sources.readers.words.moments import clock_s

_LOOKED_AT = 400
_FEWEST_PAIRS, _FEWEST_LINES = 3, 2
_PARTED = re.compile(r"\s*Columns?\s+\d+\s+(?:through|to|and)\s+\d+\W*", re.IGNORECASE)
_BRACKETED = re.compile(r"\(\s*\d[\d.,]*\s*\)")
_WHOLE = re.compile(r"[-+]?\d+")
_FEW_DIGITS = re.compile(r"\d{1,3}")
_SET_APART = re.compile(r"[-+]?[1-9]\d{0,2}[.,]\d{3}")
_SMALL = re.compile(r"[-+]?\d{1,3}")
_SHORTENED = re.compile(r"(?:^|[\s,\[])\.\.\.(?:[\s,\]]|$)")

_PRINTS = {
    ", , ": "R printed its matrices; write a line a frame: write.csv(t(apply(x, 3, t)), 'out.csv', "
    "row.names = FALSE)",
    "{{": "its lists are Mathematica's; write [ ] for { }, then it is JSON",
    "# Created by Octave": "it is Octave's text, cells column by column; save it anew: save('-v7', "
    "'out.mat')",
}
"""By what a line begins with."""


def doubt_about(lines: Sequence[str], dialect: Dialect) -> str:
    """Return what to ask of a table's lines; empty where they mean but one thing.

    Parameters
    ----------
    lines : sequence of str
        The first ones of the file.
    dialect : Dialect
        How its rows are taken apart.
    """
    first = lines[:_LOOKED_AT]
    return (
        next((told for line in first if (told := _of_line(line, dialect))), "")
        or _of_commas(rows := [line for line in first if is_row(line)], dialect)
        or _of_places([x for x in first if x.strip() and not is_comment(x)][:2], dialect)
        or ("" if any(map(OWN.match, first)) else _of_thousands(rows, dialect))
    )  # fmt: skip


def _of_line(line: str, dialect: Dialect) -> str:
    if _PARTED.fullmatch(line):
        return (
            f"{line.strip()!r}: its matrices were printed in parts, side by side; write them as a "
            "table instead, in MATLAB: writematrix(x, 'out.csv')"
        )
    if _SHORTENED.search(line) and any(c.isdigit() or c in "[]." for c in line):
        return (
            "'...' stands where numbers were left out when it was printed; write them all, in "
            "Python: numpy.save('out.npy', frames)"
        )
    for opening, told in _PRINTS.items():
        if line.lstrip().startswith(opening):
            return told
    if line.lstrip().startswith("[") and "]" not in line and is_row(line):
        return (
            "its rows go on over several lines; write each on one, in Python: "
            "numpy.save('out.npy', frames)"
        )
    if not is_row(line):
        return ""
    fields = [f.strip() for f in line.split(dialect.separator)]
    n_bracketed = sum(1 for f in fields if _BRACKETED.fullmatch(f))
    if 0 < n_bracketed < len(fields) and len(fields) > 2:
        one = next(f for f in fields if _BRACKETED.fullmatch(f))
        return (
            f"{one!r} stands in brackets and others do not: in spreadsheets that is a number below "
            f"0; write it as -{one.strip('() ')} (as format choose number, not accounting)"
        )
    return ""


def _of_commas(rows: Sequence[str], dialect: Dialect) -> str:
    """Return the question whether every second comma is a decimal one."""
    if dialect.separator != "," or dialect.decimal_comma or dialect.thousands:
        return ""
    if any("." in row or '"' in row for row in rows):
        return ""
    fields = [[f.strip() for f in row.split(",")] for row in rows]
    width = max((len(f) for f in fields), default=0)
    full = [f for f in fields if len(f) == width]
    if len(full) < max(_FEWEST_LINES, len(fields) // 2) or width < 2 * _FEWEST_PAIRS or width % 2:
        return ""
    columns = list(zip(*full, strict=True))
    if not all(_WHOLE.fullmatch(text) for column in columns for text in column):
        return ""
    behind = [text for column in columns[1::2] for text in column]
    before = [text for column in columns[::2] for text in column]
    digits = {len(text) for text in behind}
    alike = len(digits) == 1 and all(_FEW_DIGITS.fullmatch(text) for text in behind)
    if not alike or len({len(text) for text in before}) == 1:
        return ""
    one = f"{full[0][0]},{full[0][1]}"
    return (
        f"{width} numbers a line with commas between them, every second one of {digits.pop()} "
        f"digits: {width // 2} numbers such as {one} with a decimal comma? Write decimal points, "
        "or semicolons between the numbers"
    )


def _of_thousands(rows: Sequence[str], dialect: Dialect) -> str:
    """Return the question whether 1.200 is 1200, where numbers below 1000 are whole ones."""
    if dialect.thousands or not any("." in row or "," in row for row in rows):
        return ""
    fields = [[unquoted(f) for f in row.split(dialect.separator)] for row in rows]
    columns = zip_longest(*fields, fillvalue="0")
    found = [
        c for c in columns if any(map(_SET_APART.fullmatch, c)) and any(map(_SMALL.fullmatch, c))
    ]
    doubtful = [c for c in found if all(_SET_APART.fullmatch(f) or _SMALL.fullmatch(f) for f in c)]
    if len(doubtful) < _FEWEST_PAIRS or len(doubtful) < len(found):
        return ""
    one = next(filter(_SET_APART.fullmatch, doubtful[0]))
    decimals = re.compile(rf"[-+]?\d+[{'.' if '.' in one else ','}](?!\d{{3}}$)\d+")
    if any(decimals.fullmatch(field) for line in fields for field in line):
        return ""  # the same mark stands before what are surely decimals
    return (
        f"{one!r} may be {one.replace(',', '.')} or {re.sub('[.,]', '', one)}, as numbers below "
        "1000 are whole ones; write numbers without marks between thousands"
    )


def _of_places(rows: Sequence[str], dialect: Dialect) -> str:
    """Return what to do where two lines in front say row and column of each cell."""
    if len(rows) < 2 or dialect.separator is None or not all(map(is_row, rows)):
        return ""
    names, numbers = zip(*((f[0], f[1:]) for f in map(dialect.fields, rows)), strict=True)
    if any(_WHOLE.fullmatch(n.strip()) or "." in n or clock_s(n) is not None for n in names):
        return ""
    if names[0].strip() and len(set(names)) == 1:
        return ""  # what both lines begin with names neither of them
    if not all(text.strip().isdecimal() for line in numbers for text in line):
        return ""
    above, below = ([int(t) for t in line] for line in numbers)
    places = list(zip(above, below, strict=False))
    if len(places) < _FEWEST_PAIRS or len(set(places)) < len(places) or sorted(places) != places:
        return ""
    return (
        "its first two lines say row and column of each cell, as those of pandas do; name the "
        "cells on one line: frame.columns = [f'r{r}c{c}' for r, c in frame.columns]"
    )
