"""Whether what rows of a frame read lies side by side across them, as under a load."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from tactile_graph.compiled import compiled_later, compiled_twin_of

Values = NDArray[np.float64]
Cells = NDArray[np.bool_]

FEWEST_PAIRS = 48
"""Of cells in neighbouring rows, for them to tell anything."""
MOST_CLUMPED, ALIKE = 4.0, 0.35
"""Standard deviations by which readings may lie side by side across the lines: a load's do. And the
most that those of two lines have in common."""
SURE = 0.02
"""Least share of cells on or off by chance, where all of a line are on."""


def _is_clumped_plain(above: Values, free: Cells, means: Values, used: Cells, loud: Cells) -> bool:
    """Return whether readings lie side by side across rows more than by chance.

    Parameters
    ----------
    above : ndarray, shape (rows, columns)
        How much they read above what cells at rest do.
    free : ndarray of bool, the same shape
        Cells that lie away from loads.
    means : ndarray, shape (rows,)
        Of each row's free cells.
    used, loud : ndarray of bool, the same shape
        Rows that count, and those that are lifted above rest.
    """
    n = free.shape[1]
    n_free = np.maximum(free.sum(axis=1), 1)
    apart = np.where(free, above - means[:, None], 0.0)
    spread = (apart * apart).sum(axis=1) / n_free
    varied = used & (spread > 0.0)
    common = chance = pairs = 0.0
    for lag in (1, 2):
        both = varied[lag:] & varied[:-lag]
        its = (free[lag:] & free[:-lag]).sum(axis=1)[both]
        common += float((apart[lag:] * apart[:-lag]).sum(axis=1)[both].sum())
        chance += float((np.sqrt(spread[lag:]) * np.sqrt(spread[:-lag]))[both] @ its)
        pairs += float(its.sum())
    down = float((apart[used].sum(axis=0) ** 2).sum())
    down /= max(float((spread * n_free)[used].sum()), 1e-300)
    on = free & (above > 0.0)
    shares = on.sum(axis=1) / n_free
    off = np.where(free, on - shares[:, None], 0.0)[loud].sum(axis=0)
    likely = float((shares * (1.0 - shares) * n_free)[loud].sum())
    down_on = float((off**2).sum()) / max(likely, SURE * float(n_free[loud].sum()))
    return are_clumped(common, chance, pairs, down + down_on, n)


@compiled_twin_of(_is_clumped_plain)
def is_clumped(above, free, means, used, loud):  # type: ignore[no-untyped-def]
    """Do the same in loops."""
    rows, n = above.shape
    spread, shares, n_frees = np.zeros(rows), np.zeros(rows), np.zeros(rows)
    for i in range(rows):
        for j in range(n):
            if free[i, j]:
                n_frees[i] += 1.0
                spread[i] += (above[i, j] - means[i]) ** 2
                shares[i] += above[i, j] > 0.0
        spread[i] /= max(n_frees[i], 1.0)
        shares[i] /= max(n_frees[i], 1.0)
    common = chance = pairs = down = expected = down_on = likely = sure = 0.0
    for i in range(rows):
        for k in range(i + 1, min(rows, i + 3)):
            if not (used[i] and used[k] and spread[i] > 0.0 and spread[k] > 0.0):
                continue
            its = 0
            for j in range(n):
                if free[i, j] and free[k, j]:
                    its += 1
                    common += (above[i, j] - means[i]) * (above[k, j] - means[k])
            chance += math.sqrt(spread[i]) * math.sqrt(spread[k]) * its
            pairs += its
        expected += spread[i] * n_frees[i] if used[i] else 0.0
        likely += shares[i] * (1.0 - shares[i]) * n_frees[i] if loud[i] else 0.0
        sure += SURE * n_frees[i] if loud[i] else 0.0
    for j in range(n):
        apart = on = 0.0
        for i in range(rows):
            if free[i, j] and used[i]:
                apart += above[i, j] - means[i]
                on += (above[i, j] > 0.0) - shares[i] if loud[i] else 0.0
        down += apart * apart
        down_on += on * on
    uneven = down / max(expected, 1e-300) + down_on / max(likely, sure)
    return are_clumped(common, chance, pairs, uneven, n)


@compiled_later
def are_clumped(common: float, chance: float, pairs: float, uneven: float, n: int) -> bool:
    """Return whether so much is shared by pairs, and by ``n`` columns (2 by chance), by a load."""
    if pairs < FEWEST_PAIRS or not chance > 0.0:
        return True
    alike = abs(common) / chance
    clumped = alike * math.sqrt(pairs) + (uneven - 2.0) / math.sqrt(2.0 / n)
    return alike > ALIKE or clumped > MOST_CLUMPED
