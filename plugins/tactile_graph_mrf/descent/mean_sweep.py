"""Kernels of `mean_field`: sweeps that lower the free energy of independent cells and lines."""

from __future__ import annotations

import math

import numpy as np

from tactile_graph.compiled import compiled_as_is

LOST = 1e-12
"""Probability below which a label adds nothing to its neighbours' mean costs."""


@compiled_as_is
def mean_costs(chance, smooth, reach, out):  # type: ignore[no-untyped-def]
    """Write the mean over ``chance`` of the smoothness cost beside each label.

    ``smooth`` is the same from ``reach`` on; so only what is nearer needs a sum.
    """
    n = len(chance)
    out[:] = smooth[min(reach, n - 1)]
    for x in range(n):
        share = chance[x]
        if share > LOST:
            for y in range(max(0, x - reach), min(n, x + reach + 1)):
                out[y] += share * (smooth[abs(x - y)] - smooth[min(reach, n - 1)])


@compiled_as_is
def softened(costs, temperature, chance):  # type: ignore[no-untyped-def]
    """Write exp(-costs / T) over its sum; the largest exponent is 0, so that none overflows."""
    least = costs.min()
    total = 0.0
    for x in range(len(costs)):
        height = (costs[x] - least) / temperature
        chance[x] = math.exp(-height) if height < 700.0 else 0.0
        total += chance[x]
    for x in range(len(costs)):
        chance[x] /= total


@compiled_as_is
def mean_rise(  # type: ignore[no-untyped-def]
    in_field, pattern, parallel, one, across, down, is_down, i, j,
):  # fmt: skip
    """Return what line (i, j) adds to the mean energy of the line field (Eq. 5.22)."""
    rows, columns = in_field.shape
    rise = one
    lines = down if is_down else across
    for side in (-1, 1):
        m, n = (i, j + side) if is_down else (i + side, j)
        if 0 <= m < lines.shape[0] and 0 <= n < lines.shape[1]:
            rise += parallel * lines[m, n]
    for side in range(2):
        m, n = (i - side, j) if is_down else (i, j - side)
        bit = (1 + side) if is_down else 4 * (1 + side)
        if m < 0 or n < 0 or m + 1 >= rows or n + 1 >= columns:
            continue
        both = in_field[m, n] and in_field[m + 1, n]
        if not (both and in_field[m, n + 1] and in_field[m + 1, n + 1]):
            continue
        around = (down[m, n], down[m + 1, n], across[m, n], across[m, n + 1])
        for code in range(16):
            share = 1.0
            for k in range(4):
                if 1 << k != bit:
                    share *= around[k] if code >> k & 1 else 1.0 - around[k]
            rise += share * pattern[code] * (1.0 if code & bit else -1.0)
    return rise


@compiled_as_is
def mean_sweep(  # type: ignore[no-untyped-def]
    in_field, curvature, centre, table, row, smooth, offsets, weights, pattern, parallel, one,
    reach, cells, sites, temperature, chances, felt, across, down,
):  # fmt: skip
    """Give each cell, then each line, its best distribution in turn; return the largest change.

    ``chances`` (rows, columns, L) are the cells' distributions, ``felt`` their `mean_costs`,
    ``across`` and ``down`` the probabilities of lines. Each visit lowers the free energy
    mean U - T entropy, or leaves it.
    """
    rows, columns = in_field.shape
    n_levels = len(smooth)
    costs, chance = np.empty(n_levels), np.empty(n_levels)
    moved = 0.0
    for s in range(len(cells)):
        i, j = cells[s, 0], cells[s, 1]
        for x in range(n_levels):
            costs[x] = curvature[i, j] * (x - centre[i, j]) ** 2 + table[row[i, j], x]
        for q in range(len(weights)):
            for sign in (1, -1):
                m, n = i + sign * offsets[q, 0], j + sign * offsets[q, 1]
                if 0 <= m < rows and 0 <= n < columns and in_field[m, n]:
                    weight = weights[q]
                    if q == 0 and len(sites):
                        weight *= 1.0 - down[i, min(j, n)]
                    elif q == 1 and len(sites):
                        weight *= 1.0 - across[min(i, m), j]
                    near = felt[m, n]
                    for x in range(n_levels):
                        costs[x] += weight * near[x]
        softened(costs, temperature, chance)
        change = np.abs(chance - chances[i, j]).sum()
        if change > 0.0:
            chances[i, j] = chance
            mean_costs(chance, smooth, reach, felt[i, j])
        moved = max(moved, change)
    for s in range(len(sites)):
        is_down, i, j = sites[s, 0] == 1, sites[s, 1], sites[s, 2]
        lines = down if is_down else across
        m, n = (i, j + 1) if is_down else (i + 1, j)
        bond = weights[0 if is_down else 1] * (chances[i, j] * felt[m, n]).sum()
        rise = mean_rise(in_field, pattern, parallel, one, across, down, is_down, i, j) - bond
        height = min(max(rise / temperature, -700.0), 700.0)
        share = 1.0 / (1.0 + math.exp(height))
        moved = max(moved, abs(share - lines[i, j]))
        lines[i, j] = share
    return moved
