"""The kernel of `contacts`: connected components and their sums in one pass."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from tactile_graph.compiled import compiled_twin_of

N_SUMS = 12
"""Columns of the table: cells, load, peak, sums of (x, y) of the cells, sum of the positive
readings and of x and y times these, then the box (first row, last row, first and last column).
x and y count cells from 0."""


def _label_plain(
    values: NDArray[np.float64], on: NDArray[np.bool_], eight: bool, labels: NDArray[np.int32]
) -> NDArray[np.float64]:
    """Write component numbers (from 1, 0 = off) into ``labels``; return a row of sums for each.

    Numbers go by the first cell of a component in reading order.
    """
    rows, columns = on.shape
    far = on.size
    first = np.where(on, np.arange(far).reshape(on.shape), far)  # of the component, as known so far
    steps = [(0, 1), (1, 0), (1, 1), (1, -1)] if eight else [(0, 1), (1, 0)]
    while True:
        padded = np.pad(first, 1, constant_values=far)
        lowest = first
        for i, j in [*steps, *((-i, -j) for i, j in steps)]:
            lowest = np.minimum(lowest, padded[1 + i : 1 + i + rows, 1 + j : 1 + j + columns])
        lowest = np.where(on, lowest, far)
        if np.array_equal(lowest, first):
            break
        first = lowest
    seen = np.unique(first[on])
    labels[...] = np.where(on, np.searchsorted(seen, first) + 1, 0)
    return np.array([_sums(values, labels == n + 1) for n in range(seen.size)], np.float64).reshape(
        -1, N_SUMS
    )


def _sums(values: NDArray[np.float64], part: NDArray[np.bool_]) -> list[Any]:
    y, x = np.nonzero(part)
    load = values[part]
    positive = np.where(load > 0, load, 0.0)
    with np.errstate(over="ignore", invalid="ignore"):  # found out by what comes out
        return [
            x.size, load.sum(), load.max(), x.sum(), y.sum(),
            positive.sum(), (x * positive).sum(), (y * positive).sum(),
            y.min(), y.max(), x.min(), x.max(),
        ]  # fmt: skip


@compiled_twin_of(_label_plain)
def label(values, on, eight, labels):  # type: ignore[no-untyped-def]
    """Write component numbers into ``labels``; return a row of sums for each."""
    rows, columns = on.shape
    for i in range(rows):
        for j in range(columns):
            labels[i, j] = 0
    stack = np.empty(rows * columns, np.int64)
    table = np.empty((rows * columns + 1) // 2 * N_SUMS, np.float64)
    count = 0
    for start in range(rows * columns):
        top, left = start // columns, start % columns
        if not on[top, left] or labels[top, left] != 0:
            continue
        peak = -np.inf
        n = load = sum_x = sum_y = pressed = moment_x = moment_y = 0.0
        bottom, right = top, left
        at = count * N_SUMS
        first_row = top
        count += 1
        labels[top, left] = count
        stack[0] = start
        waiting = 1
        while waiting > 0:
            waiting -= 1
            i, j = stack[waiting] // columns, stack[waiting] % columns
            value = values[i, j]
            positive = value if value > 0 else 0.0
            peak = max(peak, value)
            n += 1.0
            load += value
            sum_x += j
            sum_y += i
            pressed += positive
            moment_x += j * positive
            moment_y += i * positive
            bottom, left, right = max(bottom, i), min(left, j), max(right, j)
            for k in range(max(0, i - 1), min(rows, i + 2)):
                for m in range(max(0, j - 1), min(columns, j + 2)):
                    if (eight or k == i or m == j) and on[k, m] and labels[k, m] == 0:
                        labels[k, m] = count
                        stack[waiting] = k * columns + m
                        waiting += 1
        table[at], table[at + 1], table[at + 2] = n, load, peak
        table[at + 3], table[at + 4], table[at + 5] = sum_x, sum_y, pressed
        table[at + 6], table[at + 7] = moment_x, moment_y
        table[at + 8], table[at + 9] = first_row, bottom
        table[at + 10], table[at + 11] = left, right
    sums = np.empty((count, N_SUMS), np.float64)
    for at in range(count * N_SUMS):
        sums[at // N_SUMS, at % N_SUMS] = table[at]
    return sums
