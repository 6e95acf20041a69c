"""Times that stand beside a stack: numbers in some unit, dates, or texts that say them."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

import numpy as np
from numpy.typing import NDArray

from tactile_graph.errors import DataError
from tactile_graph_sources.readers.reading import Reading
from tactile_graph_sources.readers.tables.layout import assumed_unit
from tactile_graph_sources.readers.words.compact import stamps_s
from tactile_graph_sources.readers.words.moments import colon_unit_s, zone_remedy
from tactile_graph_sources.readers.words.names import SECONDS, named
from tactile_graph_sources.readers.words.running_clock import RunningClock

Seconds = NDArray[np.float64]
TEXTS = "OSTU"
"""Kinds of arrays whose times are texts."""


def in_seconds(reading: Reading, name: str, times: NDArray[Any]) -> Seconds | None:
    """Return times in seconds, dates from the first on; None where they cannot be read.

    Parameters
    ----------
    reading : Reading
        Told what is assumed, and which times are left out.
    name : str
        What the array is called, its unit behind it or not.
    times : ndarray, shape (n,)
        Numbers, dates, or texts.

    Raises
    ------
    DataError
        If the settings say a unit of what has none, or a format of what is no text.
    """
    told = reading.told.of_columns
    if times.dtype.kind in TEXTS:
        texts = [_text(t) for t in times]
        numbers = None if told.time_format else _numbers(texts)
        if numbers is None:
            _refuse(reading, "time_unit", f"{name!r} holds texts, which time_format is about")
            return _of_texts(reading, name, texts)
        times = numbers
    if times.dtype.kind in "Mm":
        _refuse(reading, "time_unit", f"{name!r} holds dates")
        _refuse(reading, "time_format", f"{name!r} holds dates")
        return np.asarray((times - times[:1]) / np.timedelta64(1, "s"), np.float64)
    _refuse(reading, "time_format", f"{name!r} holds numbers, which time_unit is about")
    numbers = times.astype(np.float64)
    if told.time_unit:
        return numbers * SECONDS[told.time_unit]
    stamps = stamps_s(numbers)
    return numbers * _factor(reading, name, numbers) if stamps is None else stamps - stamps[0]


def _refuse(reading: Reading, setting: str, why: str) -> None:
    if setting in reading.told.of_columns.given:
        raise DataError(str(reading.path), f"{why}; leave out {setting}")


def _text(time: Any) -> str:
    return time.decode("utf-8", "replace") if isinstance(time, bytes) else str(time)


def _numbers(texts: list[str]) -> Seconds | None:
    try:
        return np.array(texts, np.float64)
    except ValueError:
        return None


def _of_texts(reading: Reading, name: str, texts: list[str]) -> Seconds | None:
    """Return the times that texts say, as in a table, from the first on; NaN for empty ones."""
    given = reading.told.of_columns.time_format
    clock = RunningClock(str(reading.path), reading.assume, given, colon_unit_s(texts))
    found = [clock.read(t) for t in texts]
    odd = next((t for t, at in zip(texts, found, strict=True) if at is None and t.strip()), "")
    if odd or not any(at is not None for at in found):
        why = f"{odd.strip()[:30]!r} is no time that is known" if odd else "its texts are empty"
        remedy = zone_remedy(odd) or "give time_format"
        reading.assume(f"times left out, as of {name!r} {why} ({remedy})")
        return None
    at = np.array([np.nan if one is None else one for one in found])
    at -= at[np.isfinite(at)][0]
    return at.round(6)


def _factor(reading: Reading, name: str, times: Seconds) -> float:
    """Return the factor of times to seconds, by their name, else by themselves, which is told."""
    said = named((bare(name), ""))
    if said.time_factor is not None:
        return said.time_factor
    factor, note = assumed_unit(times[np.isfinite(times)], said.time_unit)
    reading.assume(note)
    return factor


def time_among(names: Iterable[str]) -> str:
    """Return the first of the names that says time, ours before all; empty if none does."""
    ours_first = sorted(names, key=lambda n: (bare(n) != "time_s", n))
    return next((n for n in ours_first if "time" in named((bare(n), "")).roles), "")


def bare(name: str) -> str:
    """Return the name of an array without those of its groups."""
    return name.replace(".", "/").rpartition("/")[2]
