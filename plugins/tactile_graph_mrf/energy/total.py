"""The kernel of `energy`: the sum of all clique potentials (Eq. 5.5, 5.17, 5.20 to 5.22)."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from tactile_graph.compiled import compiled_as_is, compiled_twin_of


def _broken(
    across: NDArray[np.bool_], down: NDArray[np.bool_], di: int, dj: int
) -> NDArray[np.bool_]:
    """Return which pairs that are (di, dj) apart a line cuts: every shortest way is closed.

    Eq. 5.20 names only the line between two neighbours; this is the same for the pairs of
    orders 2 and 3.
    """
    if (di, dj) == (0, 1):
        return down
    if (di, dj) == (1, 0):
        return across
    if (di, dj) == (0, 2):
        return down[:, :-1] | down[:, 1:]
    if (di, dj) == (2, 0):
        return across[:-1] | across[1:]
    if (di, dj) == (1, 1):
        return (down[:-1] | across[:, 1:]) & (across[:, :-1] | down[1:])
    return (down[:-1] | across[:, :-1]) & (across[:, 1:] | down[1:])


def _total_plain(
    in_field: NDArray[np.bool_],
    curvature: NDArray[np.float64],
    centre: NDArray[np.float64],
    table: NDArray[np.float64],
    row: NDArray[np.int64],
    smooth: NDArray[np.float64],
    offsets: NDArray[np.int64],
    weights: NDArray[np.float64],
    pattern: NDArray[np.float64],
    parallel: float,
    one: float,
    labels: NDArray[np.int64],
    across: NDArray[np.bool_],
    down: NDArray[np.bool_],
) -> float:
    """Return the energy of labels and lines; lines are off where they have no site."""
    own = curvature * (labels - centre) ** 2 + table[row, labels]
    energy = float(own[in_field].sum())
    rows, columns = labels.shape
    for (di, dj), weight in zip(offsets.tolist(), weights.tolist(), strict=True):
        if di >= rows or abs(dj) >= columns:
            continue
        a = np.s_[: rows - di, max(-dj, 0) : columns - max(dj, 0)]
        b = np.s_[di:, max(dj, 0) : columns - max(-dj, 0)]
        whole = in_field[a] & in_field[b] & ~_broken(across, down, di, dj)
        energy += weight * float(smooth[np.abs(labels[a] - labels[b])][whole].sum())
    if rows > 1 and columns > 1:
        complete = in_field[:-1, :-1] & in_field[:-1, 1:] & in_field[1:, :-1] & in_field[1:, 1:]
        code = 1 * down[:-1] + 2 * down[1:] + 4 * across[:, :-1] + 8 * across[:, 1:]
        energy += float(pattern[code][complete].sum())
    pairs = np.count_nonzero(across[:-1] & across[1:])
    pairs += np.count_nonzero(down[:, :-1] & down[:, 1:])
    return energy + parallel * pairs + one * (np.count_nonzero(across) + np.count_nonzero(down))


@compiled_as_is
def broken(across: Any, down: Any, i: int, j: int, di: int, dj: int) -> bool:
    """Return whether lines cut the pair of cell (i, j) and the one (di, dj) further.

    Only for the six half-plane steps of `tactile_graph_mrf.energy.model.OFFSETS`.
    """
    if di == 0:
        return bool(down[i, j] or (dj == 2 and down[i, j + 1]))
    if dj == 0:
        return bool(across[i, j] or (di == 2 and across[i + 1, j]))
    if dj == 1:
        return bool((down[i, j] or across[i, j + 1]) and (across[i, j] or down[i + 1, j]))
    return bool((down[i, j - 1] or across[i, j - 1]) and (across[i, j] or down[i + 1, j - 1]))


@compiled_as_is
def own_costs(in_field, curvature, centre, table, row, labels):  # type: ignore[no-untyped-def]
    """Return the sum of the costs that each cell has by itself."""
    energy = 0.0
    tabled = table.shape[0] > 1
    for i in range(labels.shape[0]):
        for j in range(labels.shape[1]):
            if in_field[i, j]:
                x = labels[i, j]
                energy += curvature[i, j] * (x - centre[i, j]) ** 2
                if tabled:
                    energy += table[row[i, j], x]
    return energy


@compiled_as_is
def pair_costs(in_field, smooth, di, dj, labels, across, down):  # type: ignore[no-untyped-def]
    """Return the sum over the pairs (di, dj) apart that no line cuts, their weight left out."""
    rows, columns = labels.shape
    energy = 0.0
    for i in range(rows - di):
        for j in range(max(-dj, 0), columns - max(dj, 0)):
            if not (in_field[i, j] and in_field[i + di, j + dj]):
                continue
            if di == 1 and dj == 0:
                cut = across[i, j]
            elif di == 0 and dj == 1:
                cut = down[i, j]
            else:
                cut = broken(across, down, i, j, di, dj)
            if not cut:
                energy += smooth[abs(labels[i, j] - labels[i + di, j + dj])]
    return energy


@compiled_as_is
def line_costs(in_field, pattern, parallel, one, across, down):  # type: ignore[no-untyped-def]
    """Return the sum over the cliques of lines; lines without a site must be off."""
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


@compiled_twin_of(_total_plain)
def total(  # type: ignore[no-untyped-def]
    in_field, curvature, centre, table, row, smooth, offsets, weights, pattern, parallel, one,
    labels, across, down,
):  # fmt: skip
    """Return the energy of labels and lines; lines are off where they have no site."""
    energy = own_costs(in_field, curvature, centre, table, row, labels)
    for k in range(len(weights)):
        energy += weights[k] * pair_costs(
            in_field, smooth, offsets[k, 0], offsets[k, 1], labels, across, down
        )
    return energy + line_costs(in_field, pattern, parallel, one, across, down)
