"""Summaries of errors, paired differences with their intervals, and the Pareto front."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from tactile_graph_compare.records.scores import Difference, Score, TimeDifference, Times
from tactile_graph_compare.score.scoring import QuantityErrors

Reals = NDArray[np.float64]
LEVEL = 0.95
Z = 1.959963984540054
"""The normal distribution's 97.5 % point: half of what lies outside `LEVEL` on either side."""
LEAST_FRAMES = 6
"""That differ; from so many on bounds are told: fewer are all of one sign by chance too often."""
DIFFERS = 1e-9
"""What is no farther from 0, in any unit, is rounding."""
RESAMPLES = 2000
MOST_RESAMPLED = 2000
"""Frames up to which means are resampled; beyond, they are normal for all that matters here."""


def frozen(values: Sequence[float] | Reals, kind: type = np.float64) -> NDArray[Any]:
    """Return a read-only array."""
    array: NDArray[Any] = np.asarray(values, dtype=kind)
    array.setflags(write=False)
    return array


def score_of(variant: str, quantity: str, unit: str, found: QuantityErrors) -> Score:
    """Return the score of what was collected for one quantity of one variant."""
    errors = np.asarray(found.errors, dtype=np.float64)
    known = errors[~np.isnan(errors)]
    off = np.abs(known)
    some = off.size > 0
    bias = None
    if some:
        bias = float(known.mean())
        if quantity == "centre":
            bias = float(np.hypot(*np.mean(found.offsets, axis=0)))
    return Score(
        variant,
        quantity,
        unit,
        frozen(found.positions, np.int64),
        frozen(found.objects, np.int64),
        frozen(errors),
        float(off.mean()) if some else None,
        float(np.median(off)) if some else None,
        float(np.percentile(off, 95)) if some else None,
        float(off.max()) if some else None,
        bias,
        int(off.size),
        int(errors.size - off.size),
        found.n_extra,
    )


def with_pareto(scores: Sequence[Score], median_us: Mapping[str, float]) -> tuple[Score, ...]:
    """Return the scores, those marked that none of the same quantity beats in error and time."""
    return tuple(
        replace(
            one,
            pareto=one.mean is not None
            and not any(_beats(s, one, median_us) for s in scores if s.quantity == one.quantity),
        )
        for one in scores
    )


def _beats(other: Score, one: Score, median_us: Mapping[str, float]) -> bool:
    if other.mean is None or one.mean is None or other.n_answered < one.n_answered:
        return False
    theirs, ours = (other.mean, median_us[other.variant]), (one.mean, median_us[one.variant])
    return all(a <= b for a, b in zip(theirs, ours, strict=True)) and theirs != ours


# -- paired differences ----------------------------------------------------------------------


class Interval(NamedTuple):
    """A mean and the bounds it lies within at `LEVEL`; None where too few values tell."""

    mean: float
    low: float | None
    high: float | None
    method: str
    p: float | None = None


def mean_interval(
    values: Reals, rng: np.random.Generator, counts: NDArray[np.int64] | None = None
) -> Interval:
    """Return the mean of differences, and its interval over frames.

    Parameters
    ----------
    values : ndarray of float64, shape (n,)
        The sum of each frame's. At least one.
    rng : Generator
        Draws the resamples.
    counts : ndarray of int64, shape (n,), optional
        Of how many each sum is, 1 if not given.

    Notes
    -----
    Up to `MOST_RESAMPLED` frames the percentile bootstrap over them (Efron 1979,
    10.1214/aos/1176344552), expanded as few values need it (`tail_of`), beyond it the normal
    distribution; where fewer than `LEAST_FRAMES` differ from 0, no bounds. Both take the frames as
    independent; frames of one slow scene are not, and the interval is then too narrow.
    """
    n = values.size
    counts = np.ones(n, np.int64) if counts is None else counts
    mean = float(values.sum() / counts.sum())
    if n < LEAST_FRAMES:
        return Interval(mean, None, None, f"no bounds below {LEAST_FRAMES} frames")
    if np.count_nonzero(np.abs(values) > DIFFERS) < LEAST_FRAMES:
        return Interval(mean, None, None, f"no bounds below {LEAST_FRAMES} frames that differ")
    error = float((values - mean * counts).std(ddof=1)) * np.sqrt(n) / int(counts.sum())
    p = _two_sided(mean, error, n)
    if n > MOST_RESAMPLED:
        half = Z * error
        return Interval(mean, mean - half, mean + half, "normal over frames", p)
    means = np.empty(RESAMPLES)
    for start in range(0, RESAMPLES, 250):  # in parts: all at once would take n times 16 kB
        drawn = rng.integers(0, n, (250, n))
        means[start : start + 250] = values[drawn].sum(axis=1) / counts[drawn].sum(axis=1)
    tail = tail_of(n)
    low, high = np.percentile(means, (tail, 100.0 - tail))
    return Interval(mean, float(low), float(high), "bootstrap over frames", p)


