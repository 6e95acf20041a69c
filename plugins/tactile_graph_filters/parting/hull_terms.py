"""What a set of cells and its hull come to, for the choice between one object and two."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from tactile_graph.compiled import compiled_later
from tactile_graph_filters.parting.filled_hull import RIM_CELLS
from tactile_graph_filters.parting.partition import Owners, Partition, Reals
from tactile_graph_filters.parting.row_hull import area_of, hull_of, with_row

CELLS, LOGS, AREA, NOTCHES, WEAK, LONG = 0, 1, 2, 3, 4, 5
"""Places in the terms; see `hull_terms`."""
TERMS = 6
FLOOR = 2e-3
"""Readings below this share of the weak one count as it, where logarithms are taken."""


class Levels(NamedTuple):
    """Which readings are low, and how low they count.

    Parameters
    ----------
    weak : float
        Share of the mean reading below which a cell deep inside counts as partly void.
    full : float
        Reading from which on a pair of cells in contact counts fully.
    floor : float
        Least reading whose logarithm is taken, > 0.
    """

    weak: float
    full: float
    floor: float


@compiled_later
def hull_terms(cells: Partition, one: int, two: int, levels: Levels) -> Reals:
    """Return the terms of the cells that ``one`` or ``two`` owns, taken together, shape (6,).

    They are: number of cells; sum of the logarithms of their readings; area of their hull in
    cells, from centre to centre; cells that are off on the hull's rim; what cells deep inside
    lack; half the logarithm of the ratio of the axes of their second moments. The last four are
    0 for fewer than three cells. ``one`` and ``two`` may be the same.
    """
    owner, values, known = cells.owner, cells.values, cells.known
    rows, columns = owner.shape
    terms = np.zeros(TERMS)
    x, y = np.empty(2 * rows), np.empty(2 * rows)
    ends = 0
    total = sum_x = sum_y = sum_xx = sum_xy = sum_yy = 0.0
    for i in range(rows):
        left, right = columns, -1
        for j in range(columns):
            if owner[i, j] == one or owner[i, j] == two:
                left, right = min(left, j), j
                terms[CELLS] += 1.0
                terms[LOGS] += np.log(max(values[i, j], levels.floor))
                total += values[i, j]
                sum_x, sum_y = sum_x + j, sum_y + i
                sum_xx, sum_xy, sum_yy = sum_xx + j * j, sum_xy + i * j, sum_yy + i * i
        if right >= 0:
            ends = with_row(x, y, ends, left, right, i)
    n = terms[CELLS]
    if n < 3:
        return terms
    # A cell spreads over its own width: 1/12 each way.
    xx, yy = sum_xx / n - (sum_x / n) ** 2 + 1 / 12, sum_yy / n - (sum_y / n) ** 2 + 1 / 12
    xy = sum_xy / n - sum_x * sum_y / n**2
    half, root = 0.5 * (xx + yy), np.sqrt(0.25 * (xx - yy) ** 2 + xy * xy)
    terms[LONG] = 0.5 * np.log((half + root) / max(half - root, 1e-6))
    hull_x, hull_y, m = hull_of(x, y, ends)
    terms[AREA] = area_of(hull_x, hull_y, m)
    limit = levels.weak * total / n
    for i in range(rows):
        for j in range(columns):
            mine = owner[i, j] == one or owner[i, j] == two
            if mine:
                if values[i, j] >= limit:
                    continue
            elif owner[i, j] > 0 or not known[i, j]:
                continue
            depth = np.inf
            for k in range(m - 1):
                x0, y0 = hull_x[k], hull_y[k]
                dx, dy = hull_x[k + 1] - x0, hull_y[k + 1] - y0
                depth = min(depth, (dx * (i - y0) - dy * (j - x0)) / np.sqrt(dx * dx + dy * dy))
            if mine and depth >= RIM_CELLS:
                terms[WEAK] += 1.0 - values[i, j] / limit
            elif not mine and -1e-9 <= depth < RIM_CELLS:
                terms[NOTCHES] += 1.0
    return terms


@compiled_later
def hull_area(owner: Owners, group: int) -> float:
    """Return the area of the hull of a group's cells alone, as `hull_terms` does."""
    rows, columns = owner.shape
    x, y = np.empty(2 * rows), np.empty(2 * rows)
    ends = n = 0
    for i in range(rows):
        left, right = columns, -1
        for j in range(columns):
            if owner[i, j] == group:
                left, right = min(left, j), j
                n += 1
        if right >= 0:
            ends = with_row(x, y, ends, left, right, i)
    if n < 3:
        return 0.0
    hull_x, hull_y, m = hull_of(x, y, ends)
    return area_of(hull_x, hull_y, m)
