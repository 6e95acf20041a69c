"""How a text file writes numbers: what stands between them and what marks the decimals."""

from __future__ import annotations

import csv
import math
import re
from collections.abc import Sequence
from typing import NamedTuple

MISSING = frozenset({"", "b", "nan", "na", "n/a", "null"})
_NUMERIC = re.compile(r"[-+.\d,;\s\"eEnaNIifB]+")
_DIGIT = re.compile(r"\d")
_QUOTED_COMMA = re.compile(r'(?:^|,)\s*"[^",]*,[^"]*"\s*(?:,|$)')
_DECIMAL_COMMA = re.compile(r"[-+]?\d+(,\d+)?")


def is_numeric(line: str) -> bool:
    """Return whether a line could be a row of numbers."""
    return _NUMERIC.fullmatch(line) is not None and _DIGIT.search(line) is not None


class Dialect(NamedTuple):
    """Separator (None: any white space) and whether a comma marks the decimals."""

    separator: str | None = ","
    decimal_comma: bool = False

    @classmethod
    def of(cls, lines: Sequence[str]) -> Dialect:
        """Return the dialect of some numeric lines."""
        for separator in (";", "\t"):
            if 2 * sum(separator in line for line in lines) > len(lines):
                rest = "".join(lines)
                return cls(separator, "," in rest)
        if 2 * sum("," in line for line in lines) <= len(lines):
            return cls(None)
        words = [line.split() for line in lines]
        spaced = all(len(w) > 1 and all(map(_DECIMAL_COMMA.fullmatch, w)) for w in words)
        return cls(None, True) if spaced else cls(",")

    def fields(self, line: str) -> list[str]:
        """Return the texts between the separators."""
        if _QUOTED_COMMA.search(line) is not None and self.separator == ",":
            # Of thousands, or decimal? Kept together it is told as no number, never as two.
            return next(csv.reader([line]))
        if '"' in line:
            line = line.replace('"', "")
        if self.decimal_comma:
            line = line.replace(",", ".")
        return line.split(self.separator)

    def row(self, line: str, width: int) -> list[float]:
        """Return the ``width`` numbers of a line; NaN for missing cells.

        Raises
        ------
        ValueError
            If there are fewer or more of them, or one is no number.
        """
        refuse_underscore(line)
        fields = self.fields(line)
        if len(fields) != width:
            extra = fields[width:]
            if len(fields) < width or any(e.strip() for e in extra):
                n = sum(1 for f in fields if f.strip()) if extra else len(fields)
                raise ValueError(f"{n} values, not {width}")
            del fields[width:]
        return floats(fields)


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
        raise ValueError(f"{text.strip()[:40]!r} is no number") from None
