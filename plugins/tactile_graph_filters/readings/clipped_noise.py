"""The noise of a frame in which much reads the same least value, told by what reads more."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from tactile_graph.compiled import compiled_later, compiled_twin_of

Values = NDArray[np.float64]
Cells = NDArray[np.bool_]

FEWEST = 4
"""Readings above the value at rest, for there to be any noise."""

FEWEST_AT_REST = 64
"""Readings at rest, for what is above to tell anything."""

REACH = 3.0
"""Standard deviations beyond which the next larger reading may be none of the noise."""

THINNER = 0.3
"""Readings up to twice as far, over those of the noise, from which on the noise is not all."""

ENOUGH = 0.7
"""Of the readings that normal noise has above rest, the share that must be there: rounding makes
the noise seem up to a third larger."""

LARGEST_STEP = 1.0
"""Of a converter, in any unit: where all above rest read the same, and more, they are loads."""

ALIKE, APART = 1.05, 2.5
"""Times, and standard deviations beyond that, what neighbours share by chance."""


def _noise_plain(values: Values, known: Cells, sample: Values, rest: float, step: float) -> float:
    """Return the standard deviation of noise whose lower half is cut off; 0 where there is none.

    Parameters
    ----------
    values : ndarray, shape (rows, columns)
    known : ndarray of bool, the same shape
        Cells that count; of shape (0, 0) if all do.
    sample : ndarray, shape (N,)
        Of their values, in ascending order.
    rest : float
        What many cells read, and hardly any less.
    step : float
        Least difference of two readings.

    Notes
    -----
    Of cells without a load half or more read ``rest``, where a device knows no less or its
    converter rounds to it; the others hold the upper half of the noise, up to a gap. Twice the sum
    of their squares over the number of both is its variance. It is believed where they are about as
    many as normal noise has there, and lie anywhere. Loads on a pad that truly reads ``rest`` are
    fewer, or lie side by side.
    """
    start = int(sample.searchsorted(rest, "right"))
    at_rest, above = start - int(sample.searchsorted(rest)), sample[start:] - rest
    if at_rest < FEWEST_AT_REST:
        return 0.0
    squares = np.add.accumulate(above * above)  # one by one, as loops add
    for k in range(len(above)):
        n_above, n_free = k + 1, at_rest + k + 1
        if n_above < FEWEST or (n_above < len(above) and above[k + 1] <= above[k]):
            continue
        sigma = math.sqrt(2.0 * float(squares[k]) / n_free)
        following = float(above[k + 1]) if n_above < len(above) else math.inf
        beyond = int(above.searchsorted(2.0 * above[k], "right")) - n_above
        if following <= REACH * sigma or beyond > n_above * THINNER:
            continue
        if step > LARGEST_STEP and above[0] == above[-1]:
            return 0.0
        if is_as_many(n_above, n_free, sigma, step):
            return sigma if _is_anywhere_plain(values, known, rest, float(above[k])) else 0.0
    return 0.0


@compiled_twin_of(_noise_plain)
def clipped_noise(values, known, sample, rest, step):  # type: ignore[no-untyped-def]
    """Do the same in loops."""
    n, below, start, total = sample.shape[0], 0, 0, 0.0
    while below < n and sample[below] < rest:
        below += 1
    start = below
    while start < n and sample[start] == rest:
        start += 1
    if start - below < FEWEST_AT_REST:
        return 0.0
    within = start
    for k in range(start, n):
        above = sample[k] - rest
        total += above * above
        n_above, n_free = k + 1 - start, k + 1 - below
        if n_above < FEWEST or (k + 1 < n and sample[k + 1] - rest <= above):
            continue
        sigma = math.sqrt(2.0 * total / n_free)
        following = sample[k + 1] - rest if k + 1 < n else np.inf
        while within < n and sample[within] - rest <= 2.0 * above:
            within += 1
        if following <= REACH * sigma or within - k - 1 > n_above * THINNER:
            continue
        if step > LARGEST_STEP and sample[start] == sample[n - 1]:
            return 0.0
        if is_as_many(n_above, n_free, sigma, step):
            return sigma if is_anywhere(values, known, rest, above) else 0.0
    return 0.0


@compiled_later
def is_as_many(n_above: int, n_free: int, sigma: float, step: float) -> bool:
    """Return whether so many readings above rest, of all without a load, are enough for noise.

    Of rounded noise those above rest are what is more than half a ``step`` beyond it.
    """
    expected = 0.5 * n_free * math.erfc(0.5 * step / (math.sqrt(2.0) * sigma))
    return n_above >= ENOUGH * expected


def _is_anywhere_plain(values: Values, known: Cells, rest: float, reach: float) -> bool:
    """Return whether cells up to ``reach`` above rest are neighbours no oftener than by chance.

    Notes
    -----
    Pairs of neighbours, also across corners, are counted among cells at rest and those above (P.
    A. P. Moran 1948, The interpretation of statistical maps).
    """
    free = (values >= rest) & (values <= rest + reach)
    if known.size:
        free &= known
    noisy = free & (values > rest)
    pairs = both = 0
    for one, other in (
        (np.s_[:, 1:], np.s_[:, :-1]),
        (np.s_[1:], np.s_[:-1]),
        (np.s_[1:, 1:], np.s_[:-1, :-1]),
        (np.s_[1:, :-1], np.s_[:-1, 1:]),
    ):
        pairs += int(np.count_nonzero(free[one] & free[other]))
        both += int(np.count_nonzero(noisy[one] & noisy[other]))
    return are_few(both, pairs, int(np.count_nonzero(noisy)), int(np.count_nonzero(free)))


@compiled_twin_of(_is_anywhere_plain)
def is_anywhere(values, known, rest, reach):  # type: ignore[no-untyped-def]
    """Do the same in loops."""
    (rows, columns), every, top = values.shape, known.size == 0, rest + reach
    state = np.zeros((rows, columns), np.uint8)
    n_free = n_noisy = pairs = both = 0
    for i in range(rows):
        for j in range(columns):
            if (every or known[i, j]) and rest <= values[i, j] <= top:
                state[i, j] = 1 if values[i, j] == rest else 2
                n_free += 1
                n_noisy += values[i, j] > rest
    for i in range(rows):
        for j in range(columns):
            if state[i, j] == 0:
                continue
            for di, dj in ((0, 1), (1, 0), (1, 1), (1, -1)):
                k, m = i + di, j + dj
                if k < rows and 0 <= m < columns and state[k, m] > 0:
                    pairs += 1
                    both += state[i, j] == 2 and state[k, m] == 2
    return are_few(both, pairs, n_noisy, n_free)


@compiled_later
def are_few(both: int, pairs: int, n_noisy: int, n_free: int) -> bool:
    """Return whether ``both`` of so many pairs are noisy no oftener than by chance."""
    expected = pairs * (n_noisy / max(n_free, 1)) ** 2
    by_chance = APART * math.sqrt(expected)
    return expected / ALIKE - by_chance <= both <= ALIKE * expected + by_chance
