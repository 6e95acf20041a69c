"""What a pad's frames looked like so far, to tell a frame from one cut at the wrong place."""

from __future__ import annotations

from collections import deque
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

KEPT = 32
"""Units kept; what a byte did in them is what it is expected to do next."""
DECIDES_NATS = 8.0
"""Log of the odds from which on a phase is taken for certain, on a pad at perfect rest."""
DECIDES_SPREADS = 6.0
"""By how many standard deviations of what good units came to the odds must be above that."""
RENEW_AFTER = 8
"""Units after which what is expected is worked out anew."""
TOLD = 8
"""Of the units kept, the last ones, which are told from the others."""
AFTER = 3
"""Of the last units the one that suits best goes before: what was overwritten is like nothing."""
SPREADS_PER_MAD = 1.4826
STRAY = 0.02
"""Share of bytes near their last value that may after all be anything."""
LEAST_STEP = 0.5
WIDE = 128
"""Values from which on a byte says nothing: how far its range goes on is then chance."""


@dataclass(frozen=True)
class Expectation:
    """What is expected of each byte of a unit, each array of shape (size,)."""

    step: NDArray[np.float64]
    low: NDArray[np.int16]
    high: NDArray[np.int16]
    within: NDArray[np.float64]
    outside: NDArray[np.float64]
    smooth: NDArray[np.bool_]

    def nats(self, units: NDArray[np.int16], before: NDArray[np.int16]) -> NDArray[np.float64]:
        """Return the log likelihood of each byte of units, each after the one before it.

        Either may have more axes before its last two: all are held against all.
        """
        inside = (units >= self.low) & (units <= self.high)
        ranged = np.where(inside, self.within, self.outside)
        near = (1.0 - STRAY) * _cauchy(units - before, self.step) + STRAY / 256.0
        return np.log(np.where(self.smooth, near, ranged))


class Likeness:
    """Remembers the last good units, and says how well others fit them.

    Each byte is predicted on its own, by the better of two for what it did so far: near its last
    value, as far off as its steps were (a Cauchy density: a contact that moves costs little more
    than one at rest), or anywhere in the range it had. A byte that is always the same weighs 10
    nats when it is not, one that takes all values nothing.
    """

    def __init__(self, size: int) -> None:
        self._recent = deque([np.zeros((0, size), np.uint8)])
        self._n_recent = 0
        self._n = 0
        self._expected: Expectation | None = None
        self._spread = self._least = 0.0

    def remember(self, units: NDArray[np.uint8], n: int) -> None:
        """Take note of ``n`` good units; of the last of these, shape (k, size), in their order."""
        if len(units) == 0:
            return
        self._recent.append(units)  # views: joined only when they are asked for
        self._n_recent += len(units)
        while self._n_recent - len(self._recent[0]) >= KEPT:
            self._n_recent -= len(self._recent.popleft())
        if self._n // RENEW_AFTER != (self._n + n) // RENEW_AFTER:
            self._expected = None
        self._n += n

    @property
    def units(self) -> NDArray[np.uint8]:
        """The units remembered, the last one last, shape (k, size)."""
        if len(self._recent) > 1:
            self._recent = deque([np.concatenate(self._recent)[-KEPT:]])
            self._n_recent = len(self._recent[0])
        return self._recent[0][-KEPT:]

    @property
    def age(self) -> int:
        """How often what is expected was worked out anew."""
        return self._n // RENEW_AFTER

    def decides(self, best: float, rest: float) -> bool:
        """Return whether a unit's nats make its phase certain over one whose unit has ``rest``.

        They must be those of a good unit, too, and ahead by what chance does not bring.
        """
        self._expectation()
        enough = DECIDES_NATS + DECIDES_SPREADS * self._spread
        return best - rest >= enough and self.is_typical(best)

    def is_typical(self, nats: float) -> bool:
        """Return whether so many nats are those of a good unit, as far as any are known."""
        self._expectation()
        return nats >= self._least

    def log_likelihood(self, units: NDArray[np.uint8]) -> NDArray[np.float64]:
        """Return how likely each unit is after the last good ones, in nats; 0 if none is known."""
        expected = self._expectation()
        if expected is None:
            return np.zeros(len(units))
        wide = units.astype(np.int16)
        last = self.units[-AFTER:].astype(np.int16)
        return np.asarray(expected.nats(wide, last[:, None]).sum(axis=-1).max(axis=0))

    def _expectation(self) -> Expectation | None:
        if self._expected is None and self._n_recent > 1:
            units = self.units.astype(np.int16)
            self._expected = _expectation(units)
            past = self._expected.nats(units[1:], units[:-1])
            self._spread = float(np.sqrt(past.var(axis=0).sum()))
            told = [past[-TOLD:].sum(axis=1), _told_ahead(units)]
            self._least = min(_least(nats) for nats in told)
        return self._expected


def _told_ahead(units: NDArray[np.int16]) -> NDArray[np.float64]:
    """Return the nats of the last units as told from those before them.

    So what comes next will be told, too: a contact that moves is where it never was.
    """
    n = max(2, len(units) - TOLD)
    if len(units) <= n:
        return np.full(1, -np.inf)
    return np.asarray(_expectation(units[:n]).nats(units[n:], units[n - 1 : -1]).sum(axis=1))


def _least(nats: NDArray[np.float64]) -> float:
    """Return from how many nats on a unit is like those of ``nats``; a stray one counts little."""
    middle = _median(nats)
    if middle == -np.inf:
        return middle
    spread = SPREADS_PER_MAD * _median(np.abs(nats - middle))
    return middle - DECIDES_NATS - DECIDES_SPREADS * spread


def _median(values: NDArray[np.float64]) -> float:
    ordered = np.sort(values)  # NumPy's own imports a megabyte of masked arrays, while a pad sends
    return 0.5 * float(ordered[(len(ordered) - 1) // 2] + ordered[len(ordered) // 2])


def _expectation(units: NDArray[np.int16]) -> Expectation:
    """Return what units lead to expect; of ``n`` values the next is beyond them in 2 / (n + 2)."""
    low = np.maximum(units.min(axis=0) - 1, 0).astype(np.int16)
    high = np.minimum(units.max(axis=0) + 1, 255).astype(np.int16)
    width = high - low + 1.0
    beyond = 2.0 / (len(units) + 2.0)
    within, outside = (1.0 - beyond) / width, beyond / np.maximum(256.0 - width, 1.0)
    within[width > WIDE] = outside[width > WIDE] = 1.0 / 256.0
    steps = np.diff(units, axis=0)
    step = np.maximum(np.abs(steps).mean(axis=0), LEAST_STEP)
    smooth = np.log(_cauchy(steps, step)).mean(axis=0) > np.log(within)
    return Expectation(step, low, high, within, outside, smooth)


def _cauchy(steps: NDArray[np.int16], step: NDArray[np.float64]) -> NDArray[np.float64]:
    out: NDArray[np.float64] = step / (np.pi * (step * step + np.square(steps, dtype=np.float64)))
    return out
