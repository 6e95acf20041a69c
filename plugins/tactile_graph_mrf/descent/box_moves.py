"""A move for explicit lines: a cell's label together with the lines on its four sides."""

from __future__ import annotations

from typing import Any

import numpy as np

from tactile_graph.compiled import compiled_as_is
from tactile_graph_mrf.energy.potentials import Potentials
from tactile_graph_mrf.energy.state import State


@compiled_as_is
def set_sides(over: Any, left: Any, i: int, j: int, sites: int, code: int) -> None:
    """Turn the lines above (bit 1), below (2), left (4) and right (8) of a cell on or off.

    Only where there are ``sites``. ``over`` and ``left`` hold the line above each cell, and to
    its left, the rim's and one row and column more included.
    """
    if sites & 1:
        over[i, j] = code & 1 != 0
    if sites & 2:
        over[i + 1, j] = code & 2 != 0
    if sites & 4:
        left[i, j] = code & 4 != 0
    if sites & 8:
        left[i, j + 1] = code & 8 != 0


@compiled_as_is
def lines_around(
    pattern: Any, parallel: float, one: float, in_field: Any, over: Any, left: Any, i: int, j: int
) -> float:
    """Return the energy of all cliques of lines that hold a line around cell (i, j)."""
    rows, columns = in_field.shape
    cost = 0.0
    for on in (over[i, j], over[i + 1, j], left[i, j], left[i, j + 1]):
        if on:
            cost += one
    for k in range(-1, 2):
        # Lines side by side across this cell, and across the one before and after it.
        if 0 <= i + k < rows and over[i + k, j]:
            cost += parallel * over[i + k + 1, j]
        if 0 <= j + k < columns and left[i, j + k]:
            cost += parallel * left[i, j + k + 1]
    for m in range(max(i - 1, 0), min(i + 1, rows - 1)):
        for n in range(max(j - 1, 0), min(j + 1, columns - 1)):
            both = in_field[m, n] and in_field[m + 1, n]
            if both and in_field[m, n + 1] and in_field[m + 1, n + 1]:
                code = 1 * left[m, n + 1] + 2 * left[m + 1, n + 1]
                cost += pattern[code + 4 * over[m + 1, n] + 8 * over[m + 1, n + 1]]
    return cost


@compiled_as_is
def move_boxes(potentials: Potentials, observed: Any, state: State) -> int:
    """Give each cell beside a line the best of label and four lines at once; return changes.

    Labels tried are its own and the neighbours', the datum, and the minimum of the parabola of
    datum and those neighbours that no line cuts off. Only for order 1.
    """
    in_field, curvature, centre, table, row = potentials.unary
    smooth, weights = potentials.pairwise.smooth, potentials.pairwise.weights
    pattern, parallel, one = potentials.lines
    labels, across, down = state
    rows, columns = labels.shape
    over, left = np.zeros((rows + 1, columns), np.bool_), np.zeros((rows, columns + 1), np.bool_)
    for i in range(rows):
        for j in range(columns):
            over[i, j] = i > 0 and across[i - 1, j]
            left[i, j] = j > 0 and down[i, j - 1]
    top = len(smooth) - 1
    bend = smooth[1] if top else 0.0
    changed = 0
    tried = np.empty(7, np.int64)
    theirs, weight = np.empty(4, np.int64), np.empty(4)
    for i in range(rows):
        for j in range(columns):
            if not in_field[i, j]:
                continue
            sites, now = 0, 0
            for k in range(4):
                m, n = (i - 1 + 2 * k, j) if k < 2 else (i, j - 5 + 2 * k)
                if 0 <= m < rows and 0 <= n < columns and in_field[m, n]:
                    sites += 1 << k
                    theirs[k], weight[k] = labels[m, n], weights[1 if k < 2 else 0]
                    if over[i + k, j] if k < 2 else left[i, j + k - 2]:
                        now += 1 << k
            if now == 0:
                continue
            was, best, code = labels[i, j], labels[i, j], now
            least = np.inf
            for turn in range(17):
                # The present lines come first: of equals they stay.
                lines = now if turn == 0 else turn - 1
                if lines & ~sites or (turn > 0 and lines == now):
                    continue
                set_sides(over, left, i, j, sites, lines)
                fixed = lines_around(pattern, parallel, one, in_field, over, left, i, j)
                mass = max(curvature[i, j], 1e-9)
                total = mass * (centre[i, j] if curvature[i, j] > 0.0 else observed[i, j])
                for k in range(7):
                    tried[k] = was
                for k in range(4):
                    if sites >> k & 1:
                        tried[k + 1] = theirs[k]
                        if not lines >> k & 1:
                            mass += weight[k] * bend
                            total += weight[k] * bend * theirs[k]
                tried[5] = min(max(int(np.rint(total / mass)), 0), top)
                tried[6] = min(max(int(np.rint(observed[i, j])), 0), top)
                for x in tried:
                    cost = fixed + curvature[i, j] * (x - centre[i, j]) ** 2 + table[row[i, j], x]
                    for k in range(4):
                        if sites >> k & 1 and not lines >> k & 1:
                            cost += weight[k] * smooth[abs(x - theirs[k])]
                    if cost < least:
                        least, best, code = cost, x, lines
            set_sides(over, left, i, j, sites, code)
            labels[i, j] = best
            changed += best != was or code != now
    for i in range(rows):
        for j in range(columns):
            if i > 0:
                across[i - 1, j] = over[i, j]
            if j > 0:
                down[i, j - 1] = left[i, j]
    return changed
