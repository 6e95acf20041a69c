"""Which frames are chosen by, and which the outcome is told of."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from numpy.random import Generator
from numpy.typing import NDArray

from tactile_graph.errors import UsageError
from tactile_graph.wires.frame import Frame
from tactile_graph_compare.score.statistics import tail_of
from tactile_graph_tune.stretches import pieces_of, stretches_of
from tactile_graph_tune.table.kinds import Reals

LEAST_FRAMES = 8
PIECES = 8
"""Into so many a recording is cut whose stretches are too few to be told apart."""
FEW = "though the scene hardly changes, so that all numbers look better and surer than they are"
RESAMPLES = 2000


class Split(NamedTuple):
    """Rows on either side, and which belong together.

    Parameters
    ----------
    choosing, reporting : ndarray of int64
        Rows of the table.
    groups : ndarray of int64, shape (n_frames,)
        Frames of one group are resampled together.
    how : str
        In words.
    """

    choosing: NDArray[np.int64]
    reporting: NDArray[np.int64]
    groups: NDArray[np.int64]
    how: str


def split_of(frames: Sequence[Frame], n_apart: int, seed: int) -> Split:
    """Return which frames are on which side.

    Parameters
    ----------
    frames : sequence of Frame
        Those to be held out, if they were named, last.
    n_apart : int
        How many were named so.
    seed : int

    Raises
    ------
    UsageError
        If there are too few.
    """
    n = len(frames)
    if n < LEAST_FRAMES:
        raise UsageError(
            f"{n} frame{'s' if n != 1 else ''} with a known truth: half of them choose and the "
            f"others tell what came of it, so {LEAST_FRAMES} are needed at least"
        )
    if n_apart >= n:
        raise UsageError("no frame with a known truth is left to choose by")
    rows, first = np.arange(n), n - n_apart
    groups = stretches_of(frames[:first])
    if n_apart:
        groups = np.concatenate([groups, stretches_of(frames[first:]) + groups.max() + 1])

    def sides() -> tuple[NDArray[np.bool_], bool]:
        if n_apart:
            return rows < first, True
        return _half(frames, groups, rows, np.random.default_rng([seed, 5]))

    chosen, several = sides()
    of_recordings = "recordings named for it" if n_apart else "recording by recording"
    how = of_recordings if several else "by stretches of neighbouring frames"
    # Two to choose by and two to report on, since of one there is neither half nor interval.
    told, least = (~chosen, 2) if several else (rows >= 0, 4)
    pieces = pieces_of(frames, PIECES)
    if _n_pressed(frames, groups, told) < min(least, _n_pressed(frames, pieces, told)):
        groups, how = pieces, f"{how}, {FEW}"
        chosen, _ = sides()
    return Split(rows[chosen], rows[~chosen], groups, how)


def _n_pressed(frames: Sequence[Frame], groups: NDArray[np.int64], told: NDArray[np.bool_]) -> int:
    """Return in how many of some frames' groups something lies; if in none, how many there are."""
    pressed = told & np.array([bool(f.truth) for f in frames])
    return len(np.unique(groups[pressed if pressed.any() else told]))


def halves_of(frames: Sequence[Frame], split: Split, seed: int) -> list[NDArray[np.int64]]:
    """Return the rows that choose in two halves, recording by recording if there are several.

    Parameters
    ----------
    frames : sequence of Frame
    split : Split
    seed : int
    """
    rng = np.random.default_rng([seed, 6])
    first, _ = _half(frames, split.groups, split.choosing, rng)
    return [split.choosing[first], split.choosing[~first]]


def _half(
    frames: Sequence[Frame], groups: NDArray[np.int64], rows: NDArray[np.int64], rng: Generator
) -> tuple[NDArray[np.bool_], bool]:
    """Return which rows are in the first half, and whether recordings were told apart."""
    labels = np.unique([frames[k].label for k in rows], return_inverse=True)[1]
    several = bool(labels.max() > 0)
    parts = labels if several else groups[rows]
    mixed = rng.permutation(np.unique(parts))
    return np.isin(parts, mixed[: (len(mixed) + 1) // 2]), several


class Interval(NamedTuple):
    """A mean, and the bounds it lies within at 95 %."""

    mean: float
    low: float
    high: float


def interval_of(
    values: Reals, groups: NDArray[np.int64], seed: int, over: Reals | None = None
) -> Interval:
    """Return the mean of values, and its expanded percentile bootstrap over groups.

    Parameters
    ----------
    values : ndarray of float64, shape (n,)
    groups : ndarray of int64, shape (n,)
    seed : int
        Draws the resamples, the same for every row of a table.
    over : ndarray of float64, shape (n,), optional
        Return the ratio of the means of values to these instead; NaN if they are all 0.
    """
    _, at = np.unique(groups, return_inverse=True)
    below = np.ones(len(values)) if over is None else over
    sums, counts = np.bincount(at, values), np.bincount(at, below)
    if not counts.any():
        return Interval(np.nan, np.nan, np.nan)
    rng = np.random.default_rng([seed, 9])
    drawn = rng.integers(0, len(sums), (RESAMPLES, len(sums)))
    weights = counts[drawn].sum(axis=1)
    known = weights > 0.0  # where frames that count are few, a draw may hold none
    means = sums[drawn].sum(axis=1)[known] / weights[known]
    tail = tail_of(int((counts > 0.0).sum()))
    low, high = np.percentile(means, (tail, 100.0 - tail))
    return Interval(float(values.sum() / below.sum()), float(low), float(high))
