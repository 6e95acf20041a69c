"""`energy`: the sum of all clique potentials (Eq. 5.5, 5.17, 5.20 to 5.22)."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from tactile_graph.compiled import compiled_as_is
from tactile_graph_mrf.energy.line_field import no_lines
from tactile_graph_mrf.energy.potentials import LineCliques, Potentials
from tactile_graph_mrf.energy.problem import Problem


def energy(
    problem: Problem,
    labels: NDArray[np.int64],
    lines_h: NDArray[np.bool_] | None = None,
    lines_v: NDArray[np.bool_] | None = None,
) -> float:
    """Return the energy of a restoration, in squared levels: what every restorer is judged by.

    Parameters
    ----------
    problem : Problem
    labels : ndarray of int64, shape (rows, columns)
        0 to L - 1.
    lines_h, lines_v : ndarray of bool, optional
        Horizontal and vertical lines as in `LineField`; all off if not given. Lines without a
        site do not count; with ``marginal`` lines none do, for there they follow from the labels.

    Returns
    -------
    float
    """
    across, down = no_lines(problem.shape)
    if problem.model.lines != "marginal":
        sites_h, sites_v = problem.sites
        across = across if lines_h is None else np.ascontiguousarray(lines_h & sites_h)
        down = down if lines_v is None else np.ascontiguousarray(lines_v & sites_v)
    labels = np.ascontiguousarray(labels, np.int64)
    return float(total.call(problem.potentials, labels, across, down))


@compiled_as_is
def total(potentials: Potentials, labels: Any, across: Any, down: Any) -> float:
    """Return the energy of labels and lines; lines must be off where they have no site."""
    in_field, curvature, centre, table, row = potentials.unary
    smooth, _, _, offsets, weights = potentials.pairwise
    rows, columns = labels.shape
    energy = 0.0
    tabled = table.shape[0] > 1
    for i in range(rows):
        for j in range(columns):
            if in_field[i, j]:
                x = labels[i, j]
                energy += curvature[i, j] * (x - centre[i, j]) ** 2
                if tabled:
                    energy += table[row[i, j], x]
    for k in range(len(weights)):
        di, dj = offsets[k, 0], offsets[k, 1]
        pairs = 0.0
        for i in range(rows - di):
            for j in range(max(-dj, 0), columns - max(dj, 0)):
                if not (in_field[i, j] and in_field[i + di, j + dj]):
                    continue
                if k == 0:
                    cut = down[i, j]
                elif k == 1:
                    cut = across[i, j]
                else:
                    cut = parted(across, down, i, j, di, dj)
                if not cut:
                    pairs += smooth[abs(labels[i, j] - labels[i + di, j + dj])]
        energy += weights[k] * pairs
    return energy + line_energy(potentials.lines, in_field, across, down)


@compiled_as_is
def parted(across: Any, down: Any, i: int, j: int, di: int, dj: int) -> bool:
    """Return whether lines part cell (i, j) from the one (di, dj) further: no shortest way is open.

    Eq. 5.20 names only the line between two neighbours; this is the same for the pairs of
    orders 2 and 3. Only for the six half-plane steps of `OFFSETS`.
    """
    if di == 0:
        return bool(down[i, j] or (dj == 2 and down[i, j + 1]))
    if dj == 0:
        return bool(across[i, j] or (di == 2 and across[i + 1, j]))
    if dj == 1:
        return bool((down[i, j] or across[i, j + 1]) and (across[i, j] or down[i + 1, j]))
    return bool((down[i, j - 1] or across[i, j - 1]) and (across[i, j] or down[i + 1, j - 1]))


@compiled_as_is
def line_energy(cliques: LineCliques, in_field: Any, across: Any, down: Any) -> float:
    """Return the sum over the cliques of lines; lines without a site must be off."""
    pattern, parallel, one = cliques
    rows, columns = in_field.shape
    energy = 0.0
    count, beside = 0, 0
    for i in range(rows - 1):
        for j in range(columns):
            if across[i, j]:
                count += 1
                beside += i + 2 < rows and across[i + 1, j]
    for i in range(rows):
        for j in range(columns - 1):
            if down[i, j]:
                count += 1
                beside += j + 2 < columns and down[i, j + 1]
    for i in range(rows - 1):
        for j in range(columns - 1):
            code = 1 * down[i, j] + 2 * down[i + 1, j] + 4 * across[i, j] + 8 * across[i, j + 1]
            if code:
                above = in_field[i, j] and in_field[i, j + 1]
                if above and in_field[i + 1, j] and in_field[i + 1, j + 1]:
                    energy += pattern[code]
    return energy + parallel * beside + one * count
