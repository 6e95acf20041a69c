"""Noise that shifts whole rows or columns of a frame, where the device cuts off all below zero."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from tactile_graph.compiled import compiled_later, compiled_twin_of
from tactile_graph_filters.readings.clipped_noise import clipped_noise
from tactile_graph_filters.readings.clumped_lines import is_clumped

Values = NDArray[np.float64]
Cells = NDArray[np.bool_]

LEAST_LINES = 8
"""A pad of fewer rows or columns tells nothing of what its lines share."""
LOUD, FEWEST_LOUD = 0.5, 3
"""Of a line's cells, the share above rest from which on it is shifted up, and how many must be."""
LOW, START, SHOWS = 0.3, 6.0, 4.0
"""Share of the readings above rest on loud lines that are surely noise; times that, where the
search for its end begins; and standard deviations, where it ends."""
LOADED = 4.0
"""Times that end, that the largest reading reaches where something lies there."""
LEAST_SHARE = 0.3
"""Of the loud lines' cells, that must lie away from loads for them to tell anything."""
LEAST_FREE = 0.25
"""Of a line, for it to be compared with those beside."""
LIFTED, SOFT, LONGEST_RUN = 0.3, 0.7, 3
"""Of the loud lines' mean, what lifted ones read, and by how much a slow shift rises from line to
line at most; what is no longer than so many lines, in several places, may rise at once."""
LONGEST_TURN = 16
"""Lines that such places are apart at most."""
MOST_QUIET = 0.2
"""Of the columns, the share in which none of the loud rows reads more than rest: beside a load,
more do."""
STEEPEST, FAINTEST = 0.55, 0.9
"""How the scatter within loud rows may go with what they read, as a power of it, for it to be noise
beside a shift: of clear shifts, and of such as hardly stand out of it, where what is cut off makes
it go. Gains make it go by the first power."""
CLEAR, FAINT, STARK = 2.5, 1.8, 7.0
"""Times that scatter, that the loudest row's mean is of a clear shift, and of one that hardly is;
and from which on it is none."""
APART = 1.25
"""Times that what the louder rows read must be what the others do, for that power to be told."""
LARGEST = 1e100
"""Of readings whose squares and products are numbers."""
MOST_BEYOND = 0.8
"""Of the readings above rest, the share that what is anywhere may leave over as loads."""


def _cut_off_plain(values: Values, known: Cells, sample: Values, rest: float, step: float) -> float:
    """Return the standard deviation of noise whose lower half is cut off; 0 where there is none.

    Parameters
    ----------
    values, known, sample, rest, step
        As of `clipped_noise`, which tells noise that is anywhere.

    Notes
    -----
    Hum, or a drift along the order in which cells are read, lifts some lines above rest and leaves
    others: the noise is then what the lifted ones read.
    """
    anywhere = clipped_noise.reference(values, known, sample, rest, step)
    if anywhere > 0.0 and is_most(sample, rest, anywhere):
        return anywhere
    by_row = _line_noise_plain(values, known, rest, step)
    return max(anywhere, by_row, _line_noise_plain(values.T, known.T, rest, step))


@compiled_twin_of(_cut_off_plain)
def cut_off_noise(values, known, sample, rest, step):  # type: ignore[no-untyped-def]
    """Do the same in loops."""
    anywhere = clipped_noise(values, known, sample, rest, step)
    if anywhere > 0.0 and is_most(sample, rest, anywhere):
        return anywhere
    by_row = line_noise(values, known, rest, step)
    return max(anywhere, by_row, line_noise(values.T, known.T, rest, step))


@compiled_later
def is_most(sample: Values, rest: float, sigma: float) -> bool:
    """Return whether most of the readings above rest, in ascending order, are such noise."""
    n_above = sample.size - np.searchsorted(sample, rest, "right")
    beyond = sample.size - np.searchsorted(sample, rest + SHOWS * sigma, "right")
    return bool(beyond <= MOST_BEYOND * n_above)


