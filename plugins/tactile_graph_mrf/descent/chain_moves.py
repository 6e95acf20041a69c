"""Moves of whole rows and columns: the best combination of proposals for their cells."""

from __future__ import annotations

import math
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from tactile_graph.compiled import compiled_as_is
from tactile_graph_mrf.energy.potentials import Potentials
from tactile_graph_mrf.energy.state import State
from tactile_graph_mrf.energy.total import parted

PROPOSALS = 9


class Chain(NamedTuple):
    """A row or a column, and what its cells could be.

    Parameters
    ----------
    number : int
    along_rows : bool
    proposals : ndarray of int64, shape (length, PROPOSALS)
        Labels worth a try in each cell: each once, its own first.
    kinds : ndarray of int64, shape (length,)
        How many there are.
    best : ndarray of float64, shape (length, PROPOSALS)
        What they cost.
    came : ndarray of int64, shape (length, PROPOSALS)
        Which proposal of the cell before is best with each.
    """

    number: int
    along_rows: bool
    proposals: NDArray[np.int64]
    kinds: NDArray[np.int64]
    best: NDArray[np.float64]
    came: NDArray[np.int64]


@compiled_as_is
def propose(potentials: Potentials, observed: Any, labels: Any, chain: Chain) -> None:
    """Write the proposals of a chain, and how many.

    Those are a cell's own label, those beside it, the datum, the neighbours' and a mean.
    """
    in_field, curvature, centre, _, _ = potentials.unary
    smooth = potentials.pairwise.smooth
    proposals = chain.proposals
    rows, columns = labels.shape
    top = len(smooth) - 1
    for s in range(len(proposals)):
        i, j = (chain.number, s) if chain.along_rows else (s, chain.number)
        x = labels[i, j]
        proposals[s, 0] = x
        chain.kinds[s] = 1
        if not in_field[i, j]:
            continue
        tried = 1
        mass = max(curvature[i, j], 1e-9)
        total = mass * (centre[i, j] if curvature[i, j] > 0 else observed[i, j])
        for k in range(PROPOSALS - 1):
            if k < 4:
                m, n = (i - 1 + 2 * k, j) if k < 2 else (i, j - 5 + 2 * k)
                if m < 0 or n < 0 or m >= rows or n >= columns or not in_field[m, n]:
                    continue
                y = labels[m, n]
                # The parabola through the slope at the present step: flat costs pull no more.
                d = max(abs(x - y), 1)
                w = max(smooth[min(d + 1, top)] - smooth[d - 1], 0.0) / (4.0 * d)
                mass += w
                total += w * y
            elif k < 6:
                y = x - 1 if k == 4 else x + 1
            else:
                y = math.floor((observed[i, j] if k == 6 else total / mass) + 0.5)
            y = min(max(y, 0), top)
            known = False
            for q in range(tried):
                known = known or proposals[s, q] == y
            if not known:
                proposals[s, tried] = y
                tried += 1
        chain.kinds[s] = tried


@compiled_as_is
def held_costs(potentials: Potentials, state: State, chain: Chain) -> None:
    """Write what each proposal of a chain costs beside the cells that are not of the chain."""
    in_field, curvature, centre, table, row = potentials.unary
    smooth, _, _, offsets, weights = potentials.pairwise
    labels, across, down = state
    _, along_rows, proposals, kinds, out, _ = chain
    rows, columns = labels.shape
    inner = 0 if along_rows else 1
    for s in range(len(proposals)):
        i, j = (chain.number, s) if along_rows else (s, chain.number)
        out[s, 0] = 0.0
        if not in_field[i, j]:
            continue
        for a in range(kinds[s]):
            x = proposals[s, a]
            out[s, a] = curvature[i, j] * (x - centre[i, j]) ** 2 + table[row[i, j], x]
        for k in range(2 * len(weights)):
            q = k // 2
            if q == inner:
                continue
            sign = 1 if k % 2 else -1
            m, n = i + sign * offsets[q, 0], j + sign * offsets[q, 1]
            if m < 0 or n < 0 or m >= rows or n >= columns or not in_field[m, n]:
                continue
            first, second = (i, j) if sign == 1 else (m, n)
            if q < 2:
                cut = across[first, second] if q else down[first, second]
            else:
                cut = parted(across, down, first, second, offsets[q, 0], offsets[q, 1])
            if not cut:
                for a in range(kinds[s]):
                    out[s, a] += weights[q] * smooth[abs(proposals[s, a] - labels[m, n])]


@compiled_as_is
def best_way(potentials: Potentials, state: State, chain: Chain) -> int:
    """Add up the least costs along a chain (Viterbi); return the proposal its end is best with.

    ``best`` holds `held_costs` and comes to hold those of the best ways.
    """
    in_field, smooth = potentials.unary.in_field, potentials.pairwise.smooth
    _, across, down = state
    _, along_rows, proposals, kinds, best, came = chain
    weight = potentials.pairwise.weights[0 if along_rows else 1]
    length = len(proposals)
    for s in range(1, length):
        i, j = (chain.number, s) if along_rows else (s, chain.number)
        linked = in_field[i, j] and in_field[(i, j - 1) if along_rows else (i - 1, j)]
        linked = linked and not (down[i, j - 1] if along_rows else across[i - 1, j])
        for a in range(kinds[s]):
            least, come = np.inf, 0
            for b in range(kinds[s - 1]):
                way = best[s - 1, b]
                if linked:
                    way += weight * smooth[abs(proposals[s, a] - proposals[s - 1, b])]
                if way < least:
                    least, come = way, b
            best[s, a] += least
            came[s, a] = come
    last = 0  # the labels as they are: of equals they stay
    for a in range(1, kinds[length - 1]):
        if best[length - 1, a] < best[length - 1, last]:
            last = a
    return last


@compiled_as_is
def move_chains(potentials: Potentials, observed: Any, state: State, along_rows: bool) -> int:
    """Give every row (or column) the best of its cells' proposals; return the cells changed.

    Exact for the chain by dynamic programming, its neighbours held (a fusion move); in-chain
    pairs must all be of direct neighbours, so only for orders 1 and 2.
    """
    labels = state.labels
    rows, columns = labels.shape
    n_chains, length = (rows, columns) if along_rows else (columns, rows)
    proposals, kinds = np.empty((length, PROPOSALS), np.int64), np.empty(length, np.int64)
    best, came = np.empty((length, PROPOSALS)), np.zeros((length, PROPOSALS), np.int64)
    changed = 0
    for number in range(n_chains):
        chain = Chain(number, along_rows, proposals, kinds, best, came)
        propose(potentials, observed, labels, chain)
        held_costs(potentials, state, chain)
        a = best_way(potentials, state, chain)
        for s in range(length - 1, -1, -1):
            i, j = (number, s) if along_rows else (s, number)
            if labels[i, j] != proposals[s, a]:
                labels[i, j] = proposals[s, a]
                changed += 1
            a = came[s, a]
    return changed
