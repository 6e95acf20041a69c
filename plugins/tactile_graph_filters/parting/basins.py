"""The kernel that cuts a footprint into the basins of its smoothed readings."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from tactile_graph.compiled import compiled_twin_of

STEPS = 2.0**30
LOWEST = 1e-290  # highest ground that still counts: `STEPS` over less would be no number
"""Into so many heights the smoothed readings are sorted."""


def taps_of(sigma: float) -> NDArray[np.float64]:
    """Return the weights of a Gaussian over -3 to 3 cells, their sum 1.

    Parameters
    ----------
    sigma : float
        Its standard deviation in cells, > 0.

    Returns
    -------
    ndarray of float64, shape (7,)
    """
    weights: NDArray[np.float64] = np.exp(-0.5 * (np.arange(-3.0, 4.0) / sigma) ** 2)
    weights /= weights.sum()
    return weights


def _basins_plain(
    values: NDArray[np.float64],
    on: NDArray[np.bool_],
    taps: NDArray[np.float64],
    labels: NDArray[np.int32],
) -> int:
    """Write the basins' numbers (from 1, 0 = off) into ``labels``; return how many there are.

    Every cell that is on climbs the values, smoothed along rows and columns by ``taps``, to the
    highest of its eight neighbours, on even ground to the first in reading order, until there
    is none; cells that end together are one basin. The way may lead over cells that are off.
    Numbers go by the first cell of a basin in reading order.
    """
    rows, columns = values.shape
    reach = len(taps) // 2
    padded = np.pad(values, reach)
    across = np.zeros((rows + 2 * reach, columns))
    for k, tap in enumerate(taps):
        across += tap * padded[:, k : k + columns]
    smooth = np.zeros((rows, columns))
    for k, tap in enumerate(taps):
        smooth += tap * across[k : k + rows]
    # Whole numbers: even ground must not be torn by the last bit of a sum.
    heights = np.floor(smooth * (STEPS / max(smooth.max(), LOWEST)))
    walled = np.pad(heights, 1, constant_values=-1.0)
    number_of = np.arange(values.size).reshape(values.shape)
    highest, to = np.full(values.shape, -1.0), number_of
    for i in (-1, 0, 1):
        for j in (-1, 0, 1):
            there = walled[1 + i : 1 + i + rows, 1 + j : 1 + j + columns]
            # In reading order, so that of equal neighbours the first is taken.
            to = np.where(there > highest, number_of + i * columns + j, to)
            highest = np.maximum(highest, there)
    flat = to.ravel()
    while not np.array_equal(flat, flat[flat]):
        flat = flat[flat]
    peaks, first = np.unique(flat[on.ravel()], return_index=True)
    number = np.zeros(values.size, np.int32)
    number[peaks[np.argsort(first)]] = np.arange(1, peaks.size + 1)
    labels[...] = np.where(on, number[flat].reshape(values.shape), 0)
    return int(peaks.size)


@compiled_twin_of(_basins_plain)
def basins(values, on, taps, labels):  # type: ignore[no-untyped-def]
    """Write the basins' numbers into ``labels``; return how many there are."""
    rows, columns = values.shape
    reach = len(taps) // 2
    across = np.zeros((rows, columns))
    smooth = np.zeros((rows, columns))
    for i in range(rows):
        for k in range(len(taps)):
            for j in range(max(0, reach - k), min(columns, columns + reach - k)):
                across[i, j] += taps[k] * values[i, j + k - reach]
    for k in range(len(taps)):
        for i in range(max(0, reach - k), min(rows, rows + reach - k)):
            for j in range(columns):
                smooth[i, j] += taps[k] * across[i + k - reach, j]
    highest = LOWEST
    for i in range(rows):
        for j in range(columns):
            highest = max(highest, smooth[i, j])
    for i in range(rows):
        for j in range(columns):
            smooth[i, j] = np.floor(smooth[i, j] * (STEPS / highest))
    number = np.zeros((rows, columns), np.int32)
    count = 0
    for i in range(rows):
        for j in range(columns):
            labels[i, j] = 0
            if not on[i, j]:
                continue
            y, x = i, j
            while True:
                to_y, to_x = max(0, y - 1), max(0, x - 1)
                for k in range(to_y, min(rows, y + 2)):
                    for m in range(max(0, x - 1), min(columns, x + 2)):
                        if smooth[k, m] > smooth[to_y, to_x]:
                            to_y, to_x = k, m
                if to_y == y and to_x == x:
                    break
                y, x = to_y, to_x
            if number[y, x] == 0:
                count += 1
                number[y, x] = count
            labels[i, j] = number[y, x]
    return count