def _line_noise_plain(values: Values, known: Cells, rest: float, step: float) -> float:
    """Return the standard deviation of what lifts whole rows above rest; 0 where nothing does.

    Notes
    -----
    On a lifted, loud row most cells read more than rest. How much more ends where the root mean
    square says; what reads more than that, and cells beside it, are loads. Along the others chance
    alone decides which reads how much: those of one column have no more in common than their rows
    have, and none of the columns reads more than others. Under a load, they do. Where rows rise at
    once to what they read and go on with that, they may as well be a bar from edge to edge; so they
    may where the cells of a row scatter by a share of what the row reads, as gains do.
    """
    rows, n = values.shape
    if rows < LEAST_LINES or n < LEAST_LINES:
        return 0.0
    counts = known if known.size else np.ones((rows, n), np.bool_)
    above = np.where(counts, values - rest, 0.0)
    n_known = counts.sum(axis=1)
    loud = ((above > 0.0).sum(axis=1) > LOUD * n_known) & (n_known >= LEAST_LINES)
    if np.count_nonzero(loud) < FEWEST_LOUD:
        return 0.0
    quiet = n - np.count_nonzero((above[loud] > 0.0).any(axis=0))
    if quiet > MOST_QUIET * n:
        return 0.0
    top = float(above.max())
    if top > LARGEST:
        return 0.0
    reach = reach_of(np.sort(above[loud][counts[loud]]), step)
    if reach == 0.0 or reach < top < LOADED * reach:
        return 0.0
    wide = np.pad(above > reach, 1)
    beside = [wide[i : i + rows, j : j + n] for i in range(3) for j in range(3)]
    free = counts & ~np.any(beside, axis=0)
    n_free = free.sum(axis=1)
    used = n_free >= LEAST_FREE * n
    loud = used & ((free & (above > 0.0)).sum(axis=1) > LOUD * n_free)
    if np.count_nonzero(loud) < FEWEST_LOUD:
        return 0.0
    if n_free[loud].sum() < LEAST_SHARE * n_known[loud].sum():
        return 0.0
    means = np.where(free, above, 0.0).sum(axis=1) / np.maximum(n_free, 1)
    if not is_soft(means, used, loud) or is_clumped.reference(above, free, means, used, loud):
        return 0.0
    if is_load_of_gains(above, free, means, loud):
        return 0.0
    its = above[loud][free[loud]]
    return math.sqrt(float(np.add.accumulate(its * its)[-1]) / its.size)


@compiled_twin_of(_line_noise_plain)
def line_noise(values, known, rest, step):  # type: ignore[no-untyped-def]
    """Do the same in loops, which end as soon as too few rows are loud."""
    (rows, n), every = values.shape, known.size == 0
    if rows < LEAST_LINES or n < LEAST_LINES:
        return 0.0
    loud, n_loud, loud_cells = np.zeros(rows, np.bool_), 0, 0
    for i in range(rows):
        n_known, n_above = n, 0
        for j in range(n):
            n_above += values[i, j] > rest
        if not every:
            n_known = n_above = 0
            for j in range(n):
                n_known += known[i, j]
                n_above += known[i, j] and values[i, j] > rest
        loud[i] = n_above > LOUD * n_known and n_known >= LEAST_LINES
        n_loud += loud[i]
        loud_cells += n_known if loud[i] else 0
    if n_loud < FEWEST_LOUD:
        return 0.0
    on = np.zeros(n, np.bool_)
    for i in range(rows):
        if loud[i]:
            for j in range(n):
                on[j] |= (every or known[i, j]) and values[i, j] > rest
    if n - np.count_nonzero(on) > MOST_QUIET * n:
        return 0.0
    its, m, top = np.empty(loud_cells), 0, 0.0
    for i in range(rows):
        for j in range(n):
            if every or known[i, j]:
                top = max(top, values[i, j] - rest)
                if loud[i]:
                    its[m] = values[i, j] - rest
                    m += 1
    if top > LARGEST:
        return 0.0
    reach = reach_of(np.sort(its), step)
    if reach == 0.0 or reach < top < LOADED * reach:
        return 0.0
    above, free = np.zeros((rows, n)), np.ones((rows, n), np.bool_)
    for i in range(rows):
        for j in range(n):
            if not (every or known[i, j]):
                free[i, j] = False
                continue
            above[i, j] = values[i, j] - rest
            if above[i, j] > reach:
                free[max(0, i - 1) : i + 2, max(0, j - 1) : j + 2] = False
    used, means = np.zeros(rows, np.bool_), np.zeros(rows)
    n_loud = n_loud_known = n_loud_free = 0
    total = 0.0
    for i in range(rows):
        n_free = n_on = n_known = 0
        for j in range(n):
            n_known += every or known[i, j]
            if free[i, j]:
                n_free += 1
                n_on += above[i, j] > 0.0
                means[i] += above[i, j]
        means[i] /= max(n_free, 1)
        used[i] = n_free >= LEAST_FREE * n
        loud[i] = used[i] and n_on > LOUD * n_free
        if loud[i]:
            n_loud += 1
            n_loud_known += n_known
            n_loud_free += n_free
            for j in range(n):
                total += above[i, j] * above[i, j] if free[i, j] else 0.0
    if n_loud < FEWEST_LOUD or n_loud_free < LEAST_SHARE * n_loud_known:
        return 0.0
    if not is_soft(means, used, loud) or is_clumped(above, free, means, used, loud):
        return 0.0
    if is_load_of_gains(above, free, means, loud):
        return 0.0
    return math.sqrt(total / n_loud_free)


