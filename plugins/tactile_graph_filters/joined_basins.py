"""The kernel that joins the basins of a footprint into objects that fill their hulls."""

from __future__ import annotations

from itertools import combinations

import numpy as np
from numpy.typing import NDArray

from tactile_graph.compiled import compiled_twin_of
from tactile_graph_filters.filled_hull import _misfit_plain, misfit

REACH_CELLS = 3
"""Groups whose boxes lie further apart are not joined."""
DIAGONAL = 0.5
"""What cells that touch at a corner count beside those that share an edge."""
GAIN = 1e-9
"""A smaller gain is rounding."""

Array = NDArray[np.float64]


def _joined_plain(
    owner: NDArray[np.int32], count: int, values: Array, known: NDArray[np.bool_],
    half: float, hold: float, voids: float, weak: float, usual_cells: float,
) -> float:  # fmt: skip
    """Join groups in ``owner`` while that lowers the energy; return the energy.

    The energy is the sum of the groups' misfits (see `misfit`) and ``hold`` for each pair of
    neighbouring cells in different groups, less where one of them holds less than ``half``.
    Best pair first; where no pair gains, the best chain of three groups that touch.

    Parameters
    ----------
    owner : ndarray of int32, shape (rows, columns)
        Group of each cell, from 1 to ``count``; changed in place.
    count : int
    values, known : ndarray, shape (rows, columns)
        See `misfit`.
    half : float
        Reading from which on a cell counts fully at a cut.
    hold, voids, weak, usual_cells : float
        See `split_contacts` and `misfit`.

    Returns
    -------
    float
    """

    def cost(*groups: int) -> float:
        mine = np.isin(owner, groups)
        some = mine.any(axis=1)
        left = np.where(some, mine.argmax(axis=1), 0)
        right = np.where(some, mine.shape[1] - 1 - mine[:, ::-1].argmax(axis=1), -1)
        named = np.array((groups * 3)[:3], np.int32)
        return _misfit_plain(owner, values, known, named, left, right, voids, weak, usual_cells)

    alive = list(range(1, count + 1))
    cuts = _cuts_plain(owner, count, values, half)
    costs = {a: cost(a) for a in alive}
    unions: dict[tuple[int, ...], float] = {}

    def gain(*groups: int) -> float:
        if groups not in unions:
            unions[groups] = cost(*groups)
        cut = sum(cuts[a, b] for a, b in combinations(groups, 2))
        return float(hold * cut + sum(costs[a] for a in groups) - unions[groups])

    while True:
        pairs = [p for p in combinations(alive, 2) if _are_near(owner, *p)]
        best = _best([(gain(*p), p) for p in pairs])
        if not best:
            threes = [
                (a, b, c)
                for b in alive
                for a, c in combinations(alive, 2)
                if b not in (a, c) and cuts[a, b] > 0 and cuts[b, c] > 0
            ]
            best = _best([(gain(*t), t) for t in threes])
        if not best:
            break
        costs[best[0]] = unions[best]
        for other in best[1:]:
            owner[owner == other] = best[0]
            cuts[best[0]] += cuts[other]
            cuts[:, best[0]] = cuts[best[0]]
            alive.remove(other)
        unions = {k: v for k, v in unions.items() if not {*k} & {*best}}
    rest = sum(cuts[a, b] for a, b in combinations(alive, 2))
    return float(sum(costs[a] for a in alive) + hold * rest)


def _best(gains: list[tuple[float, tuple[int, ...]]]) -> tuple[int, ...]:
    """Return the first groups of the largest gain above rounding; none: ()."""
    best, found = GAIN, ()
    for gain, groups in gains:
        if gain > best + GAIN:
            best, found = gain, groups  # type: ignore[assignment]
    return found


def _are_near(owner: NDArray[np.int32], a: int, b: int) -> bool:
    (i, j), (k, m) = np.nonzero(owner == a), np.nonzero(owner == b)
    apart = max(i.min(), k.min()) - min(i.max(), k.max())
    aside = max(j.min(), m.min()) - min(j.max(), m.max())
    return bool(max(apart, aside) <= REACH_CELLS)


def _cuts_plain(owner: NDArray[np.int32], count: int, values: Array, half: float) -> Array:
    """Return how much of neighbouring cells each two groups share, shape (count + 1,) * 2."""
    cuts = np.zeros((count + 1, count + 1))
    rows, columns = owner.shape
    for down, right, weight in ((0, 1, 1.0), (1, 0, 1.0), (1, 1, DIAGONAL), (1, -1, DIAGONAL)):
        here = np.s_[: rows - down, max(0, -right) : columns - max(0, right)]
        there = np.s_[down:, max(0, right) : columns + min(0, right)]
        a, b = owner[here], owner[there]
        meet = (a > 0) & (b > 0) & (a != b)
        lower = np.minimum(values[here], values[there])[meet]
        share = weight * (np.minimum(1.0, lower / half) if half > 0 else np.ones(lower.shape))
        np.add.at(cuts, (a[meet], b[meet]), share)
        np.add.at(cuts, (b[meet], a[meet]), share)
    return cuts


