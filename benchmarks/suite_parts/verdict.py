"""Compare two result files: what became faster, slower, better, worse, beyond the noise.

Machines differ and drift, so a time is never compared as such: within each file and case, every
contestant's rounds are divided by the reference contestant's rounds of the same number, and what is
compared are those ratios. Errors are paired frame by frame where the seed is the same.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from suite_parts.records import Measured, Results

LEVEL = 0.999
"""Of each interval: of a few hundred comparisons without a change, hardly one is called one."""
LEAST = 0.05
"""Changes of time smaller than this are called none, however sure they are."""
DRAWS = 2000

Word = Literal["faster", "slower", "better", "worse", "same", "unsure"]


@dataclass(frozen=True)
class Verdict:
    """What became of one contestant on one case.

    ``ratio`` is new over old, with the ends of its interval; for errors a difference in the
    quantity's unit.
    """

    measured: Measured
    what: str
    ratio: float
    low: float
    high: float
    word: Word


def verdicts(old: Results, new: Results, seed: int = 0) -> list[Verdict]:
    """Return a verdict for each contestant, case and quantity that both files hold."""
    rng = np.random.default_rng(seed)
    before = {(m.family, m.case, m.contestant): m for m in old.measured}
    found = []
    for m in new.measured:
        was = before.get((m.family, m.case, m.contestant))
        if was is None:
            continue
        times = _time(was, m, old, new, rng)
        found += [times] if times else []
        found += [
            v for q in m.errors if q in was.errors and (v := _error(was, m, q, old, new, rng))
        ]
    return found


PEERS = (
    "OpenCV script", "circle-fit taubinSVD", "OpenCV fitEllipse", "OpenCV minAreaRect",
    "OpenCV convexHull", "scikit-image script", "skimage CircleModel", "skimage EllipseModel",
)  # fmt: skip
"""Whom times are divided by: the first of these in a case. Their code is not ours to change."""


def references(results: Results) -> dict[tuple[str, str], Measured]:
    """Return the contestant of each case that others are divided by; the first without a peer."""
    found: dict[tuple[str, str], Measured] = {}
    for m in results.measured:
        held = found.get((m.family, m.case))
        if len(m.rounds_us) > 1 and (held is None or _rank(m) < _rank(held)):
            found[m.family, m.case] = m
    return found


def _rank(measured: Measured) -> int:
    name = measured.contestant
    return PEERS.index(name) if name in PEERS else len(PEERS)


def _time(
    was: Measured, now: Measured, old: Results, new: Results, rng: np.random.Generator
) -> Verdict | None:
    key = (now.family, now.case)
    base_old, base_new = references(old).get(key), references(new).get(key)
    if base_old is None or base_new is None or base_old.contestant != base_new.contestant:
        return None
    if now.contestant == base_new.contestant or min(len(was.rounds_us), len(now.rounds_us)) < 3:
        return None
    before, after = _ratios(was, base_old), _ratios(now, base_new)
    ratio, low, high = _of_medians(before, after, rng)
    word: Word = "unsure"
    if high < 1.0 - LEAST:
        word = "faster"
    elif low > 1.0 + LEAST:
        word = "slower"
    elif low > 1.0 - 3 * LEAST and high < 1.0 + 3 * LEAST:
        word = "same"
    return Verdict(now, "time", ratio, low, high, word)


def _ratios(measured: Measured, base: Measured) -> NDArray[np.float64]:
    n = min(len(measured.rounds_us), len(base.rounds_us))
    return np.log(np.array(measured.rounds_us[:n]) / np.array(base.rounds_us[:n]))


def _of_medians(
    before: NDArray[np.float64], after: NDArray[np.float64], rng: np.random.Generator
) -> tuple[float, float, float]:
    """Return the ratio of medians with its bootstrap interval."""
    drawn = [np.median(rng.choice(s, (DRAWS, len(s))), axis=1) for s in (before, after)]
    tail = 50.0 * (1.0 - LEVEL)
    low, high = np.percentile(drawn[1] - drawn[0], [tail, 100.0 - tail])
    middle = np.median(after) - np.median(before)
    return float(np.exp(middle)), float(np.exp(low)), float(np.exp(high))


def _error(
    was: Measured, now: Measured, quantity: str, old: Results, new: Results,
    rng: np.random.Generator,
) -> Verdict | None:  # fmt: skip
    """Return how the error changed; paired where both saw the same frames."""
    a, b = was.errors[quantity], now.errors[quantity]
    if old.seed == new.seed and len(a) == len(b):
        pairs = [(x, y) for x, y in zip(a, b, strict=True) if x is not None and y is not None]
        if len(pairs) < 2:
            return None
        change = np.array([y - x for x, y in pairs])
        drawn = rng.choice(change, (DRAWS, len(change))).mean(axis=1)
        middle = float(change.mean())
    else:
        one, two = (np.array([e for e in s if e is not None]) for s in (a, b))
        if min(len(one), len(two)) < 2:
            return None
        drawn = rng.choice(two, (DRAWS, len(two))).mean(1) - rng.choice(
            one, (DRAWS, len(one))
        ).mean(1)
        middle = float(two.mean() - one.mean())
    tail = 50.0 * (1.0 - LEVEL)
    low, high = (float(v) for v in np.percentile(drawn, [tail, 100.0 - tail]))
    word: Word = "better" if high < 0.0 else "worse" if low > 0.0 else "same"
    return Verdict(now, quantity, middle, low, high, word)
