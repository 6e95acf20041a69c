"""Dates and times of day written as one number: ``20240331235954``, ``235954``."""

from __future__ import annotations

import datetime
import re

import numpy as np
from numpy.typing import NDArray

Numbers = NDArray[np.float64]
STAMP = re.compile(
    r"((?:19[7-9]|20\d)\d)(\d\d)(\d\d)[T_ ]?(\d\d)(\d\d)(\d\d)(?:\.(\d{1,9})|(\d{3}|\d{6}))?Z?"
)
"""Year, month, day, hour, minute, second and what of one comes on top."""
HHMMSS = "%H%M%S"
EVEN = 3.0
"""How many times the usual step the largest one may be."""
LEAP_S, FEWEST = 30.0, 3
"""What numbers leap by at the end of a minute, at least: 40 less what a step is."""
_LOW, _HIGH = 1970, 2100
_DAY_0 = datetime.date(2000, 1, 1).toordinal()  # near enough for microseconds to be kept
_THOUSANDS = (1.0, 1e3)


def stamp_s(text: str) -> float | None:
    """Return a date and time of day written without marks, in seconds; None where it is none."""
    found = STAMP.fullmatch(text)
    if found is None:
        return None
    year, month, day, hour, minute, second = (int(found[k]) for k in range(1, 7))
    try:
        at = datetime.datetime(year, month, day, hour, minute, min(second, 59))
    except ValueError:
        return None
    if second > 60:
        return None
    days = at.toordinal() - _DAY_0
    part = found[7] or found[8]
    whole = days * 86400 + hour * 3600 + minute * 60 + second
    return whole + (float(f"0.{part}") if part else 0.0)


def stamps_s(times: Numbers) -> Numbers | None:
    """Return numbers such as 20240331235954 in seconds; None where one of them is no such stamp.

    In no unit are times of these centuries that large: as milliseconds they were of the year 2600.
    """
    if not len(times) or not np.isfinite(times).all():
        return None
    scale = next((s for s in _THOUSANDS if _LOW <= times[0] / s / 1e10 < _HIGH), 0.0)
    if not scale:
        return None
    at = [stamp_s(f"{t // scale:.0f}") for t in times]
    if None in at:
        return None
    return np.array(at, dtype=np.float64) + times % scale / scale


def are_hhmmss(times: Numbers) -> bool:
    """Return whether whole numbers are times of day such as 115959, of which the next is 120000.

    As seconds they leap by 40 where minutes end; as times of day their steps are much alike.
    """
    if len(times) < FEWEST or not (np.isfinite(times) & (times % 1 == 0) & (times >= 0)).all():
        return False
    hours, minutes, seconds = times // 10000, times // 100 % 100, times % 100
    if hours.max() >= 24 or max(minutes.max(), seconds.max()) >= 60:
        return False
    steps, read = np.diff(times), np.diff(hours * 3600 + minutes * 60 + seconds)
    usual = EVEN * max(float(np.median(steps)), 1.0)
    return bool(read.min() >= 0 and read.max() <= usual < LEAP_S < steps.max())
