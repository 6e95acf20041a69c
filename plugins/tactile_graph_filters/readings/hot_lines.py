"""Rows and columns that rest above the zero of all others, by an offset of their amplifier."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from tactile_graph.compiled import compiled_twin_of

Values = NDArray[np.float64]
Cells = NDArray[np.bool_]

LEAST_LINES = 8
"""On a pad of fewer rows or columns one of them is no line among many."""
AT_ZERO = 4.0
"""Standard deviations of noise within which a reading is the frame's zero."""
MOST_AT_ZERO = 0.1
"""Of a line's cells: so many may be dead, or lie on a dead line across it."""
FEWEST, LEAST_SHARE = 4, 0.25
"""Cells that nothing touches, and their share of the line, for their readings to be its zero."""
CLOSE, MOST_CLOSE = 2.0, 0.8
"""Standard deviations within which such cells read the same, and the share of them that must:
elements under a load differ by their gains."""
STEPS = 1.5
"""Of a converter, that such cells may differ at least: by one, which rounding leaves inexact."""
LEAST_OFFSET, LARGEST_OFFSET = 6.0, 128.0
"""Standard deviations from which on an offset is none of the noise, and beyond which it may as well
be a long thin load on even elements."""


def _offsets_plain(values: Values, known: Cells, zero: float, sigma: float, step: float) -> Values:
    """Return how far each row rests above the zero of a frame, 0 where it rests there.

    Parameters
    ----------
    values : ndarray, shape (rows, columns)
    known : ndarray of bool, the same shape
        Cells that count; of shape (0, 0) if all do.
    zero, sigma, step : float
        What untouched cells read, the standard deviation of their noise, and the least difference
        of two readings.

    Notes
    -----
    Hardly a cell of such a row reads the zero, but those whose neighbours in the rows beside do
    read all the same, as closely as noise lets them. A load so thin, from edge to edge, is as
    uneven as the elements' gains.
    """
    rows, n = values.shape
    offsets = np.zeros(rows)
    if rows < LEAST_LINES or n < LEAST_LINES or not sigma > 0.0:
        return offsets
    far, near = max(AT_ZERO * sigma, 0.5 * step), max(CLOSE * sigma, STEPS * step)
    counts = known if known.size else np.ones((rows, n), np.bool_)
    few = np.count_nonzero(counts & (values <= zero + far), axis=1) <= MOST_AT_ZERO * n
    for i in np.flatnonzero(few).tolist():
        beside = [k for k in (i - 1, i + 1) if 0 <= k < rows]
        free = counts[i] & (counts[beside] & (np.abs(values[beside] - zero) <= far)).all(axis=0)
        its = np.sort(values[i, free])
        m = len(its)
        if m < max(FEWEST, LEAST_SHARE * n):
            continue
        rest = 0.5 * float(its[(m - 1) // 2] + its[m // 2])
        if np.count_nonzero(np.abs(its - rest) <= near) < MOST_CLOSE * m:
            continue
        if LEAST_OFFSET * sigma < rest - zero <= LARGEST_OFFSET * sigma:
            offsets[i] = rest - zero
    return offsets


@compiled_twin_of(_offsets_plain)
def row_offsets(values, known, zero, sigma, step):  # type: ignore[no-untyped-def]
    """Do the same in loops, which leave a row as soon as enough of it reads the zero."""
    (rows, n), every = values.shape, known.size == 0
    offsets = np.zeros(rows)
    if rows < LEAST_LINES or n < LEAST_LINES or not sigma > 0.0:
        return offsets
    far, near = max(AT_ZERO * sigma, 0.5 * step), max(CLOSE * sigma, STEPS * step)
    for i in range(rows):
        at_zero = 0
        for j in range(n):
            at_zero += (every or known[i, j]) and values[i, j] <= zero + far
            if at_zero > MOST_AT_ZERO * n:
                break
        if at_zero > MOST_AT_ZERO * n:
            continue
        free, m = np.empty(n), 0
        for j in range(n):
            its = every or known[i, j]
            for k in range(max(0, i - 1), min(rows, i + 2)):
                if k != i and not ((every or known[k, j]) and abs(values[k, j] - zero) <= far):
                    its = False
            if its:
                free[m] = values[i, j]
                m += 1
        free = np.sort(free[:m])
        if m < max(FEWEST, LEAST_SHARE * n):
            continue
        rest, close = 0.5 * (free[(m - 1) // 2] + free[m // 2]), 0
        for j in range(m):
            close += abs(free[j] - rest) <= near
        if close < MOST_CLOSE * m:
            continue
        if LEAST_OFFSET * sigma < rest - zero <= LARGEST_OFFSET * sigma:
            offsets[i] = rest - zero
    return offsets
