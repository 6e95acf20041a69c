"""``Stamps``: number and time of a frame from the fields of its line."""

from __future__ import annotations

import math
from collections.abc import Sequence

from tactile_graph_sources.devices.device_clock import DeviceClock
from tactile_graph_sources.readers.reading import Reading
from tactile_graph_sources.readers.tables.layout import Layout
from tactile_graph_sources.readers.words.dialect import floats
from tactile_graph_sources.readers.words.moments import clock_s
from tactile_graph_sources.readers.words.own_number import number_in
from tactile_graph_sources.readers.words.running_clock import RunningClock
from tactile_graph_sources.readers.words.short_counter import ShortCounter

_COUNTS = 1 << 32


class Stamps:
    """Reads what a table keeps of each frame beside its cells.

    Times of day count from the first frame, and go on as a `RunningClock` does. Where a table has
    no time but says its rate, the frame's number gives it.
    """

    def __init__(self, reading: Reading, layout: Layout) -> None:
        self._reading = reading
        self._layout = layout
        self._first: float | None = None
        given, colon_s = layout.time_format, layout.colon_s
        self._clock = RunningClock(str(reading.path), reading.assume, given, colon_s)
        self._start = reading.start
        self._counter, self._short = DeviceClock(1.0, _COUNTS), ShortCounter()

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
            return self._on_from_first(dated if dated and clock_s(dated) is not None else clock)
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
        """Return a time in counts as if micros() and the like did not begin anew."""
        if self._layout.time_factor > 1e-3:
            return time
        return self._short.run_on(self._counter.run_on(time))

    def _on_from_first(self, text: str) -> float:
        at = self._clock.read(text)
        if at is None:
            raise ValueError(f"{text.strip()[:30]!r} is no time of day")
        self._first = at if self._first is None else self._first
        return round(at - self._first, 6)
