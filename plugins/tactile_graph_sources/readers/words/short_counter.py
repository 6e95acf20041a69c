"""``ShortCounter``: a counter of 16 bits that goes on where it begins anew."""

from __future__ import annotations

import math
from collections import deque
from statistics import median

_COUNTS = 1 << 16
_FEWEST, _RECENT = 2, 31
_ALIKE = 0.5
"""How far from the usual step, in such steps, that over the counter's end may be."""


class ShortCounter:
    """Turns counts below 2^16 into ones that go on, where only that can have happened.

    It wrapped where a count that falls back is one step on over the end, as the steps before are:
    a recording that begins anew falls back from anywhere.
    """

    def __init__(self) -> None:
        self._last = math.nan
        self._turned = 0
        self._steps: deque[float] = deque(maxlen=_RECENT)

    def run_on(self, count: float) -> float:
        """Return the count as if the counter had not wrapped."""
        step = count - self._last
        if step < 0.0 and len(self._steps) >= _FEWEST and self._last < _COUNTS:
            usual = median(self._steps)
            if abs(step + _COUNTS - usual) <= _ALIKE * usual:
                self._turned += _COUNTS
        elif step > 0.0:
            self._steps.append(step)
        if math.isfinite(count):
            self._last = count
        return count + self._turned
