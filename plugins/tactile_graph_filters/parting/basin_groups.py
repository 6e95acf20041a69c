"""What the compiled `joined` does step by step: tables of the groups, the best join, the join."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from tactile_graph.compiled import compiled_later
from tactile_graph_filters.parting.filled_hull import misfit
from tactile_graph_filters.parting.partition import Flags, Owners, Partition, Reals, Whole

REACH_CELLS = 3
"""Groups whose boxes lie further apart are not joined."""
DIAGONAL = 0.7
"""What cells that touch at a corner count beside those that share an edge."""
GAIN = 1e-9
"""A smaller gain is rounding."""


class Groups(NamedTuple):
    """What the search keeps of n groups, by their numbers from 1; changed as groups are joined.

    Parameters
    ----------
    left, right : ndarray of int64, shape (n + 1, rows)
        First and last column of each group's cells in each row; a ``right`` of -1: none there.
    box : ndarray of int64, shape (n + 1, 4)
        First and last row, first and last column of each.
    cuts : ndarray of float64, shape (n + 1, n + 1)
        How much of neighbouring cells each two share.
    alive : ndarray of bool, shape (n + 1,)
        False of a group that was joined to another.
    cost : ndarray of float64, shape (n + 1,)
        Misfit of each.
    union : ndarray of float64, shape (n + 1, n + 1)
        Misfit of each two as one; NaN where it was not asked for yet.
    """

    left: Whole
    right: Whole
    box: Whole
    cuts: Reals
    alive: Flags
    cost: Reals
    union: Reals


@compiled_later
def surveyed(owner: Owners, count: int, values: Reals, half: float) -> Groups:
    """Return where the groups lie and what they share; their misfits are not known yet."""
    rows, columns = owner.shape
    left = np.full((count + 1, rows), columns, np.int64)
    right = np.full((count + 1, rows), -1, np.int64)
    box = np.empty((count + 1, 4), np.int64)
    box[:, 0], box[:, 1], box[:, 2], box[:, 3] = rows, -1, columns, -1
    cuts = np.zeros((count + 1, count + 1))
    for i in range(rows):
        for j in range(columns):
            a = owner[i, j]
            if a == 0:
                continue
            left[a, i], right[a, i] = min(left[a, i], j), max(right[a, i], j)
            box[a, 0], box[a, 1] = min(box[a, 0], i), max(box[a, 1], i)
            box[a, 2], box[a, 3] = min(box[a, 2], j), max(box[a, 3], j)
            for k, m, weight in ((i, j + 1, 1.0), (i + 1, j, 1.0), (i + 1, j + 1, DIAGONAL),
                                 (i + 1, j - 1, DIAGONAL)):  # fmt: skip
                if k < rows and 0 <= m < columns and owner[k, m] > 0 and owner[k, m] != a:
                    lower = min(values[i, j], values[k, m])
                    share = weight * (min(1.0, lower / half) if half > 0 else 1.0)
                    cuts[a, owner[k, m]] += share
                    cuts[owner[k, m], a] += share
    alive, cost = np.ones(count + 1, np.bool_), np.zeros(count + 1)
    return Groups(left, right, box, cuts, alive, cost, np.full((count + 1, count + 1), np.nan))


@compiled_later
def united(cells: Partition, groups: Groups, three: Owners, rules: Reals) -> float:
    """Return the misfit of three groups as one."""
    rows = cells.owner.shape[0]
    low, high = np.empty(rows, np.int64), np.empty(rows, np.int64)
    a, b, c = three[0], three[1], three[2]
    left, right = groups.left, groups.right
    for i in range(rows):
        low[i] = min(left[a, i], left[b, i], left[c, i])
        high[i] = max(right[a, i], right[b, i], right[c, i])
    return misfit(cells.owner, cells.values, cells.known, three, low, high, rules)


@compiled_later
def best_pair(cells: Partition, groups: Groups, rules: Reals) -> tuple[int, int]:
    """Return the two groups to join first, (0, 0) where no two gain; fill in their unions."""
    box, cost, union = groups.box, groups.cost, groups.union
    best, one, two = GAIN, 0, 0
    three = np.empty(3, np.int32)
    for a in range(1, len(cost)):
        for b in range(a + 1, len(cost)):
            if not (groups.alive[a] and groups.alive[b]):
                continue
            apart = max(box[a, 0], box[b, 0]) - min(box[a, 1], box[b, 1])
            aside = max(box[a, 2], box[b, 2]) - min(box[a, 3], box[b, 3])
            if max(apart, aside) > REACH_CELLS:
                continue
            if np.isnan(union[a, b]):
                three[0], three[1], three[2] = a, b, a
                union[a, b] = united(cells, groups, three, rules)
            gain = rules[3] * groups.cuts[a, b] + (cost[a] + cost[b]) - union[a, b]
            if gain > best + GAIN:
                best, one, two = gain, a, b
    return one, two


@compiled_later
def best_three(cells: Partition, groups: Groups, rules: Reals) -> tuple[int, int, int]:
    """Return the chain of three groups to join first, zeros where none gains."""
    alive, cuts, cost = groups.alive, groups.cuts, groups.cost
    best, one, two, last = GAIN, 0, 0, 0
    three = np.empty(3, np.int32)
    for b in range(1, len(cost)):
        if not alive[b]:
            continue
        for a in range(1, len(cost)):
            if not alive[a] or a == b or cuts[a, b] <= 0:
                continue
            for c in range(a + 1, len(cost)):
                if not alive[c] or c == b or cuts[b, c] <= 0:
                    continue
                three[0], three[1], three[2] = a, b, c
                gain = rules[3] * (cuts[a, b] + cuts[a, c] + cuts[b, c])
                gain += cost[a] + cost[b] + cost[c]
                gain -= united(cells, groups, three, rules)
                if gain > best + GAIN:
                    best, one, two, last = gain, a, b, c
    return one, two, last


@compiled_later
def join(owner: Owners, groups: Groups, one: int, other: int) -> None:
    """Give the cells of ``other`` to ``one``."""
    left, right, box, cuts = groups.left, groups.right, groups.box, groups.cuts
    for i in range(box[other, 0], box[other, 1] + 1):
        for j in range(box[other, 2], box[other, 3] + 1):
            if owner[i, j] == other:
                owner[i, j] = one
    for i in range(owner.shape[0]):
        left[one, i] = min(left[one, i], left[other, i])
        right[one, i] = max(right[one, i], right[other, i])
    for k in range(4):
        better = min(box[one, k], box[other, k]) if k % 2 == 0 else max(box[one, k], box[other, k])
        box[one, k] = better
    for k in range(cuts.shape[0]):
        cuts[one, k] += cuts[other, k]
        cuts[k, one] = cuts[one, k]
    groups.alive[other] = False
    groups.union[one, :] = np.nan
    groups.union[:, one] = np.nan


@compiled_later
def assess(cells: Partition, groups: Groups, one: int, rules: Reals) -> None:
    """Write down the misfit of a group."""
    alone = np.full(3, one, np.int32)
    groups.cost[one] = misfit(
        cells.owner, cells.values, cells.known, alone, groups.left[one], groups.right[one], rules
    )


@compiled_later
def energy_of(groups: Groups, hold: float) -> float:
    """Return the misfits of the groups left and the price of the cuts between them."""
    alive, cuts, cost = groups.alive, groups.cuts, groups.cost
    energy = 0.0
    for a in range(1, len(cost)):
        if alive[a]:
            energy += cost[a]
            for b in range(a + 1, len(cost)):
                if alive[b]:
                    energy += hold * cuts[a, b]
    return energy
