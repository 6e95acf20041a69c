"""What the compiled `joined` does step by step: tables of the groups, the best join, the join."""

from __future__ import annotations

from typing import TypeAlias

import numpy as np
from numpy.typing import NDArray

from tactile_graph.compiled import compiled_later
from tactile_graph_filters.parting.filled_hull import misfit

REACH_CELLS = 3
"""Groups whose boxes lie further apart are not joined."""
DIAGONAL = 0.7
"""What cells that touch at a corner count beside those that share an edge."""
GAIN = 1e-9
"""A smaller gain is rounding."""

Reals: TypeAlias = NDArray[np.float64]
Whole: TypeAlias = NDArray[np.int64]
Owners: TypeAlias = NDArray[np.int32]
Flags: TypeAlias = NDArray[np.bool_]


@compiled_later
def surveyed(
    owner: Owners, count: int, values: Reals, half: float
) -> tuple[Whole, Whole, Whole, Reals]:
    """Return each group's first and last column in each row, its box, and what groups share."""
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
    return left, right, box, cuts


@compiled_later
def united(
    owner: Owners, values: Reals, known: Flags, group: Owners, left: Whole, right: Whole,
    rules: Reals,
) -> float:  # fmt: skip
    """Return the misfit of the three groups as one."""
    rows = owner.shape[0]
    low, high = np.empty(rows, np.int64), np.empty(rows, np.int64)
    a, b, c = group[0], group[1], group[2]
    for i in range(rows):
        low[i] = min(left[a, i], left[b, i], left[c, i])
        high[i] = max(right[a, i], right[b, i], right[c, i])
    return misfit(owner, values, known, group, low, high, rules)


@compiled_later
def best_pair(
    owner: Owners, values: Reals, known: Flags, left: Whole, right: Whole, box: Whole,
    cuts: Reals, alive: Flags, cost: Reals, union: Reals, rules: Reals,
) -> tuple[int, int]:  # fmt: skip
    """Return the two groups to join first, (0, 0) where no two gain; fill in ``union``."""
    best, one, two = GAIN, 0, 0
    group = np.empty(3, np.int32)
    for a in range(1, len(cost)):
        for b in range(a + 1, len(cost)):
            if not (alive[a] and alive[b]):
                continue
            apart = max(box[a, 0], box[b, 0]) - min(box[a, 1], box[b, 1])
            aside = max(box[a, 2], box[b, 2]) - min(box[a, 3], box[b, 3])
            if max(apart, aside) > REACH_CELLS:
                continue
            if np.isnan(union[a, b]):
                group[0], group[1], group[2] = a, b, a
                union[a, b] = united(owner, values, known, group, left, right, rules)
            gain = rules[3] * cuts[a, b] + (cost[a] + cost[b]) - union[a, b]
            if gain > best + GAIN:
                best, one, two = gain, a, b
    return one, two


@compiled_later
def best_three(
    owner: Owners, values: Reals, known: Flags, left: Whole, right: Whole,
    cuts: Reals, alive: Flags, cost: Reals, rules: Reals,
) -> tuple[int, int, int]:  # fmt: skip
    """Return the chain of three groups to join first, zeros where none gains."""
    best, one, two, three = GAIN, 0, 0, 0
    group = np.empty(3, np.int32)
    for b in range(1, len(cost)):
        if not alive[b]:
            continue
        for a in range(1, len(cost)):
            if not alive[a] or a == b or cuts[a, b] <= 0:
                continue
            for c in range(a + 1, len(cost)):
                if not alive[c] or c == b or cuts[b, c] <= 0:
                    continue
                group[0], group[1], group[2] = a, b, c
                gain = rules[3] * (cuts[a, b] + cuts[a, c] + cuts[b, c])
                gain += cost[a] + cost[b] + cost[c]
                gain -= united(owner, values, known, group, left, right, rules)
                if gain > best + GAIN:
                    best, one, two, three = gain, a, b, c
    return one, two, three


@compiled_later
def join(
    owner: Owners, one: int, other: int, left: Whole, right: Whole, box: Whole, cuts: Reals,
    alive: Flags,
) -> None:  # fmt: skip
    """Give the cells of ``other`` to ``one``."""
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
    alive[other] = False


@compiled_later
def energy_of(cuts: Reals, alive: Flags, cost: Reals, hold: float) -> float:
    """Return the misfits of the groups left and the price of the cuts between them."""
    energy = 0.0
    for a in range(1, len(cost)):
        if alive[a]:
            energy += cost[a]
            for b in range(a + 1, len(cost)):
                if alive[b]:
                    energy += hold * cuts[a, b]
    return energy
