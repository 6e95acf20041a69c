"""The kernel that says how badly a set of cells fills its own convex hull."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from tactile_graph.compiled import compiled_twin_of
from tactile_graph_filters.parting.row_hull import hull_of, with_row

RIM_CELLS = 0.4
"""Cells whose centre lies less deep in the hull are its rim: low readings are no surprise there."""
OFF_ON_RIM, WEAK, FOREIGN = 1.2, 2.0, 3.0
"""What a cell costs: off on the rim (1 further in), without any load further in, or another's.

A void at the edge of an object does not show, the hull ends before it: a cell that is off on the
rim is a notch, and notches are what two objects make.
"""
DOUBT = 10.0
"""What an object of no cells costs beside one of the usual number."""


def _misfit_plain(
    owner: NDArray[np.int32],
    values: NDArray[np.float64],
    known: NDArray[np.bool_],
    group: NDArray[np.int32],
    left: NDArray[np.int64],
    right: NDArray[np.int64],
    rules: NDArray[np.float64],
) -> float:
    """Return the misfit of the cells of up to three groups, taken as one convex object.

    Parameters
    ----------
    owner : ndarray of int32, shape (rows, columns)
        Group of each cell, 0 where the cell is off.
    values : ndarray of float64, shape (rows, columns)
        Readings, 0 where the cell is off.
    known : ndarray of bool, shape (rows, columns)
        False in cells that cannot be told to be off.
    group : ndarray of int32, shape (3,)
        The groups; one or two may be named twice.
    left, right : ndarray of int64, shape (rows,)
        First and last column of the groups' cells in each row; a ``right`` of -1: none there.
    rules : ndarray of float64, shape (5,)
        Of these the first three: misfit that a cell inside is expected to have, and is forgiven;
        share of the groups' mean reading below which a cell inside counts as weak; number of
        cells from which on an object is not doubted for its size.

    Returns
    -------
    float
    """
    voids, weak, usual_cells = rules[:3].tolist()
    mine = np.isin(owner, group)
    n = int(np.count_nonzero(mine))
    misfit = DOUBT * max(0.0, 1.0 - n / usual_cells) if usual_cells > 0 else 0.0
    if n < 3:
        return misfit
    corners = _hull_plain(left, right)
    top, bottom = int(corners[:, 1].min()), int(corners[:, 1].max()) + 1
    start, end = int(corners[:, 0].min()), int(corners[:, 0].max()) + 1
    box = np.s_[top:bottom, start:end]
    mine, here, held, sure = mine[box], values[box], owner[box], known[box]
    y, x = np.mgrid[top:bottom, start:end].astype(np.float64)
    depth = np.full(mine.shape, np.inf)
    for (x0, y0), (x1, y1) in zip(corners, np.roll(corners, -1, axis=0), strict=True):
        dx, dy = x1 - x0, y1 - y0
        depth = np.minimum(depth, (dx * (y - y0) - dy * (x - x0)) / np.sqrt(dx * dx + dy * dy))
    within, deep = depth >= -1e-9, depth >= RIM_CELLS
    limit = weak * float(values[np.isin(owner, group)].sum()) / n
    misfit -= voids * np.count_nonzero(deep & sure)
    misfit += FOREIGN * np.count_nonzero(within & ~mine & (held > 0))
    off = within & ~mine & (held == 0) & sure
    misfit += np.count_nonzero(off & deep) + OFF_ON_RIM * np.count_nonzero(off & ~deep)
    slack = here[mine & deep & (here < limit)]
    return float(misfit + WEAK * (1.0 - slack / limit).sum()) if slack.size else float(misfit)


def _hull_plain(left: NDArray[np.int64], right: NDArray[np.int64]) -> NDArray[np.float64]:
    """Return the corners (column, row) of the hull of rows' ends, clockwise as drawn y down."""
    ends = [(int(c), i) for i in range(len(left)) if right[i] >= 0 for c in (left[i], right[i])]
    chains: list[list[tuple[int, int]]] = []
    for points in (ends, ends[::-1]):
        chain: list[tuple[int, int]] = []
        for x, y in points:
            while len(chain) > 1 and (chain[-1][0] - chain[-2][0]) * (y - chain[-2][1]) <= (
                chain[-1][1] - chain[-2][1]
            ) * (x - chain[-2][0]):
                chain.pop()
            if not chain or chain[-1] != (x, y):
                chain.append((x, y))
        chains.append(chain)
    return np.array(chains[0][:-1] + chains[1][:-1], np.float64)


@compiled_twin_of(_misfit_plain)
def misfit(owner, values, known, group, left, right, rules):  # type: ignore[no-untyped-def]
    """Return the misfit of the cells of up to three groups, taken as one convex object."""
    voids, weak, usual_cells = rules[0], rules[1], rules[2]
    rows = owner.shape[0]
    x, y = np.empty(2 * rows), np.empty(2 * rows)
    ends = n = 0
    total = 0.0
    top, bottom, start, end = rows, -1, owner.shape[1], -1
    for i in range(rows):
        if right[i] < 0:
            continue
        top, bottom = min(top, i), i
        start, end = min(start, left[i]), max(end, right[i])
        ends = with_row(x, y, ends, left[i], right[i], i)
        for j in range(left[i], right[i] + 1):
            held = owner[i, j]
            if held == group[0] or held == group[1] or held == group[2]:
                n += 1
                total += values[i, j]
    result = DOUBT * max(0.0, 1.0 - n / usual_cells) if usual_cells > 0 else 0.0
    if n < 3:
        return result
    hx, hy, m = hull_of(x, y, ends)
    limit = weak * total / n
    for i in range(top, bottom + 1):
        for j in range(start, end + 1):
            depth = np.inf
            for k in range(m - 1):
                dx, dy = hx[k + 1] - hx[k], hy[k + 1] - hy[k]
                off_edge = (dx * (i - hy[k]) - dy * (j - hx[k])) / np.sqrt(dx * dx + dy * dy)
                depth = min(depth, off_edge)
            if depth < -1e-9:
                continue
            deep = depth >= RIM_CELLS
            if deep and known[i, j]:
                result -= voids
            held = owner[i, j]
            if held == group[0] or held == group[1] or held == group[2]:
                if deep and values[i, j] < limit:
                    result += WEAK * (1.0 - values[i, j] / limit)
            elif held > 0:
                result += FOREIGN
            elif known[i, j]:
                result += 1.0 if deep else OFF_ON_RIM
    return result
