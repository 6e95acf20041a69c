"""What texts say of a time: dates and times of day, their UTC offsets, durations."""

from __future__ import annotations

import datetime
import re
from collections.abc import Iterable
from typing import NamedTuple

from tactile_graph_sources.readers.words.compact import HHMMSS, stamp_s

HOUR_S, DAY_S = 3600.0, 86400.0
_CLOCK = re.compile(
    r"(?:(\d{4})-(\d\d)-(\d\d)[T ]+|(\d\d?)[./](\d\d?)[./](\d{4})[, ]+)?"
    r"(\d{1,2}):(\d\d):(\d\d)(?:([.,:])(\d{1,9}))?(?:\s?([AP])\.?M\.?)?"
    r"(?:\s?(Z|UTC|GMT))?(?:\s?([+-])(\d\d?):?(\d\d)?)?",
    re.IGNORECASE,
)
CLOCK_IN_LINE = re.compile(
    _CLOCK.pattern.replace("[.,:]", "[.:]").replace(r"\s?([+-])(\d\d?)", r"([+-])(\d\d)"),
    re.IGNORECASE,
)
"""A time within a line, where what stands behind a comma or a blank may be another field."""
_DATE = re.compile(r"\d{4}[-/.]\d\d?[-/.]\d\d?|\d\d?[-/.]\d\d?[-/.](?:\d{4}|\d\d)")
_ELAPSED = re.compile(
    r"(?:(\d{1,2}):)?(\d{1,2}\.\d{1,9})|([-+]?\d+(?:\.\d+)?)\s*(s|secs?|ms|us|µs)"
)
"""Minutes and seconds, as spreadsheets show times of day, or seconds with their unit."""
_DURATION = re.compile(
    r"([-+]?\d{1,6}) days?,? \+?(\d{1,2}):(\d\d):(\d\d(?:\.\d{1,9})?)"
    r"|P(?=.*\d)(?:(\d{1,6})D)?(?:T(?:(\d{1,6})H)?(?:(\d{1,6})M)?(?:(\d{1,9}(?:\.\d{1,9})?)S)?)?"
)
"""Days, hours, minutes and seconds: how long something took, as pandas, Python and ISO write it."""
_UNIT_S = {"s": 1.0, "sec": 1.0, "secs": 1.0, "ms": 1e-3, "us": 1e-6, "µs": 1e-6}
_DAY_0 = datetime.date(2000, 1, 1).toordinal()  # near enough for microseconds to be kept
_OFFSETS_H = 15
"""No zone is as far from UTC."""
_ZONED = re.compile(r"(.*\d:\d\d:\d\d\S*)\s*\(?([A-Za-z][A-Za-z/_]{1,30})\)?")
_HOURS = re.compile("%[HIcXT]")
_LAST_COLON = re.compile(r"\d:\d\d:\d\d:\d")
"""What a time holds that has something behind a last colon."""


class Moment(NamedTuple):
    """When, by the clock that a text is written by; ``zone_s`` is that clock's offset from UTC.

    ``cycle_s`` is after how long it begins anew, 0 for never. ``colon_digits`` are how many stand
    behind a last colon, and ``leaps`` whether it is within a leap second.
    """

    at_s: float
    zone_s: float | None = None
    cycle_s: float = 0.0
    colon_digits: int = 0
    leaps: bool = False


def is_date(text: str) -> bool:
    """Return whether a text is a date without a time of day."""
    return _DATE.fullmatch(text.strip().strip('"')) is not None


def clock_s(text: str) -> float | None:
    """Return a date and time of day, one alone, or a duration, in seconds; None where it is none.

    Only differences mean anything.
    """
    found = moment_of(text)
    return None if found is None else found.at_s - (found.zone_s or 0.0)


