"""``Gaps``: the time from frame to frame, which those without a time of their own share."""

from __future__ import annotations

from tactile_graph.wires import Frame


class Gaps:
    """Tells how long before each frame the one before was taken.

    A frame without a time is taken to lie as far behind the one before as known ones lie apart,
    by their numbers; after a pause, as before it. Known times are never moved: what frames without
    one were given is no longer missing from the gap of the next that has one.
    """

    def __init__(self) -> None:
        self._known: tuple[float, int] | None = None
        self._now_s: float | None = None
        self._steps_s: tuple[float, ...] = ()
        self._n_since = self._n_untold = 0

    def before(self, frame: Frame) -> float | None:
        """Return the seconds since the last frame; None where no time says any."""
        time_s, last_s, known = frame.time_s, self._now_s, self._known
        self._n_since += 1
        if time_s is None:
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

    def _guessed(self, index: int) -> float | None:
        known, last_s = self._known, self._now_s
        if known is None or last_s is None or not self._steps_s:
            self._n_untold += 1  # the step takes it for a frame of its usual length
            return None
        n = max(self._n_since, index - known[1])
        self._now_s = max(last_s, known[0] + n * min(self._steps_s))
        return self._now_s - last_s
