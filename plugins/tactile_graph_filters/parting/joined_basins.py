"""The kernel that joins the basins of a footprint into objects that fill their hulls."""

from __future__ import annotations

from itertools import combinations

import numpy as np
from numpy.typing import NDArray

from tactile_graph.compiled import compiled_twin_of
from tactile_graph_filters.parting.basin_groups import (
    DIAGONAL,
    GAIN,
    REACH_CELLS,
    assess,
    best_pair,
    best_three,
    energy_of,
    join,
    surveyed,
)
from tactile_graph_filters.parting.filled_hull import _misfit_plain
from tactile_graph_filters.parting.partition import Partition

Array = NDArray[np.float64]


def _joined_plain(
    owner: NDArray[np.int32], count: int, values: Array, known: NDArray[np.bool_], rules: Array
) -> float:
    """Join groups in ``owner`` while that lowers the energy; return the energy.

    The energy is the sum of the groups' misfits (see `misfit`) and a price for each pair of
    neighbouring cells in different groups, lower where one of them holds little. Best pair
    first; where no pair gains, the best chain of three groups that touch.

    Parameters
    ----------
    owner : ndarray of int32, shape (rows, columns)
        Group of each cell, from 1 to ``count``; changed in place.
    count : int
    values, known : ndarray, shape (rows, columns)
        See `misfit`.
    rules : ndarray of float64, shape (5,)
        The three of `misfit`, the price of a pair, and the reading from which on it is full.

    Returns
    -------
    float
    """
    hold, half = rules[3:].tolist()
    alive = list(range(1, count + 1))
    cuts = _cuts_plain(owner, count, values, half)
    costs = {a: _cost_plain(owner, (a,), values, known, rules) for a in alive}
    unions: dict[tuple[int, ...], float] = {}
    boxes = _boxes(owner, count)

    def gain(*groups: int) -> float:
        if groups not in unions:
            unions[groups] = _cost_plain(owner, groups, values, known, rules)
        cut = sum(cuts[a, b] for a, b in combinations(groups, 2))
        return float(hold * cut + sum(costs[a] for a in groups) - unions[groups])

    while True:
        best = _best([(gain(*p), p) for p in _near(boxes, alive)])
        best = best or _best([(gain(*t), t) for t in _threes(alive, cuts)])
        if not best:
            break
        for other in best[1:]:
            owner[owner == other] = best[0]
            boxes[:, best[0]] = np.maximum(boxes[:, best[0]], boxes[:, other])
            cuts[best[0]] += cuts[other]
            cuts[:, best[0]] = cuts[best[0]]
            alive.remove(other)
        unions = {k: v for k, v in unions.items() if not {*k} & {*best}}
        costs[best[0]] = _cost_plain(owner, best[:1], values, known, rules)
    rest = sum(cuts[a, b] for a, b in combinations(alive, 2))
    return float(sum(costs[a] for a in alive) + hold * rest)


def _cost_plain(
    owner: NDArray[np.int32],
    groups: tuple[int, ...],
    values: Array,
    known: NDArray[np.bool_],
    rules: Array,
) -> float:
    mine = np.isin(owner, groups)
    some = mine.any(axis=1)
    left = np.where(some, mine.argmax(axis=1), 0)
    right = np.where(some, mine.shape[1] - 1 - mine[:, ::-1].argmax(axis=1), -1)
    named = np.array((groups * 3)[:3], np.int32)
    return _misfit_plain(owner, values, known, named, left, right, rules)


def _threes(alive: list[int], cuts: Array) -> list[tuple[int, ...]]:
    """Return the chains a-b-c of groups that touch, each once from either end."""
    return [
        (a, b, c)
        for b in alive
        for a, c in combinations(alive, 2)
        if b not in (a, c) and cuts[a, b] > 0 and cuts[b, c] > 0
    ]


def _best(gains: list[tuple[float, tuple[int, ...]]]) -> tuple[int, ...]:
    """Return the first groups of the largest gain above rounding; () where there are none."""
    best: float = GAIN
    found: tuple[int, ...] = ()
    for gain, groups in gains:
        if gain > best + GAIN:
            best, found = gain, groups
    return found


def _boxes(owner: NDArray[np.int32], count: int) -> NDArray[np.int64]:
    """Return the last row, last column, first row and first column of each group.

    Shape (4, count + 1); the first ones are negative, so that a union's box is the largest of each.
    """
    rows, columns = np.nonzero(owner)
    boxes = np.full((4, count + 1), -max(owner.shape))
    for box, at in zip(boxes, (rows, columns, -rows, -columns), strict=True):
        np.maximum.at(box, owner[rows, columns], at)
    return boxes


def _near(boxes: NDArray[np.int64], alive: list[int]) -> list[tuple[int, ...]]:
    """Return the pairs of groups whose boxes are within reach of each other, in order."""
    last, first = boxes[:2, alive], -boxes[2:, alive]
    apart = np.maximum(first[:, :, None], first[:, None]) - np.minimum(
        last[:, :, None], last[:, None]
    )
    pairs = np.argwhere(np.triu(apart.max(axis=0) <= REACH_CELLS, 1))
    return [(alive[a], alive[b]) for a, b in pairs.tolist()]


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
def joined(owner, count, values, known, rules):  # type: ignore[no-untyped-def]
    """Join groups in ``owner`` while that lowers the energy; return the energy."""
    cells = Partition(owner, values, known)
    groups = surveyed(owner, count, values, rules[4])
    for a in range(1, count + 1):
        assess(cells, groups, a, rules)
    while True:
        a, b = best_pair(cells, groups, rules)
        c = 0
        if a == 0:
            a, b, c = best_three(cells, groups, rules)
        if a == 0:
            return energy_of(groups, rules[3])
        join(owner, groups, a, b)
        if c > 0:
            join(owner, groups, a, c)
        assess(cells, groups, a, rules)