def moment_of(text: str, given: str = "", colon_s: float = 0.0) -> Moment | None:
    """Return what a text says of a time; None where it is none.

    Parameters
    ----------
    text : str
    given : str
        How it is written, as `strptime` takes it; empty if that is to be seen.
    colon_s : float
        Unit of what stands behind a last colon; 0 for decimals of the seconds.
    """
    text = text.strip().strip('"')
    if given:
        return _by_format(text, given)
    found = _CLOCK.fullmatch(text)
    if found is None:
        return _elapsed(text)
    year, month, day, day2, month2, year2, *time, utc, sign, zone_h, zone_min = found.groups()
    hour, minute, second, mark, part, half = time
    days = 0
    if year or year2:
        if half or (month2 and int(month2) > 12):  # as Americans write dates
            day2, month2 = month2, day2
        try:
            date = datetime.date(int(year or year2), int(month or month2), int(day or day2))
        except ValueError:
            return None
        days = date.toordinal() - _DAY_0
    zone_s = 0.0 if utc else None
    if sign:
        if int(zone_h) >= _OFFSETS_H:
            return None
        zone_s = float(f"{sign}1") * (int(zone_h) * 3600 + int(zone_min or 0) * 60)
    hours = int(hour) % 12 + 12 * (half.lower() == "p") if half else int(hour)
    whole = days * 86400 + hours * 3600 + int(minute) * 60 + int(second)
    digits = len(part) if mark == ":" else 0
    at_s = whole + (int(part) * colon_s if digits and colon_s else float(f"0.{part or 0}"))
    return Moment(at_s, zone_s, 0.0 if days else DAY_S, digits, second == "60")


def _elapsed(text: str) -> Moment | None:
    found = _ELAPSED.fullmatch(text)
    if found is None:
        duration = _duration_s(text)
        at_s = stamp_s(text) if duration is None else duration
        return None if at_s is None else Moment(at_s)
    minutes, seconds, number, unit = found.groups()
    if unit:
        return Moment(float(number) * _UNIT_S[unit])
    return Moment(int(minutes) * 60 + float(seconds), None, HOUR_S) if minutes else None


def _duration_s(text: str) -> float | None:
    found = _DURATION.fullmatch(text)
    if found is None:
        return None
    parts = found.groups()[4:] if found[1] is None else found.groups()[:4]
    days, hours, minutes, seconds = (float(part or 0.0) for part in parts)
    return round(days * 86400 + hours * 3600 + minutes * 60 + seconds, 9)


def _by_format(text: str, given: str) -> Moment | None:
    # As a number 00:09:05 is written 905.
    text = text.zfill(6) if given == HHMMSS else text
    try:
        at = datetime.datetime.strptime(text, given)
    except ValueError:
        return None
    zone = at.utcoffset()
    clock = at.replace(tzinfo=None)
    dated = clock.date() != datetime.date(1900, 1, 1)
    cycle_s = 0.0 if dated else DAY_S if _HOURS.search(given) else HOUR_S
    at_s = (clock - datetime.datetime(2000, 1, 1)).total_seconds()
    return Moment(at_s, None if zone is None else zone.total_seconds(), cycle_s)


def colon_unit_s(texts: Iterable[str]) -> float:
    """Return the unit of what stands behind the last colon of times; 0 where it is decimals.

    Decimals are written with as many digits each; where they differ, they are whole units.
    """
    found = [moment_of(text) for text in texts if _LAST_COLON.search(text)]
    digits = {m.colon_digits for m in found if m is not None and m.colon_digits}
    if len(digits) < 2:
        return 0.0
    return 1e-3 if max(digits) <= 3 else 1e-6 if max(digits) <= 6 else 1e-9


def zone_remedy(text: str) -> str:
    """Return what to do about a time with words for its zone; empty where there are none."""
    found = _ZONED.fullmatch(text.strip().strip('"'))
    if found is None or clock_s(found[1]) is None:
        return ""
    return (
        f"no hours from UTC are known for the zone {found[2]!r}: leave it out, or write the offset "
        "instead, such as +02:00"
    )
