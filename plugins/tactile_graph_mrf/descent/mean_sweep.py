"""Kernels of `mean_field`: sweeps that lower the free energy of independent cells and lines."""

from __future__ import annotations

import math
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from tactile_graph.compiled import compiled_as_is
from tactile_graph_mrf.energy.potentials import LineCliques, Potentials

LOST = 1e-12
"""Probability below which a label adds nothing to its neighbours' mean costs."""


class Chances(NamedTuple):
    """Independent distributions of cells and lines.

    Parameters
    ----------
    cells : ndarray of float64, shape (rows, columns, L)
    felt : ndarray of float64, shape (rows, columns, L)
        Their `mean_costs`.
    across, down : ndarray of float64, shape (rows - 1, columns) and (rows, columns - 1)
        Probabilities of horizontal and vertical lines.
    """

    cells: NDArray[np.float64]
    felt: NDArray[np.float64]
    across: NDArray[np.float64]
    down: NDArray[np.float64]


@compiled_as_is
def mean_costs(chance: Any, far: float, nearer: Any, reach: int, out: Any) -> None:
    """Write the mean over ``chance`` of the smoothness cost beside each label.

    It is ``far`` from ``reach`` on; so only what is ``nearer`` needs a sum: what difference d costs
    beyond it, at L - 1 + d, for in one row the labels beside x take it in their order.
    """
    n = len(chance)
    for y in range(n):
        out[y] = far
    for x in range(n):
        share = chance[x]
        if share > LOST:
            first, end = max(0, x - reach), min(n, x + reach + 1)
            beside = nearer[n - 1 - x + first : n - 1 - x + end]
            here = out[first:end]
            for k in range(len(here)):
                here[k] += share * beside[k]


@compiled_as_is
def softened(costs: Any, temperature: float, chance: Any) -> None:
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
def mean_rise(
    cliques: LineCliques, in_field: Any, chances: Chances, is_down: bool, i: int, j: int
) -> float:
    """Return what line (i, j) adds to the mean energy of the line field (Eq. 5.22)."""
    pattern, parallel, one = cliques
    _, _, across, down = chances
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
def mean_sweep(
    potentials: Potentials, reach: int, cells: Any, sites: Any, temperature: float,
    chances: Chances,
) -> float:  # fmt: skip
    """Give each cell, then each line, its best distribution in turn; return the largest change.

    ``cells`` (row, column) and ``sites`` (1 if vertical, row, column) are visited in order;
    smoothness is the same from ``reach`` levels on. Each visit lowers the free energy
    mean U - T entropy, or leaves it.
    """
    in_field, curvature, centre, table, row = potentials.unary
    smooth, _, _, offsets, weights = potentials.pairwise
    labels, felt, across, down = chances
    rows, columns, n_levels = labels.shape
    lined = len(sites) > 0
    moved = 0.0
    costs, chance = np.empty(n_levels), np.empty(n_levels)
    far, nearer = smooth[min(reach, n_levels - 1)], np.empty(2 * n_levels - 1)
    for d in range(n_levels):
        nearer[n_levels - 1 + d] = nearer[n_levels - 1 - d] = smooth[d] - far
    for s in range(len(cells)):
        i, j = cells[s, 0], cells[s, 1]
        for x in range(n_levels):
            costs[x] = curvature[i, j] * (x - centre[i, j]) ** 2 + table[row[i, j], x]
        for q in range(len(weights)):
            for sign in (1, -1):
                m, n = i + sign * offsets[q, 0], j + sign * offsets[q, 1]
                if 0 <= m < rows and 0 <= n < columns and in_field[m, n]:
                    weight = weights[q]
                    if q == 0 and lined:
                        weight *= 1.0 - down[i, min(j, n)]
                    elif q == 1 and lined:
                        weight *= 1.0 - across[min(i, m), j]
                    near = felt[m, n]
                    for x in range(n_levels):
                        costs[x] += weight * near[x]
        softened(costs, temperature, chance)
        change = np.abs(chance - labels[i, j]).sum()
        if change > 0.0:
            for x in range(len(chance)):
                labels[i, j, x] = chance[x]
            mean_costs(chance, far, nearer, reach, felt[i, j])
        moved = max(moved, change)
    for s in range(len(sites)):
        is_down, i, j = sites[s, 0] == 1, sites[s, 1], sites[s, 2]
        lines = down if is_down else across
        m, n = (i, j + 1) if is_down else (i + 1, j)
        bond = weights[0 if is_down else 1] * (labels[i, j] * felt[m, n]).sum()
        rise = mean_rise(potentials.lines, in_field, chances, is_down, i, j) - bond
        height = min(max(rise / temperature, -700.0), 700.0)
        share = 1.0 / (1.0 + math.exp(height))
        moved = max(moved, abs(share - lines[i, j]))
        lines[i, j] = share
    return moved