def _two_sided(mean: float, error: float, n: int) -> float:
    """Return how often Student's distribution is as far from 0 as a mean of so many values."""
    from scipy.special import stdtr

    if not error > 0.0:
        return float(mean == 0.0)
    return float(2.0 * stdtr(n - 1, -abs(mean) / error))


def for_all_together(differences: Sequence[Difference]) -> tuple[Difference, ...]:
    """Return differences, each with whether it leaves out 0 for all of them together.

    Notes
    -----
    Holm's procedure (1979, www.jstor.org/stable/4615733): where no variant differs, the chance that
    any of the verdicts says so stays below what `LEVEL` leaves, however many there are.
    """
    known = sorted((d.p, k) for k, d in enumerate(differences) if d.p is not None)
    hold: set[int] = set()
    for done, (p, k) in enumerate(known):
        if p * (len(known) - done) > 1.0 - LEVEL:
            break
        hold.add(k)
    return tuple(replace(d, for_all=k in hold) for k, d in enumerate(differences))


def tail_of(n: int) -> float:
    """Return which percentile of resampled means is the lower bound at `LEVEL`, in percent.

    Parameters
    ----------
    n : int
        Independent values that were resampled.

    Notes
    -----
    The expanded percentile interval (Hesterberg 2015, 10.1080/00031305.2015.1089789). Resamples of
    few values spread too little: with the plain standard deviation instead of the unbiased one, and
    as if it were known and not estimated, by normal quantiles instead of Student's.
    """
    if n < 2:
        return 50.0 * (1.0 - LEVEL)
    from scipy.special import ndtr, stdtrit

    t = stdtrit(n - 1, 0.5 * (1.0 - LEVEL)) * np.sqrt(n / (n - 1))
    return float(100.0 * ndtr(t))


def difference_of(one: Score, reference: Score, rng: np.random.Generator) -> Difference:
    """Return how much farther off a variant is than its reference, where both answered.

    Objects of one frame are no more independent than one, so frames are resampled with all theirs.
    """
    mine, theirs = _answered(one), _answered(reference)
    both = sorted(mine.keys() & theirs.keys())
    by_frame: dict[int, list[float]] = {}
    for key in both:
        by_frame.setdefault(key[0], []).append(mine[key] - theirs[key])
    found = None
    if both:
        sums, counts = zip(*((sum(v), len(v)) for v in by_frame.values()), strict=True)
        found = mean_interval(np.array(sums), rng, np.array(counts))
    return Difference(
        one.variant,
        reference.variant,
        one.quantity,
        one.unit,
        found.mean if found else None,
        found.low if found else None,
        found.high if found else None,
        LEVEL,
        found.method if found else "",
        len(both),
        len(mine.keys() - theirs.keys()),
        len(theirs.keys() - mine.keys()),
        len(_missing(one) & _missing(reference)),
        found.p if found else None,
    )


def _keys(score: Score) -> list[tuple[int, int]]:
    return list(zip(score.positions.tolist(), score.objects.tolist(), strict=True))


def _answered(score: Score) -> dict[tuple[int, int], float]:
    off = np.abs(score.errors).tolist()
    return {k: e for k, e in zip(_keys(score), off, strict=True) if e == e}


def _missing(score: Score) -> set[tuple[int, int]]:
    return {k for k, e in zip(_keys(score), score.errors.tolist(), strict=True) if e != e}


# -- times -----------------------------------------------------------------------------------


def times_of(per_frame_us: Sequence[float]) -> Times:
    """Return the summary of times per frame, those of reused frames (NaN) left out."""
    times = np.asarray(per_frame_us, dtype=np.float64)
    known = times[~np.isnan(times)]
    if known.size == 0:
        known = np.zeros(1)
    return Times(
        frozen(times),
        float(np.median(known)),
        float(np.percentile(known, 95)),
        float(known.mean()),
    )


def time_difference_of(variant: str, reference: str, one: Times, other: Times) -> TimeDifference:
    """Return how much longer a variant takes than its reference, over the same frames."""
    mine, theirs = one.per_frame_us, other.per_frame_us
    known = ~(np.isnan(mine) | np.isnan(theirs))
    if not known.any():
        return TimeDifference(variant, reference, 0.0, None, None, 1.0)
    mine, theirs = mine[known], theirs[known]
    off = np.sort(mine - theirs)
    some = theirs > 0.0
    ratio = float(np.median(mine[some] / theirs[some])) if some.any() else 1.0
    return TimeDifference(variant, reference, float(np.median(off)), *_median_bounds(off), ratio)


def _median_bounds(ordered: Reals) -> tuple[float | None, float | None]:
    """Return order statistics that hold the median at `LEVEL` (binomial, normal approximation).

    See Conover, Practical Nonparametric Statistics, 3rd ed. 1999, section 3.2.
    """
    n = ordered.size
    if n < LEAST_FRAMES:
        return None, None
    low = int(np.floor(0.5 * (n - Z * np.sqrt(n))))
    return float(ordered[max(low, 0)]), float(ordered[min(n - 1 - low, n - 1)])