@compiled_later
def reach_of(ordered: Values, step: float) -> float:
    """Return up to where readings above rest, in ascending order, are noise; 0 if all are alike."""
    first = int(np.searchsorted(ordered, 0.0, "right"))
    if ordered[first] == ordered[-1]:
        return 0.0
    squares = np.cumsum(ordered * ordered)
    reach = START * float(ordered[first + int(LOW * (ordered.size - first - 1))])
    for _ in range(3):
        k = int(np.searchsorted(ordered, reach, "right"))
        reach = max(SHOWS * math.sqrt(float(squares[k - 1]) / k), 2.0 * step)
    return reach


@compiled_later
def is_soft(means: Values, used: Cells, loud: Cells) -> bool:
    """Return whether rows rise as slowly as a shift does, or where few of them do, in many places.

    Parameters
    ----------
    means : ndarray, shape (rows,)
        What they read above rest.
    used, loud : ndarray of bool, the same shape
        Rows that count, and those whose mean the others are lifted by.
    """
    rows, total, n_loud = len(loud), 0.0, 0
    for i in range(rows):
        total += means[i] if loud[i] else 0.0
        n_loud += loud[i]
    mean, was = total / n_loud, False
    rises, edges, runs, n_lifted = 0.0, 0, 0, 0
    for i in range(rows):
        its = used[i] and means[i] > LIFTED * mean
        if i > 0 and its != was:
            rises += means[i] - means[i - 1] if its else means[i - 1] - means[i]
            edges += 1
        runs += its and not was
        n_lifted += its
        was = its
    if edges > 0 and rises <= SOFT * mean * edges:
        return True
    return runs >= max(2, rows / LONGEST_TURN) and n_lifted <= LONGEST_RUN * runs


@compiled_later
def is_load_of_gains(above: Values, free: Cells, means: Values, loud: Cells) -> bool:
    """Return whether loud rows are as of a load on uneven cells, or stand out too far for a shift.

    Parameters
    ----------
    above, free : ndarray, shape (rows, columns)
        How much cells read above rest, and which of them lie away from loads.
    means : ndarray, shape (rows,)
        Of each row's free cells.
    loud : ndarray of bool, the same shape
    """
    rows, n = above.shape
    ordered = np.sort(means[loud])
    half = max(len(ordered) // 2, 1)
    low, high = ordered[half - 1], ordered[len(ordered) - half]
    low_mean = low_square = high_mean = high_square = 0.0
    n_low = n_high = 0
    for i in range(rows):
        if not loud[i] or low < means[i] < high:
            continue
        square, n_free = 0.0, 0
        for j in range(n):
            if free[i, j]:
                n_free += 1
                square += (above[i, j] - means[i]) ** 2
        if means[i] >= high:
            n_high += 1
            high_mean += means[i]
            high_square += square / n_free
        else:
            n_low += 1
            low_mean += means[i]
            low_square += square / n_free
    if n_low == 0 or high_square == 0.0:
        return True
    high_mean, low_mean = high_mean / n_high, low_mean / n_low
    scatter, other = math.sqrt(high_square / n_high), math.sqrt(low_square / n_low)
    stands_out = ordered[-1] / scatter
    if stands_out > STARK:
        return True
    if high_mean < APART * low_mean:
        return bool(stands_out > CLEAR)
    if other == 0.0:
        return True
    power = math.log(scatter / other) / math.log(high_mean / low_mean)
    faint = min(max((CLEAR - stands_out) / (CLEAR - FAINT), 0.0), 1.0)
    return bool(power > STEEPEST + faint * (FAINTEST - STEEPEST))
