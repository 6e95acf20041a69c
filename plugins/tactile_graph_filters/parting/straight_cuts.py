"""The kernel that joins groups of one object and cuts groups of two along straight lines."""

from __future__ import annotations

import math

import numpy as np

from tactile_graph.compiled import compiled_later
from tactile_graph_filters.parting.hull_terms import CELLS, FLOOR, Levels, hull_terms
from tactile_graph_filters.parting.partition import Owners, Partition, cut_out
from tactile_graph_filters.parting.two_or_one import log_odds, most_odds

LEAST_CELLS = 3
"""No cut leaves fewer."""
REACH_CELLS = 2
"""Groups whose boxes lie further apart are not joined."""
STEP_CELLS = 0.5
"""From one cut to the next."""
COSINES = np.cos(np.arange(8) * math.pi / 8.0)
SINES = np.sin(np.arange(8) * math.pi / 8.0)


@compiled_later
def joined_and_cut(
    cells: Partition, weak: float, full: float, cut_above: float, join_below: float
) -> None:
    """Join the groups that are one object, then cut those that are two; in place.

    Two convex objects that do not overlap can always be parted by a straight line: lines in
    eight directions are tried, and pieces are cut again.

    A group is cut where the log odds of two objects are above ``cut_above``; two are joined where
    they are below ``join_below``. For ``weak`` and ``full`` see `Levels`.
    """
    owner = cells.owner
    levels = Levels(weak, full, FLOOR * full if full > 0 else 1.0)
    most = int(owner.max())
    while True:
        one, two = best_join(cells, most, levels, join_below)
        if one == 0:
            break
        for i in range(owner.shape[0]):
            for j in range(owner.shape[1]):
                if owner[i, j] == two:
                    owner[i, j] = one
    group = 1
    while group <= most:
        if cut_best(cells, group, most + 1, levels, cut_above):
            most += 1  # the piece that keeps its number is looked at again
        else:
            group += 1


@compiled_later
def best_join(cells: Partition, most: int, levels: Levels, below: float) -> tuple[int, int]:
    """Return the two groups that are least likely two objects, (0, 0) where all others are."""
    boxes = boxes_of(cells.owner, most)
    best, first, second = below, 0, 0
    for a in range(1, most + 1):
        for b in range(a + 1, most + 1):
            if boxes[a, 1] < 0 or boxes[b, 1] < 0:
                continue
            top, left = min(boxes[a, 0], boxes[b, 0]), min(boxes[a, 2], boxes[b, 2])
            bottom, right = max(boxes[a, 1], boxes[b, 1]), max(boxes[a, 3], boxes[b, 3])
            apart = max(boxes[a, 0], boxes[b, 0]) - min(boxes[a, 1], boxes[b, 1]) - 1
            aside = max(boxes[a, 2], boxes[b, 2]) - min(boxes[a, 3], boxes[b, 3]) - 1
            if max(apart, aside) > REACH_CELLS:
                continue
            part = cut_out(cells, top, bottom, left, right)
            odds = log_odds(part, a, b, levels, hull_terms(part, a, b, levels))
            if odds < best - 1e-9:
                best, first, second = odds, a, b
    return first, second


@compiled_later
def boxes_of(owner: Owners, most: int) -> Owners:
    """Return first and last row, first and last column of each group; last ones -1 for none."""
    boxes = np.full((most + 1, 4), -1, np.int32)
    boxes[:, 0], boxes[:, 2] = owner.shape
    for i in range(owner.shape[0]):
        for j in range(owner.shape[1]):
            box = boxes[owner[i, j]]
            box[0], box[1] = min(box[0], i), max(box[1], i)
            box[2], box[3] = min(box[2], j), max(box[3], j)
    return boxes


@compiled_later
def cut_best(cells: Partition, group: int, new: int, levels: Levels, above: float) -> bool:
    """Give one side of the likeliest cut of a group to ``new``; return whether any is likely."""
    top, bottom, left, right = boxes_of(cells.owner, new)[group]
    if bottom < 0:
        return False
    part = cut_out(cells, top, bottom, left, right)
    both = hull_terms(part, group, group, levels)
    if both[CELLS] < 2 * LEAST_CELLS:
        return False
    best, best_way, best_at = above, -1, 0.0
    for way in range(len(COSINES)):
        low, high = reach(part.owner, group, new, COSINES[way], SINES[way])
        at, before = low + 0.5 * STEP_CELLS, 0
        while at < high:
            moved = moved_over(part.owner, group, new, COSINES[way], SINES[way], at)
            if moved != before and LEAST_CELLS <= moved <= both[CELLS] - LEAST_CELLS:
                fewer = min(moved, int(both[CELLS]) - moved)
                if most_odds(part, new, group, levels, both, fewer) > best:
                    odds = log_odds(part, new, group, levels, both)
                    if odds > best + 1e-9:
                        best, best_way, best_at = odds, way, at
            at, before = at + STEP_CELLS, moved
    if best_way < 0:
        return False
    moved_over(part.owner, group, new, COSINES[best_way], SINES[best_way], best_at)
    cells.owner[top : bottom + 1, left : right + 1] = part.owner
    return True


@compiled_later
def reach(owner: Owners, group: int, new: int, cosine: float, sine: float) -> tuple[float, float]:
    """Return how far the cells of both numbers reach across a direction."""
    low, high = np.inf, -np.inf
    for i in range(owner.shape[0]):
        for j in range(owner.shape[1]):
            if owner[i, j] == group or owner[i, j] == new:
                across = cosine * j + sine * i
                low, high = min(low, across), max(high, across)
    return low, high


@compiled_later
def moved_over(owner: Owners, group: int, new: int, cosine: float, sine: float, at: float) -> int:
    """Number the cells on the near side of a line ``new``, the others ``group``; count the new."""
    moved = 0
    for i in range(owner.shape[0]):
        for j in range(owner.shape[1]):
            if owner[i, j] == group or owner[i, j] == new:
                if cosine * j + sine * i < at:
                    owner[i, j] = new
                    moved += 1
                else:
                    owner[i, j] = group
    return moved
