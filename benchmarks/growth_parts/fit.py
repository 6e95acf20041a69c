"""How a step's time grows with the cells: its exponent, and how sure that is."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from growth_parts.timing import Point

LARGE_END = 3
"""Sizes that the exponent of the large end is fitted to: a fixed cost a call says nothing there."""
DRAWS = 2000
FASTER = 1.1
"""An exponent above which a step grows faster than the cells."""


class Exponent(NamedTuple):
    """Slope of log time over log cells, with the middle 95 % of what drawn rounds give."""

    value: float
    low: float
    high: float

    @property
    def faster(self) -> bool:
        """Whether the time surely grows faster than the cells."""
        return self.low > FASTER


def median_s(point: Point) -> float:
    """Return the median of a point's rounds."""
    return float(np.median(point.rounds_s))


def exponent(points: Sequence[Point], seed: int = 1) -> Exponent | None:
    """Return the exponent over some sizes; None where fewer than two have a time.

    The interval is of rounds drawn anew at each size: it knows noise of the clock, and nothing
    of a line that is bent.
    """
    timed = [p for p in points if p.rounds_s]
    if len(timed) < 2:
        return None
    cells = np.log([p.side**2 for p in timed])
    rng = np.random.default_rng(seed)
    drawn = np.array(
        [np.median(rng.choice(p.rounds_s, (DRAWS, len(p.rounds_s))), axis=1) for p in timed]
    )
    weights = (cells - cells.mean()) / np.sum((cells - cells.mean()) ** 2)
    slopes = weights @ np.log(drawn)
    value = float(weights @ np.log([median_s(p) for p in timed]))
    low, high = np.percentile(slopes, (2.5, 97.5))
    return Exponent(value, float(low), float(high))


def large_end(points: Sequence[Point]) -> Exponent | None:
    """Return the exponent over the largest sizes that have a time."""
    return exponent([p for p in points if p.rounds_s][-LARGE_END:])
