"""How a text file writes numbers: what stands between them and what marks the decimals."""

from __future__ import annotations

import csv
import math
import re
from collections.abc import Sequence
from typing import NamedTuple

from tactile_graph_sources.readers.words.moments import CLOCK_IN_LINE

ERRORS = ("#n/a", "#nv", "#div/0!", "#value!", "#wert!", "#valeur!", "#num!", "#zahl!", "#ref!",
          "#bezug!", "#name?", "#null!")  # fmt: skip
"""What spreadsheets write into cells of which a formula gives no value."""
MISSING = frozenset({"", "b", "nan", "na", "n/a", "n.a.", "null", "none", "<na>", "-", "--", "."})
MISSING |= {*ERRORS, "1.#qnan", "-1.#qnan", "1.#ind", "-1.#ind", "1.#inf", "-1.#inf"}
"""What files write for a cell without a value, in lower case."""
_NUMERIC = re.compile(r"[-+.\d,;\s\"'’eEnaNIifB]+")
_DIGIT = re.compile(r"\d")
_QUOTED_COMMA = re.compile(r'(?:^|,)\s*"[^",]*,[^"]*"\s*(?:,|$)')
_WORDY = re.compile(r"[naNIifB]\d|(?<![\d.])[eE][-+]?\d")
_BRACKETS = str.maketrans("", "", "[](){}")
_WORD = re.compile(r"[^\s,;|]+")
_NUMBER = re.compile(r"[-+]?(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?")
_ARROW = re.compile(r"\s*->|\s>\s")
"""What serial monitors put behind the time of a line."""
_DECIMAL_COMMA = re.compile(r"[-+]?\d+(,\d+)?")
_COMMA_WITHIN = re.compile(r"(?<=\d),(?=\d+(?!\d|:|\.\d))")
"""One of decimals, not the one before a time of day or a number with decimals of its own."""
_GROUPED = {
    ".": re.compile(r"[-+]?[1-9]\d{0,2}(?:\.\d{3})+(?:,\d+)?"),
    ",": re.compile(r"[-+]?[1-9]\d{0,2}(?:,\d{3})+(?:\.\d+)?"),
    **{
        mark: re.compile(rf"[-+]?[1-9]\d{{0,2}}(?:{mark}\d{{3}})+(?:[.,]\d+)?")
        for mark in ("'", "’", "\u00a0", "\u202f", "\u2009")
    },
}
"""Numbers whose thousands are set apart, by what sets them apart."""
_SURELY_GROUPED = {
    ".": re.compile(r"[-+]?\d{1,3}(?:(?:\.\d{3})+,\d+|(?:\.\d{3}){2,})"),
    ",": re.compile(r"[-+]?\d{1,3}(?:(?:,\d{3})+\.\d+|(?:,\d{3}){2,})"),
}
"""The same where the mark can be no decimal one; apostrophes and narrow blanks never are."""
_SURELY_DECIMAL = re.compile(r"[-+]?(?:0\d*|\d+),(?:\d{1,2}|\d{4,})")
FEWEST_GROUPED = 5


def without_rules(line: str) -> str:
    """Return a line of a table without the bars at its ends."""
    return line.strip().removeprefix("|").removesuffix("|")


def unquoted(text: str) -> str:
    """Return a field without quotes and blanks around it."""
    return text.strip().strip("\"'").strip()


def is_numeric(line: str) -> bool:
    """Return whether a line could be a row of numbers."""
    return (
        _NUMERIC.fullmatch(line) is not None
        and _DIGIT.search(line) is not None
        and (line.lower() == line.upper() or _WORDY.search(line) is None)
    )


def is_row(line: str) -> bool:
    """Return whether a line is a row of numbers, be a date, label or bracket among them or not."""
    if is_numeric(line):
        return True
    words = _WORD.findall(CLOCK_IN_LINE.sub("", line).translate(_BRACKETS).replace('"', ""))
    n = sum(1 for w in words if _NUMBER.fullmatch(w))
    return n >= 3 and 5 * n >= 3 * len(words)


