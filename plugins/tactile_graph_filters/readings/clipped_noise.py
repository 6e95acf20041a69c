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

FARTHEST, HALF_WITHIN = 4.0, 0.6745
"""Standard deviations beyond which a reading is none of the noise, though no gap lies below it, and
within which half of the noise lies: of as many readings above rest as are cut off below."""

ENOUGH = 0.7
"""Of the readings that normal noise has above rest, the share that must be there: rounding makes
the noise seem up to a third larger."""

LARGEST_STEP = 1.0
"""Of a converter, in any unit: where all above rest read the same, and more, they are loads."""

ALIKE, APART = 1.05, 2.5
"""Times, and standard deviations beyond that, what neighbours share by chance."""

FEWEST_TIED = 12
"""Readings that are all the least above rest, from which on they are one step above it: a logarithm
or a root makes the steps further up smaller."""

FEW_STEPS = 8.0
"""Of a converter, up to which what is alike along rows or columns may be hum; a frame of two
values is a mat of switches, which has none."""

FEWEST_RUNS, LONGEST_TURN = 2, 16
"""Of noisy rows or columns, with quiet ones between: hum has them, a load does not. And how many
lines they are apart at most: what is slower, or fewer cells than lines, may as well be loads."""

UNEVEN = 3.0
"""Standard deviations by which what is above rest may be spread less evenly along the lines than by
chance: hum lies on whole lines, loads side by side on parts of them."""


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
    tied = len(above) >= FEWEST_TIED and above[FEWEST_TIED - 1] == above[0]
    first = float(above[0]) if tied else step
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
        half = min(at_rest // 2, k)
        if above[k] > FARTHEST * float(above[half]) / HALF_WITHIN:
            sigma = float(above[half]) / HALF_WITHIN
            k = int(above.searchsorted(FARTHEST * sigma, "right")) - 1
            n_above, n_free = k + 1, at_rest + k + 1
        if is_as_many(n_above, n_free, sigma, first):
            hum = FEW_STEPS * step if above[0] < above[-1] else 0.0
            return sigma if _is_anywhere_plain(values, known, rest, float(above[k]), hum) else 0.0
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
    tied = n - start >= FEWEST_TIED and sample[start + FEWEST_TIED - 1] == sample[start]
    first = sample[start] - rest if tied else step
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
        half = sample[min(start + (start - below) // 2, k)] - rest
        if above > FARTHEST * half / HALF_WITHIN:
            sigma = half / HALF_WITHIN
            while sample[k] - rest > FARTHEST * sigma:
                k -= 1
            above, n_above, n_free = sample[k] - rest, k + 1 - start, k + 1 - below
        if is_as_many(n_above, n_free, sigma, first):
            hum = FEW_STEPS * step if sample[start] < sample[n - 1] else 0.0
            return sigma if is_anywhere(values, known, rest, above, hum) else 0.0
    return 0.0


@compiled_later
def is_as_many(n_above: int, n_free: int, sigma: float, step: float) -> bool:
    """Return whether so many readings above rest, of all without a load, are enough for noise.

    Of rounded noise those above rest are what is more than half a ``step``, the first, beyond it.
    """
    expected = 0.5 * n_free * math.erfc(0.5 * step / (math.sqrt(2.0) * sigma))
    return n_above >= ENOUGH * expected


def _is_anywhere_plain(values: Values, known: Cells, rest: float, reach: float, hum: float) -> bool:
    """Return whether cells up to ``reach`` above rest are neighbours no oftener than by chance.

    Notes
    -----
    Pairs of neighbours, also across corners, are counted among cells at rest and those above (P.
    A. P. Moran 1948, The interpretation of statistical maps). Up to ``hum``, chance is also what
    each row or each column has: hum shifts whole ones by a few steps. Noisy ones then alternate
    with quiet ones, as under no single load, and are noisy anywhere along them.
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
    share = int(np.count_nonzero(noisy)) / max(int(np.count_nonzero(free)), 1)
    if are_few(both, pairs * share**2):
        return True
    if reach > hum:
        return False
    state = free.astype(np.uint8) + noisy
    return _is_by_line_plain(state, both, share) or _is_by_line_plain(state.T, both, share)


@compiled_twin_of(_is_anywhere_plain)
def is_anywhere(values, known, rest, reach, hum):  # type: ignore[no-untyped-def]
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
    share = n_noisy / max(n_free, 1)
    if are_few(both, pairs * share**2):
        return True
    if reach > hum:
        return False
    turned = np.ascontiguousarray(state.T)
    return is_by_line(state, both, share) or is_by_line(turned, both, share)


def _is_by_line_plain(state: NDArray[np.uint8], both: int, share: float) -> bool:
    """Return whether cells above rest are neighbours as often as each row's share of them says.

    Parameters
    ----------
    state : ndarray of uint8, shape (rows, columns)
        2 above rest, 1 at rest, 0 of others.
    both : int
        Neighbours that are above.
    share : float
        Of cells that are above, over all rows.
    """
    rows, columns = state.shape
    free = state > 0
    n_free, n_noisy = free.sum(axis=1), (state == 2).sum(axis=1)
    shares = n_noisy / np.maximum(n_free, 1)
    loud, runs = False, 0
    for its in shares[n_free > 0].tolist():
        if loud != (its > (0.5 * share if loud else share)):
            loud = not loud
            runs += loud
    if runs < max(FEWEST_RUNS, rows / LONGEST_TURN) or n_noisy.sum() < rows:
        return False
    likely = np.add.accumulate(shares[:, None] * free)[-1]
    spread = np.add.accumulate((shares * (1.0 - shares))[:, None] * free)[-1]
    apart = (state == 2).sum(axis=0) - likely
    uneven = float(np.add.accumulate(apart * apart)[-1])
    if not is_even(uneven, float(np.add.accumulate(spread)[-1]), columns):
        return False
    along = (free[:, 1:] & free[:, :-1]).sum(axis=1)
    across = np.zeros(len(free), np.int64)
    across[:-1] = (free[1:] & free[:-1]).sum(axis=1)
    across[:-1] += (free[1:, 1:] & free[:-1, :-1]).sum(axis=1)
    across[:-1] += (free[1:, :-1] & free[:-1, 1:]).sum(axis=1)
    terms = shares * (along * shares + across * np.append(shares[1:], 0.0))
    return are_few(both, float(np.add.accumulate(terms)[-1]))


@compiled_twin_of(_is_by_line_plain)
def is_by_line(state, both, share):  # type: ignore[no-untyped-def]
    """Do the same in loops."""
    rows, columns = state.shape
    shares, loud, runs, n_all = np.zeros(rows + 1), False, 0, 0
    for i in range(rows):
        n_free = n_noisy = 0
        for j in range(columns):
            n_free += state[i, j] > 0
            n_noisy += state[i, j] == 2
        shares[i] = n_noisy / max(n_free, 1)
        n_all += n_noisy
        if n_free > 0 and loud != (shares[i] > (0.5 * share if loud else share)):
            loud = not loud
            runs += loud
    if runs < max(FEWEST_RUNS, rows / LONGEST_TURN) or n_all < rows:
        return False
    uneven = chance = 0.0
    for j in range(columns):
        likely = spread = 0.0
        n_noisy = 0
        for i in range(rows):
            if state[i, j] > 0:
                likely += shares[i]
                spread += shares[i] * (1.0 - shares[i])
                n_noisy += state[i, j] == 2
        uneven += (n_noisy - likely) ** 2
        chance += spread
    if not is_even(uneven, chance, columns):
        return False
    expected = 0.0
    for i in range(rows):
        along = across = 0
        for j in range(columns):
            if state[i, j] == 0:
                continue
            along += j + 1 < columns and state[i, j + 1] > 0
            for m in range(max(0, j - 1), min(columns, j + 2)):
                across += i + 1 < rows and state[i + 1, m] > 0
        expected += shares[i] * (along * shares[i] + across * shares[i + 1])
    return are_few(both, expected)


@compiled_later
def is_even(uneven: float, chance: float, n: int) -> bool:
    """Return whether so much in all is how far ``n`` lines are off what is likely by chance."""
    return uneven <= 1e-9 + chance * (1.0 + UNEVEN * math.sqrt(2.0 / n))


@compiled_later
def are_few(both: int, expected: float) -> bool:
    """Return whether ``both`` are noisy no oftener than by chance."""
    by_chance = APART * math.sqrt(expected)
    return expected / ALIKE - by_chance <= both <= ALIKE * expected + by_chance
