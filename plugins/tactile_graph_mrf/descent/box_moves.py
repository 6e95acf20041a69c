"""A move for explicit lines: a cell's label together with the lines on its four sides."""

from __future__ import annotations

import numpy as np

from tactile_graph.compiled import compiled_as_is


@compiled_as_is
def side(across, down, i, j, k):  # type: ignore[no-untyped-def]
    """Return whether the line above (0), below (1), left (2) or right (3) of a cell is on."""
    if k < 2:
        m = i - 1 + k
        return 0 <= m < across.shape[0] and across[m, j]
    n = j - 3 + k
    return 0 <= n < down.shape[1] and down[i, n]


@compiled_as_is
def set_sides(across, down, i, j, sites, code):  # type: ignore[no-untyped-def]
    """Turn the lines around a cell on or off by the bits of ``code``, where there are sites."""
    for k in range(4):
        if sites >> k & 1:
            if k < 2:
                across[i - 1 + k, j] = code >> k & 1 == 1
            else:
                down[i, j - 3 + k] = code >> k & 1 == 1


@compiled_as_is
def lines_around(in_field, pattern, parallel, one, across, down, i, j):  # type: ignore[no-untyped-def]
    """Return the energy of all cliques of lines that hold a line around cell (i, j)."""
    rows, columns = in_field.shape
    cost = 0.0
    for k in range(4):
        if side(across, down, i, j, k):
            cost += one
    for k in range(-1, 2):
        # Lines side by side across this cell, and across the one before and after it.
        if 0 <= i + k < rows and side(across, down, i + k, j, 0):
            cost += parallel * side(across, down, i + k, j, 1)
        if 0 <= j + k < columns and side(across, down, i, j + k, 2):
            cost += parallel * side(across, down, i, j + k, 3)
    for m in range(max(i - 1, 0), min(i + 1, rows - 1)):
        for n in range(max(j - 1, 0), min(j + 1, columns - 1)):
            both = in_field[m, n] and in_field[m + 1, n]
            if both and in_field[m, n + 1] and in_field[m + 1, n + 1]:
                code = 1 * down[m, n] + 2 * down[m + 1, n]
                cost += pattern[code + 4 * across[m, n] + 8 * across[m, n + 1]]
    return cost


@compiled_as_is
def move_boxes(  # type: ignore[no-untyped-def]
    in_field, curvature, centre, table, row, smooth, weights, pattern, parallel, one, observed,
    labels, across, down,
):  # fmt: skip
    """Give each cell beside a line the best of label and four lines at once; return changes.

    Labels tried are its own and the neighbours', the datum, and the minimum of the parabola of
    datum and those neighbours that no line cuts off. Only for order 1.
    """
    rows, columns = labels.shape
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
                    if side(across, down, i, j, k):
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
                set_sides(across, down, i, j, sites, lines)
                fixed = lines_around(in_field, pattern, parallel, one, across, down, i, j)
                mass = max(curvature[i, j], 1e-9)
                total = mass * (centre[i, j] if curvature[i, j] > 0.0 else observed[i, j])
                tried[:] = was
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
            set_sides(across, down, i, j, sites, code)
            labels[i, j] = best
            changed += best != was or code != now
    return changed