class Dialect(NamedTuple):
    """How a line is taken apart.

    ``separator`` None is any white space. ``brackets`` are left out. ``arrow`` parts the time
    that a serial monitor puts before each line from the line itself. ``thousands`` is what stands
    between the thousands of a number, where anything does.
    """

    separator: str | None = ","
    decimal_comma: bool = False
    brackets: bool = False
    arrow: bool = False
    thousands: str = ""

    @classmethod
    def of(cls, lines: Sequence[str]) -> Dialect:
        """Return the dialect of some numeric lines."""
        half = len(lines) / 2
        arrow = sum(_ARROW.search(line) is not None for line in lines) > half
        brackets = sum("[" in line or "(" in line for line in lines) > half
        if arrow or brackets:
            plain = [_ARROW.split(line)[-1].translate(_BRACKETS) for line in lines]
            return cls.of(plain)._replace(brackets=brackets, arrow=arrow)
        for separator in (";", "\t", "|"):
            if 2 * sum(separator in line for line in lines) > len(lines):
                rest = separator.join(lines)
                mark = _thousands(rest.split(separator))
                return cls(separator, "," in rest if mark != "," else False, thousands=mark)
        if 2 * sum("," in line for line in lines) <= len(lines):
            return cls(None)
        words = [line.split() for line in lines]
        spaced = all(len(w) > 1 and all(map(_DECIMAL_COMMA.fullmatch, w)) for w in words)
        if spaced:
            return cls(None, True)
        quoted = _quoted(lines)
        grouped = len(quoted) >= FEWEST_GROUPED and all(map(_GROUPED[","].fullmatch, quoted))
        decimal = not grouped and any(_SURELY_DECIMAL.fullmatch(f) for f in quoted)
        return cls(",", decimal, thousands="," if grouped else "")

    def fields(self, line: str) -> list[str]:
        """Return the texts between the separators."""
        if self.arrow and (found := _ARROW.search(line)):
            stamp, rest = line[: found.start()], line[found.end() :]
            return [stamp.strip(), *self._replace(arrow=False).fields(rest)]
        if self.brackets:
            line = line.translate(_BRACKETS)
        if self.separator == "|":
            line = without_rules(line)
        quoted = '"' in line  # in plain lines no pattern is sought: it takes a third of the time
        if quoted and self.separator == "," and _QUOTED_COMMA.search(line) is not None:
            # Of thousands, or decimal? Kept together it is told as no number, never as two.
            fields = next(csv.reader([line]))
            if self.decimal_comma:
                return [f.replace(",", ".") for f in fields]
            return [_ungrouped(f, ",") for f in fields] if self.thousands == "," else fields
        if quoted:
            line = line.replace('"', "")
        if self.thousands and self.separator != ",":
            fields = [_ungrouped(f, self.thousands) for f in line.split(self.separator)]
            return fields if self.thousands == "," else [f.replace(",", ".") for f in fields]
        if self.decimal_comma and self.separator != ",":
            line = line.replace(",", ".")
        return line.split(self.separator)

    def pointed(self, line: str) -> str:
        """Return a line that stands between rows with a point before the decimals of its numbers.

        A comma is a decimal one where it parts no fields and no thousands.
        """
        if "," not in line or self.thousands == ",":
            return line
        commas = self.decimal_comma or self.separator != ","
        return _COMMA_WITHIN.sub(".", line) if commas else line

    def row(self, line: str, width: int) -> list[float]:
        """Return the ``width`` numbers of a line; NaN for missing cells.

        Raises
        ------
        ValueError
            If there are fewer or more of them, or one is no number.
        """
        refuse_underscore(line)
        return floats(self.texts(line, width))

    def texts(self, line: str, width: int) -> list[str]:
        """Return the ``width`` texts of a line.

        Raises
        ------
        ValueError
            If there are fewer or more of them.
        """
        fields = self.fields(line)
        if len(fields) != width:
            extra = fields[width:]
            if len(fields) < width or any(e.strip() for e in extra):
                n = sum(1 for f in fields if f.strip()) if extra else len(fields)
                raise ValueError(f"{n} values, not {width}")
            del fields[width:]
        return fields


def _thousands(fields: Sequence[str]) -> str:
    """Return what surely stands between the thousands of some numbers; empty where nothing does."""
    marks = [mark for mark in _GROUPED if any(mark in f.strip() for f in fields)]
    plain = [unquoted(f) for f in fields] if marks else []
    return next(
        (m for m in marks if any(map(_SURELY_GROUPED.get(m, _GROUPED[m]).fullmatch, plain))), ""
    )


def _quoted(lines: Sequence[str]) -> list[str]:
    """Return the fields with a comma in them, which stand within quotes."""
    quoted = [line for line in lines if _QUOTED_COMMA.search(line) is not None]
    return [f.strip() for line in quoted for f in next(csv.reader([line])) if "," in f]


def _ungrouped(field: str, mark: str) -> str:
    """Return a field without what stands between its thousands."""
    return field.replace(mark, "") if _GROUPED[mark].fullmatch(field.strip()) else field


def refuse_underscore(line: str) -> None:
    """Refuse a line with ``_``: Python reads 1_0 as 10, no device writes that.

    Raises
    ------
    ValueError
        If there is one.
    """
    if "_" in line:
        raise ValueError("'_' is no part of a number")


def floats(fields: Sequence[str]) -> list[float]:
    """Return texts as numbers; NaN for the ways in which files say "no cell here".

    Raises
    ------
    ValueError
        If a text is no number.
    """
    try:
        return list(map(float, fields))
    except ValueError:
        return [math.nan if f.strip().lower() in MISSING else _float(f) for f in fields]


def _float(text: str) -> float:
    try:
        return float(text)
    except ValueError:
        raise ValueError(
            f"{text.strip()[:40]!r} is no number; a cell without a value is left empty, or NaN"
        ) from None
