"""The hull of cells, from centre to centre: of the first and the last of each row."""

from __future__ import annotations

import numpy as np

from tactile_graph.compiled import compiled_later
from tactile_graph_filters.parting.partition import Reals


@compiled_later
def with_row(x: Reals, y: Reals, ends: int, left: int, right: int, row: int) -> int:
    """Write a row's first and last cell behind the ``ends`` there are; return how many are now."""
    x[ends], y[ends] = left, row
    ends += 1
    if right > left:
        x[ends], y[ends] = right, row
        ends += 1
    return ends


@compiled_later
def area_of(hull_x: Reals, hull_y: Reals, m: int) -> float:
    """Return the area within a closed hull of so many points."""
    area = 0.0
    for k in range(m - 1):
        area += 0.5 * (hull_x[k] * hull_y[k + 1] - hull_x[k + 1] * hull_y[k])
    return abs(area)


@compiled_later
def hull_of(x: Reals, y: Reals, ends: int) -> tuple[Reals, Reals, int]:
    """Return the closed hull of the first and last cell of each row, and its number of points.

    ``x`` and ``y`` hold columns and rows of the ``ends``, row by row, from left to right.
    """
    hull_x, hull_y = np.empty(2 * ends + 2), np.empty(2 * ends + 2)
    m, floor = 0, 2
    for step in range(2 * ends - 1):
        k = step if step < ends else 2 * ends - 2 - step
        if step == ends:
            floor = m + 1
        while m >= floor and (hull_x[m - 1] - hull_x[m - 2]) * (y[k] - hull_y[m - 2]) <= (
            hull_y[m - 1] - hull_y[m - 2]
        ) * (x[k] - hull_x[m - 2]):
            m -= 1
        hull_x[m], hull_y[m] = x[k], y[k]
        m += 1
    return hull_x, hull_y, m
