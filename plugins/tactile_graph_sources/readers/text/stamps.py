"""``Stamps``: number and time of a frame from the fields of its line."""

from __future__ import annotations

import math
from collections.abc import Sequence
from datetime import datetime

from tactile_graph_sources.devices.device_clock import DeviceClock
from tactile_graph_sources.readers.reading import Reading
from tactile_graph_sources.readers.tables.layout import Layout
from tactile_graph_sources.readers.words.compact import HHMMSS
from tactile_graph_sources.readers.words.dialect import clock_s, floats
from tactile_graph_sources.readers.words.own_number import number_in

_DAY_S = 86400.0
_COUNTS = 1 << 32


class Stamps:
    """Reads what a table keeps of each frame beside its cells.

    Times of day count from the first frame, and go on over midnight. Where a table has no time
    but says its rate, the frame's number gives it.
    """

    def __init__(self, reading: Reading, layout: Layout) -> None:
        self._reading = reading
        self._layout = layout
        self._first: float | None = None
        self._last = -math.inf
        self._days = 0.0
        self._start = reading.start
        self._counter = DeviceClock(1.0, _COUNTS)

    def of(self, fields: Sequence[str]) -> tuple[float | None, float | None]:
        """Return the number and the time (s) of a frame; None where there is none.

        Raises
        ------
        ValueError
            If either is no number.
        """
        roles = self._layout.roles
        index = None
        if "frame" in roles:
            index = number_in(fields[roles["frame"]])
            if not math.isfinite(index):
                raise ValueError("the frame's number is no number")
        return index, self.time_s(fields)

    def time_s(self, fields: Sequence[str]) -> float | None:
        """Return the time of a frame; raises what `of` raises."""
        layout = self._layout
        if "clock" in layout.roles:
            clock = fields[layout.roles["clock"]]
            dated = "" if layout.date is None else f"{fields[layout.date].strip()} {clock.strip()}"
            return self._clock(dated if dated and clock_s(dated) is not None else clock)
        if "time" not in layout.roles:
            frame_s = layout.said.frame_s
            return None if frame_s is None else (self._reading.index - self._start) * frame_s
        time_s = self._run_on(floats([fields[layout.roles["time"]]])[0]) * layout.time_factor
        if layout.part is not None:
            time_s += floats([fields[layout.part[0]]])[0] * layout.part[1]
        if not math.isfinite(time_s):
            raise ValueError("the time is no number")
        return time_s

    def _run_on(self, time: float) -> float:
        """Return a time in counts as if micros() and the like did not begin anew at 2^32."""
        return self._counter.run_on(time) if self._layout.time_factor <= 1e-3 else time

    def _clock(self, text: str) -> float:
        given = self._layout.time_format
        at = by_format(text, given) if given else clock_s(text)
        if at is None:
            raise ValueError(f"{text.strip()[:30]!r} is no time of day")
        if at + self._days < self._last - _DAY_S / 2:
            self._days += _DAY_S
        self._last = at + self._days
        self._first = self._last if self._first is None else self._first
        return round(self._last - self._first, 6)


def by_format(text: str, given: str) -> float | None:
    """Return a date or time of day in seconds, as `strptime` takes it; None where it is none."""
    # As a number 00:09:05 is written 905.
    text = text.strip().zfill(6) if given == HHMMSS else text
    try:
        at = datetime.strptime(text.strip().strip('"'), given)
    except ValueError:
        return None
    return (at.replace(tzinfo=None) - datetime(2000, 1, 1)).total_seconds()
