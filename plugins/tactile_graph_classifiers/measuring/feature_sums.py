"""The kernel of `features`: every sum over image and footprint that they need, in one pass."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from tactile_graph.compiled import compiled_twin_of

Sums = tuple[
    float, float, float, float, float, float, float, float, float, float, float, float, float,
    float, float, float, float,
]  # fmt: skip


def _sums_plain(
    values: NDArray[np.float64], on: NDArray[np.bool_], good: NDArray[np.bool_]
) -> Sums:
    """Return the sums the features are made of; positions count cells from 0.

    Parameters
    ----------
    values : ndarray of float64, shape (rows, columns)
    on : ndarray of bool, shape (rows, columns)
        The footprint.
    good : ndarray of bool, shape (rows, columns)
        Its valid cells.

    Returns
    -------
    tuple of float
        Cells, mean x, mean y, variances of x and y, their covariance; valid cells, load, mean
        square about the mean load, peak, load centre x and y (of readings above 0); changes along
        rows, columns, falling and rising diagonals; holes.
    """
    y, x = np.nonzero(on)
    n = float(x.size)
    if n == 0.0:
        return (0.0,) * 17
    mean_x, mean_y = float(x.mean()), float(y.mean())
    dx, dy = x - mean_x, y - mean_y
    load = values[good]
    m = float(load.size)
    with np.errstate(invalid="ignore", over="ignore"):  # NaN and infinity show in the sums
        total = float(load.sum())
        square = float(((load - total / m) ** 2).mean()) if m else 0.0
        pressed = np.maximum(load, 0.0)
        positive = float(pressed.sum())
    v, u = np.nonzero(good)
    load_x, load_y = mean_x, mean_y
    if 0.0 < positive < np.inf:
        load_x, load_y = float(u @ pressed) / positive, float(v @ pressed) / positive
    p = np.pad(on, 1)
    changes = [
        float(np.count_nonzero(a != b))
        for a, b in (
            (p[:, 1:], p[:, :-1]),
            (p[1:], p[:-1]),
            (p[1:, 1:], p[:-1, :-1]),
            (p[1:, :-1], p[:-1, 1:]),
        )
    ]
    holes = float(_parts(~p) - 1)
    return (
        n, mean_x, mean_y, float(dx @ dx) / n, float(dy @ dy) / n, float(dx @ dy) / n,
        m, total, square, float(load.max()) if m else 0.0, load_x, load_y,
        changes[0], changes[1], changes[2], changes[3], holes,
    )  # fmt: skip


def _parts(on: NDArray[np.bool_]) -> int:
    """Return into how many parts, joined by sides, the cells that are on fall."""
    parents: list[int] = []

    def root(run: int) -> int:
        while parents[run] != run:
            run = parents[run]
        return run

    count = 0
    above: list[tuple[int, int, int]] = []
    for row in on:
        ends = np.flatnonzero(np.diff(row.astype(np.int8), prepend=0, append=0)).tolist()
        runs = []
        for first, after in zip(ends[::2], ends[1::2], strict=True):
            run = len(parents)
            parents.append(run)
            runs.append((first, after, run))
            count += 1
            for low, high, other in above:
                if low < after and first < high and root(other) != root(run):
                    parents[root(other)] = root(run)
                    count -= 1
        above = runs
    return count


@compiled_twin_of(_sums_plain)
def feature_sums(values: Any, on: Any, good: Any) -> Any:
    """Return the sums the features are made of."""
    rows, columns = on.shape
    n = m = sum_x = sum_y = total = positive = load_x = load_y = 0.0
    peak = 0.0
    along_row = along_column = falling = rising = 0.0
    for i in range(rows):
        for j in range(columns):
            here = on[i, j]
            along_row += here != (on[i, j - 1] if j > 0 else False)
            along_column += here != (on[i - 1, j] if i > 0 else False)
            falling += here != (on[i - 1, j - 1] if i > 0 and j > 0 else False)
            rising += here != (on[i - 1, j + 1] if i > 0 and j < columns - 1 else False)
            if here:
                along_row += j == columns - 1
                along_column += i == rows - 1
                # a diagonal leaves the pad through either of two sides
                falling += i == rows - 1 or j == columns - 1
                rising += i == rows - 1 or j == 0
                n += 1.0
                sum_x += j
                sum_y += i
                if good[i, j]:
                    value = values[i, j]
                    peak = value if m == 0.0 else max(peak, value)
                    m += 1.0
                    total += value
                    if value > 0.0:
                        positive += value
                        load_x += j * value
                        load_y += i * value
    if n == 0.0:
        return (0.0,) * 17
    mean_x, mean_y = sum_x / n, sum_y / n
    mean = total / m if m > 0.0 else 0.0
    if positive > 0.0:
        load_x, load_y = load_x / positive, load_y / positive
    else:
        load_x, load_y = mean_x, mean_y
    xx = yy = xy = square = 0.0
    for i in range(rows):
        for j in range(columns):
            if on[i, j]:
                dx, dy = j - mean_x, i - mean_y
                xx += dx * dx
                yy += dy * dy
                xy += dx * dy
                if good[i, j]:
                    square += (values[i, j] - mean) ** 2
    # Holes: parts of the background, joined by sides, that the flood from outside leaves dry.
    wide = columns + 2
    dry = np.ones((rows + 2) * wide, np.bool_)
    for i in range(rows):
        for j in range(columns):
            if on[i, j]:
                dry[(i + 1) * wide + j + 1] = False
    stack = np.empty(dry.size, np.int64)
    parts = 0.0
    for start in range(dry.size):
        if not dry[start]:
            continue
        parts += 1.0
        dry[start] = False
        stack[0] = start
        waiting = 1
        while waiting > 0:
            waiting -= 1
            at = stack[waiting]
            column = at % wide
            for k in range(4):
                if k == 0 and column > 0:
                    to = at - 1
                elif k == 1 and column < wide - 1:
                    to = at + 1
                elif k == 2:
                    to = at - wide
                elif k == 3:
                    to = at + wide
                else:
                    continue
                if 0 <= to < dry.size and dry[to]:
                    dry[to] = False
                    stack[waiting] = to
                    waiting += 1
    return (
        n, mean_x, mean_y, xx / n, yy / n, xy / n,
        m, total, square / m if m > 0.0 else 0.0, peak, load_x, load_y,
        along_row, along_column, falling, rising, parts - 1.0,
    )  # fmt: skip