@compiled_twin_of(_joined_plain)
def joined(owner, count, values, known, half, hold, voids, weak, usual_cells):  # type: ignore[no-untyped-def]
    """Join groups in ``owner`` while that lowers the energy; return the energy."""
    rows, columns = owner.shape
    size = count + 1
    left = np.full((size, rows), columns, np.int64)
    right = np.full((size, rows), -1, np.int64)
    cuts = np.zeros((size, size))
    box = np.empty((size, 4), np.int64)
    box[:, 0], box[:, 1], box[:, 2], box[:, 3] = rows, -1, columns, -1
    for i in range(rows):
        for j in range(columns):
            a = owner[i, j]
            if a == 0:
                continue
            left[a, i], right[a, i] = min(left[a, i], j), max(right[a, i], j)
            box[a, 0], box[a, 1] = min(box[a, 0], i), max(box[a, 1], i)
            box[a, 2], box[a, 3] = min(box[a, 2], j), max(box[a, 3], j)
            for way in range(4):
                y, x = (i, j + 1) if way == 0 else (i + 1, j + 2 - way)
                if y >= rows or x < 0 or x >= columns:
                    continue
                b = owner[y, x]
                if b > 0 and b != a:
                    lower = min(values[i, j], values[y, x])
                    share = min(1.0, lower / half) if half > 0 else 1.0
                    share *= 1.0 if way == 0 or way == 2 else DIAGONAL  # noqa: PLR1714
                    cuts[a, b] += share
                    cuts[b, a] += share
    alive = np.ones(size, np.bool_)
    group = np.empty(3, np.int32)
    low, high = np.empty(rows, np.int64), np.empty(rows, np.int64)
    cost = np.zeros(size)
    union = np.full((size, size), np.nan)
    for a in range(1, size):
        group[:] = a
        cost[a] = misfit(
            owner, values, known, group, left[a], right[a], voids, weak, usual_cells
        )
    while True:
        best, one, two, three = GAIN, 0, 0, 0
        for a in range(1, size):
            if not alive[a]:
                continue
            for b in range(a + 1, size):
                if not alive[b]:
                    continue
                apart = max(box[a, 0], box[b, 0]) - min(box[a, 1], box[b, 1])
                aside = max(box[a, 2], box[b, 2]) - min(box[a, 3], box[b, 3])
                if max(apart, aside) > REACH_CELLS:
                    continue
                if np.isnan(union[a, b]):
                    group[0], group[1], group[2] = a, b, a
                    for i in range(rows):
                        low[i] = min(left[a, i], left[b, i])
                        high[i] = max(right[a, i], right[b, i])
                    union[a, b] = misfit(
                        owner, values, known, group, low, high, voids, weak, usual_cells
                    )
                gain = hold * cuts[a, b] + cost[a] + cost[b] - union[a, b]
                if gain > best + GAIN:
                    best, one, two = gain, a, b
        if one == 0:
            for b in range(1, size):
                if not alive[b]:
                    continue
                for a in range(1, size):
                    if not alive[a] or a == b or cuts[a, b] <= 0:
                        continue
                    for c in range(a + 1, size):
                        if not alive[c] or c == b or cuts[b, c] <= 0:
                            continue
                        group[0], group[1], group[2] = a, b, c
                        for i in range(rows):
                            low[i] = min(left[a, i], left[b, i], left[c, i])
                            high[i] = max(right[a, i], right[b, i], right[c, i])
                        gain = hold * (cuts[a, b] + cuts[a, c] + cuts[b, c])
                        gain += cost[a] + cost[b] + cost[c] - misfit(
                            owner, values, known, group, low, high, voids, weak, usual_cells
                        )
                        if gain > best + GAIN:
                            best, one, two, three = gain, a, b, c
        if one == 0:
            break
        for other in (two, three):
            if other == 0:
                continue
            for i in range(box[other, 0], box[other, 1] + 1):
                for j in range(box[other, 2], box[other, 3] + 1):
                    if owner[i, j] == other:
                        owner[i, j] = one
            for i in range(rows):
                left[one, i] = min(left[one, i], left[other, i])
                right[one, i] = max(right[one, i], right[other, i])
            box[one, 0], box[one, 1] = min(box[one, 0], box[other, 0]), max(box[one, 1], box[other, 1])
            box[one, 2], box[one, 3] = min(box[one, 2], box[other, 2]), max(box[one, 3], box[other, 3])
            for k in range(size):
                cuts[one, k] += cuts[other, k]
                cuts[k, one] = cuts[one, k]
            alive[other] = False
        for k in range(size):
            union[one, k] = union[k, one] = np.nan
        group[:] = one
        cost[one] = misfit(
            owner, values, known, group, left[one], right[one], voids, weak, usual_cells
        )
    energy = 0.0
    for a in range(1, size):
        if alive[a]:
            energy += cost[a]
            for b in range(a + 1, size):
                if alive[b]:
                    energy += hold * cuts[a, b]
    return energy
