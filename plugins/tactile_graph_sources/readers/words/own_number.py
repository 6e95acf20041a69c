"""The numbers that a recording itself gives its frames, as whole numbers of 64 bits."""

from __future__ import annotations

import math

from tactile_graph_sources.readers.words.dialect import floats

EXACT = 2**53
"""Below this, a float tells every whole number from the next."""
NO_NUMBER = -(2**63)
"""Stands in an array for a frame without one."""


def counted(number: float | None) -> int | None:
    """Return a frame's own number; None where it is no whole one, or takes more than 64 bits."""
    whole = number is not None and abs(number) < 2**63 and number % 1 == 0
    return int(number) if number is not None and whole else None


def number_in(text: str) -> float:
    """Return a frame's number, exactly where it is a whole one; raises what `floats` raises."""
    number = floats([text])[0]
    if abs(number) < EXACT or math.isinf(number):
        return number
    try:
        return int(text)
    except ValueError:
        return number


def number_text(number: float) -> str:
    """Return a frame's number as files have it: a whole one with all its digits."""
    return str(int(number)) if number % 1 == 0 else f"{number:g}"
