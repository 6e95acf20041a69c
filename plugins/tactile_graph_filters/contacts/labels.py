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

    Numbers go by the first cell of a component in reading order. Cells are taken in
    the order of the compiled twin.
    """
    width = on.shape[1] + 2  # with a rim, so that all neighbours of a cell are there
    rimmed = np.pad(on, 1).ravel()
    waits = rimmed.tolist()
    steps = [i * width + j for i in (-1, 0, 1) for j in (-1, 0, 1) if eight or i == 0 or j == 0]
    labels[...] = 0
    sums: list[list[Any]] = []
    for start in np.flatnonzero(rimmed).tolist():
        if not waits[start]:
            continue
        part, stack = [], [start]
        waits[start] = False
        while stack:
            at = stack.pop()
            part.append(at)
            near = [at + step for step in steps if waits[at + step]]
            stack += near
            for cell in near:
                waits[cell] = False
        y, x = np.divmod(np.array(part), width)
        labels[y - 1, x - 1] = len(sums) + 1
        sums.append(_sums(values, y - 1, x - 1))
    return np.array(sums, np.float64).reshape(-1, N_SUMS)


def _sums(values: NDArray[np.float64], y: NDArray[np.intp], x: NDArray[np.intp]) -> list[Any]:
    load = values[y, x]
    positive = np.where(load > 0, load, 0.0)
    with np.errstate(over="ignore", invalid="ignore"):  # found out by what comes out
        return [
            x.size, _sum(load), load.max(), x.sum(), y.sum(),
            _sum(positive), _sum(x * positive), _sum(y * positive),
            y.min(), y.max(), x.min(), x.max(),
        ]  # fmt: skip


def _sum(values: NDArray[Any]) -> float:
    """Return a sum in the order of the values: to the last bit that of the compiled twin."""
    return 0.0 + float(np.add.accumulate(values)[-1])


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
