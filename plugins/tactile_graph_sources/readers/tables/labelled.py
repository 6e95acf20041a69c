"""Lines in which names stand before the numbers: ``x: 0, y: 1, p: 23``, ``Row 3: 1 2 3``."""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass

from tactile_graph_sources.readers.words.dialect import is_numeric
from tactile_graph_sources.readers.words.names import ROLES

MOST = 0.6
"""Least share of the lines that must be written so."""
LOOKED_AT = 200
FEWEST_NUMBERS = 3
_ROW = re.compile(r"\s*\"?([^\W\d_]+)[ _]?(\d{1,6})\"?\s*[;,|\t]\s*(?=[-+.]?\d)")
"""A field in front that names a row, as spreadsheets write it: ``Zeile 1;0,5;0,7``."""
_NAME = re.compile(r"([^\W\d_][\w .()\[\]/%-]{0,40}?)\s*[:=]\s*(?=[-+.]?\d)")


@dataclass(frozen=True)
class Labels:
    """How lines are written that hold names beside their numbers.

    Parameters
    ----------
    names : tuple of str
        The names of a line's values, alike in all lines; empty where a line has one name.
    first : str
        What the first row of each matrix is called, where a line's name is that of its row.
    """

    names: tuple[str, ...] = ()
    first: str = ""

    def plain(self, line: str) -> str:
        """Return a line without names; one that is written otherwise as it is.

        The rows of a matrix come out in brackets, as NumPy prints them.
        """
        line = _with_row_named(line)
        names = tuple(_NAME.findall(line))
        if not names or not _NAME.match(line.lstrip()):
            return line
        if self.names:
            return _NAME.sub("", line) if names == self.names else line
        rest = _NAME.sub("", line)
        if len(names) > 1 or not _is_row(rest):
            return line
        if not self.first:
            return rest
        return f"[[{rest}]" if names[0] == self.first else f"[{rest}]"


def labels_of(lines: Sequence[str]) -> Labels | None:
    """Return how lines are written in which names stand before the numbers; None otherwise."""
    sample = [line for line in lines[: 4 * LOOKED_AT] if any(c.isalnum() for c in line)][:LOOKED_AT]
    sample = [_with_row_named(line) for line in sample]
    middle = sample[len(sample) // 2 :][:3]  # one of them may be what stands between matrices
    if not any(_NAME.match(line.lstrip()) for line in middle):
        return None
    found = [_names(line) for line in sample]
    pairs = Counter(names for names in found if len(names) > 1).most_common(1)
    if pairs and pairs[0][1] >= MOST * len(sample):
        return Labels(pairs[0][0])
    alone = [names[0] for names in found if len(names) == 1]
    if len(alone) < MOST * len(sample):
        return None
    return Labels(first=alone[0] if len(set(alone)) > 1 else "")


def _with_row_named(line: str) -> str:
    """Return a line whose first field names its row as ``Row 3: 1 2 3`` does."""
    found = _ROW.match(line)
    if found is None or ROLES.get(found[1].lower()) != "row":
        return line
    return f"{found[1]} {found[2]}: {line[found.end() :]}"


def _names(line: str) -> tuple[str, ...]:
    """Return the names in a line of numbers; none where it is another kind of line."""
    names = tuple(_NAME.findall(line))
    if not names or not _NAME.match(line.lstrip()):
        return ()
    rest = _NAME.sub("", line)
    if len(names) == 1:
        return names if _is_row(rest) else ()
    return names if is_numeric(rest) and len(_words(rest)) == len(names) else ()


def _is_row(rest: str) -> bool:
    return is_numeric(rest) and len(_words(rest)) >= FEWEST_NUMBERS


def _words(text: str) -> list[str]:
    return [w for w in re.split(r"[\s,;|]+", text) if w]
