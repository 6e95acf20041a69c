"""Lines between matrices that tell where one ends, and its number and time: ``t=0.05``."""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Sequence
from itertools import pairwise
from typing import NamedTuple

from tactile_graph_sources.readers.words.moments import clock_s
from tactile_graph_sources.readers.words.names import ROLES, SECONDS

FRAME_LINE = re.compile(
    r"\W*(?:frame|bild|image|trame|cuadro|scan|sample)\W*(\d{1,9})\b.{0,80}",
    re.IGNORECASE | re.DOTALL,
)
EVENLY = 0.8
"""Least share of the matrices that must be of one size for a line to be what parts them."""
LONGEST_SIGNATURE = 80
_NUMBER = re.compile(r"\d+(?:\.\d+)?")
_ONE_NUMBER = re.compile(r"\W*([-+]?\d+(?:\.\d+)?)\s*([^\W\d_]*)\W*")
_TIME_WORDS = "|".join(sorted((w for w, r in ROLES.items() if r == "time"), key=len, reverse=True))
_TIMED = re.compile(
    rf"(?<![^\W_])({_TIME_WORDS})(?:[\s_]+([^\W\d_]+)|\s*[\[(]([^\W\d_]+)[\])])?"
    r"(?:\s*[:=,;]+\s*|\s+(?=[-+\d]))"
    r"\"?([-+\dT:./ ]*\d)\s*([^\W\d_]*)",
    re.IGNORECASE,
)


class Stamp(NamedTuple):
    """Number and time of a matrix; a time's unit (s) is None where nobody says it.

    Times of day are in seconds, of which only differences mean anything.
    """

    frame: int | None = None
    time: float | None = None
    unit_s: float | None = None
    is_clock: bool = False


def opens_matrix(line: str) -> bool:
    """Return whether a row is the first of a matrix in brackets, as NumPy prints it."""
    return line.lstrip().startswith("[[")


def signature(line: str) -> str:
    """Return a line with its numbers left out: alike for lines that say the same of each frame."""
    return _NUMBER.sub("#", line.strip().lower()[:LONGEST_SIGNATURE])


def breaks_of(lines: Sequence[str], are_rows: Sequence[bool]) -> frozenset[str]:
    """Return the signatures of lines that stand after every so many rows.

    Parameters
    ----------
    lines : sequence of str
        From the first row on, none of them blank.
    are_rows : sequence of bool
        Which of them are rows of numbers.
    """
    found: dict[str, list[int]] = {}
    n_rows = 0
    for line, is_one in zip(lines, are_rows, strict=True):
        if is_one:
            n_rows += 1
        else:
            found.setdefault(signature(line), []).append(n_rows)
    return frozenset(s for s, at in found.items() if _are_even(at, n_rows))


def _are_even(at: Sequence[int], n_rows: int) -> bool:
    """Return whether breaks after so many rows leave matrices of one size between them.

    The first and the last may be cut off, where there are enough others.
    """
    sizes = [size for size in (b - a for a, b in pairwise([0, *at, n_rows])) if size]
    if len(sizes) < 2:
        return False
    usual, n = Counter(sizes).most_common(1)[0]
    return usual > 1 and max(sizes) == usual and n >= min(EVENLY * len(sizes), len(sizes) - 2) > 1


def is_time(line: str) -> bool:
    """Return whether a line says a time and nothing else: ``t = 0.05 s``, ``Time,0.05,,,``."""
    timed = _TIMED.search(line)
    return timed is not None and not re.search(r"\w", line[: timed.start()] + line[timed.end() :])


def stamp_of(line: str) -> Stamp:
    """Return the number and the time that a line between matrices says, its decimals by points."""
    label = FRAME_LINE.fullmatch(line)
    frame = int(label[1]) if label else None
    at = clock_s(line.strip(" \t#,;|"))
    if at is not None:
        return Stamp(frame, at, 1.0, is_clock=True)
    alone = _ONE_NUMBER.fullmatch(line)
    if alone and (not alone[2] or alone[2].lower() in SECONDS):
        return Stamp(frame, float(alone[1]), SECONDS.get(alone[2].lower()))
    timed = _TIMED.search(line)
    if timed is None:
        return Stamp(frame)
    text = timed[4].strip()
    clock = clock_s(text)
    if clock is not None:
        return Stamp(frame, clock, 1.0, is_clock=True)
    if not re.fullmatch(r"[-+]?\d+(?:\.\d+)?", text):
        return Stamp(frame)
    units = (timed[2] or timed[3] or "", timed[5], timed[1])
    unit_s = next((SECONDS[u.lower()] for u in units if u.lower() in SECONDS), None)
    return Stamp(frame, float(text), unit_s)
