"""``DeviceClock``: a device's counter of ticks that wraps, as a time that goes on."""

from __future__ import annotations

from typing import Any

from numpy.typing import NDArray

GOES_ON, WRAPS = 1 / 16, 1 / 8
"""Of a counter's range: so near to one of the last two stamps, a stamp goes on from there; so near
over the counter's end, it wrapped. Any other is a damaged stamp, a long pause, or a device that
started anew."""
SHORT_S = 30.0
"""Within this a step on over the end is a wrap up to half a turn: a counter of 16 bits or fewer may
go round within a few frames."""


class DeviceClock:
    """Turns a wrapping counter of ticks into seconds that go on where it wraps.

    Each stamp is held against the last two, so that one that is damaged moves no later one. A stamp
    that goes on from neither stays in the turn of the last, as after a restart, which begins at 0.
    Stamps beyond the counter's range are those of a longer one, and never wrap.
    """

    def __init__(self, unit_s: float, modulus: int) -> None:
        self.unit_s = unit_s
        self.modulus = modulus
        self.reset()

    def reset(self) -> None:
        """Start afresh: the device may have started anew."""
        self._last: tuple[float, int] | None = None
        self._before: tuple[float, int] | None = None

    def seconds(self, ticks: NDArray[Any]) -> list[float]:
        """Return the times of consecutive frames."""
        return [self.run_on(tick) * self.unit_s for tick in ticks.tolist()]

    def run_on(self, tick: float) -> float:
        """Return the ticks in all, as if the counter had not wrapped."""
        turn = self._turn(tick)
        self._last, self._before = (tick, turn), self._last
        return tick + turn * self.modulus

    def _turn(self, tick: float) -> int:
        """Return how often the counter had wrapped at a stamp."""
        pasts = [past for past in (self._last, self._before) if past is not None]
        for then, turn in pasts:
            if abs(tick - then) < GOES_ON * self.modulus:
                return turn
        if not pasts:
            return 0
        steps = [
            (abs(tick + over * self.modulus - then), turn + over)
            for then, turn in pasts
            for over in (1, -1)
            if turn + over >= 0 and max(then, tick) < self.modulus
        ]
        step, wrapped = min(steps, default=(self.modulus, 0))
        if step < WRAPS * self.modulus:
            return wrapped
        then, turn = pasts[0]
        ahead = tick + self.modulus - then
        over = then < self.modulus and ahead < min(self.modulus / 2, SHORT_S / self.unit_s)
        return turn + over
