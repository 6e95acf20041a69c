"""``Gaps``: the time from frame to frame, which those without a time of their own share."""

from __future__ import annotations

from tactile_graph.wires import Frame

LEAP_S, DRIFT = 60.0, 0.01
"""By how much a device's clock and the arrivals may be apart, and by what share of the time since
the first frame: farther, the device's clock was set, or tells no seconds."""


class Gaps:
    """Tells how long before each frame the one before was taken.

    By the device's own clock where it goes on about as long as the frames' times do: these may tell
    when frames arrived, in bursts.

    A frame without a time is taken to lie as far behind the one before as known ones lie apart,
    by their numbers; after a pause, as before it. Known times are never moved: what frames without
    one were given is no longer missing from the gap of the next that has one.
    """

    def __init__(self) -> None:
        self._known: tuple[float, int] | None = None
        self._now_s: float | None = None
        self._steps_s: tuple[float, ...] = ()
        self._n_since = self._n_untold = 0
        self._last: tuple[float, float | None] | None = None
        self._first_s = self._ahead_s = 0.0

    def before(self, frame: Frame) -> float | None:
        """Return the seconds since the last frame; None where no time says any."""
        time_s, last_s, known = self._time_of(frame), self._now_s, self._known
        self._n_since += 1
        stands = known is not None and time_s == known[0] and not self._steps_s
        if time_s is None or stands:
            return self._guessed(frame.index)
        n, untold = self._n_since, self._n_untold
        self._now_s, self._known = time_s, (time_s, frame.index)
        self._n_since = self._n_untold = 0
        if known is None or last_s is None:
            return None
        step_s, n = time_s - known[0], max(n, frame.index - known[1])
        if step_s > 0.0:
            self._steps_s = (*self._steps_s[-1:], step_s / n)
        if step_s >= 0.0:  # only a clock that was set back goes back, never one that was guessed
            self._now_s = max(last_s, time_s)
        gap_s = self._now_s - last_s
        return gap_s * (n - untold) / n if untold else gap_s

    def _time_of(self, frame: Frame) -> float | None:
        """Return when a frame was taken, by the frames' clock where it arrived."""
        time_s, device_s, last = frame.time_s, frame.device_time_s, self._last
        if time_s is None:
            return None
        if last is None:
            self._first_s = time_s
        elif device_s is not None and last[1] is not None and device_s > last[1]:
            ahead_s = self._ahead_s + (device_s - last[1]) - (time_s - last[0])
            if abs(ahead_s) <= LEAP_S + DRIFT * (time_s - self._first_s):
                self._ahead_s = ahead_s
        self._last = time_s, device_s
        return time_s + self._ahead_s

    def _guessed(self, index: int) -> float | None:
        known, last_s = self._known, self._now_s
        if known is None or last_s is None or not self._steps_s:
            self._n_untold += 1  # the step takes it for a frame of its usual length
            return None
        n = max(self._n_since, index - known[1])
        self._now_s = max(last_s, known[0] + n * min(self._steps_s))
        return self._now_s - last_s
