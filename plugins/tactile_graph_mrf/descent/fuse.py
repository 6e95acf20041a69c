"""Moves that lower an energy for certain: of regions, of whole rows and columns, of cells."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from tactile_graph.compiled import compiled_as_is
from tactile_graph_mrf.descent.box_moves import move_boxes
from tactile_graph_mrf.descent.region_moves import shift_regions
from tactile_graph_mrf.energy.model import Problem, energy
from tactile_graph_mrf.energy.total import broken
from tactile_graph_mrf.samplers.annealing import State, run
from tactile_graph_mrf.samplers.visits import fit_for

PROPOSALS = 9


@compiled_as_is
def propose(
    in_field: Any, own: Any, smooth: Any, observed: Any, labels: Any, chain: int, along_rows: bool,
    proposals: Any, kinds: Any,
) -> None:  # fmt: skip
    """Write labels worth a try in each cell of a chain, and how many: each once, its own first.

    Those are its own, those beside it, the datum, the neighbours' and a mean.
    """
    curvature, centre, _, _ = own
    rows, columns = labels.shape
    top = len(smooth) - 1
    for s in range(columns if along_rows else rows):
        i, j = (chain, s) if along_rows else (s, chain)
        x = labels[i, j]
        proposals[s, 0] = x
        kinds[s] = 1
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
        kinds[s] = tried


@compiled_as_is
def held_costs(
    in_field: Any, own: Any, smooth: Any, offsets: Any, weights: Any, across: Any, down: Any,
    labels: Any, chain: int, along_rows: bool, proposals: Any, kinds: Any, out: Any,
) -> None:  # fmt: skip
    """Write what each proposal of a chain costs beside the cells that are not of the chain."""
    curvature, centre, table, row = own
    rows, columns = labels.shape
    inner = 0 if along_rows else 1
    for s in range(columns if along_rows else rows):
        i, j = (chain, s) if along_rows else (s, chain)
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
                cut = broken(across, down, first, second, offsets[q, 0], offsets[q, 1])
            if not cut:
                for a in range(kinds[s]):
                    out[s, a] += weights[q] * smooth[abs(proposals[s, a] - labels[m, n])]


@compiled_as_is
def best_way(
    in_field: Any, smooth: Any, weight: float, across: Any, down: Any, chain: int,
    along_rows: bool, proposals: Any, kinds: Any, best: Any, came: Any,
) -> int:  # fmt: skip
    """Add up the least costs along a chain (Viterbi); return the proposal its end is best with.

    ``best`` holds `held_costs` and comes to hold those of the best ways; ``came`` which proposal
    of the cell before each of them comes from.
    """
    rows, columns = in_field.shape
    length = columns if along_rows else rows
    for s in range(1, length):
        i, j = (chain, s) if along_rows else (s, chain)
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
def move_chains(
    in_field: Any, own: Any, smooth: Any, offsets: Any, weights: Any, observed: Any,
    across: Any, down: Any, labels: Any, along_rows: bool,
) -> int:  # fmt: skip
    """Give every row (or column) the best of its cells' proposals; return the cells changed.

    Exact for the chain by dynamic programming, its neighbours held (a fusion move); in-chain
    pairs must all be of direct neighbours, so only for orders 1 and 2.
    """
    rows, columns = labels.shape
    n_chains, length = (rows, columns) if along_rows else (columns, rows)
    proposals = np.empty((length, PROPOSALS), np.int64)
    kinds = np.empty(length, np.int64)
    best = np.empty((length, PROPOSALS))
    came = np.zeros((length, PROPOSALS), np.int64)
    changed = 0
    for chain in range(n_chains):
        propose(in_field, own, smooth, observed, labels, chain, along_rows, proposals, kinds)
        held_costs(
            in_field, own, smooth, offsets, weights, across, down, labels, chain, along_rows,
            proposals, kinds, best,
        )  # fmt: skip
        a = best_way(
            in_field, smooth, weights[0 if along_rows else 1], across, down, chain, along_rows,
            proposals, kinds, best, came,
        )  # fmt: skip
        for s in range(length - 1, -1, -1):
            i, j = (chain, s) if along_rows else (s, chain)
            if labels[i, j] != proposals[s, a]:
                labels[i, j] = proposals[s, a]
                changed += 1
            a = came[s, a]
    return changed


def polish(problem: Problem, state: State, rounds: int, n_sweeps: int = 50) -> list[float]:
    """Lower the energy in place by moves of regions, chains, cells and lines; return energies.

    The energies never rise; it ends where no kind of move helps, or after ``rounds``.
    """
    p = problem
    work = (p.in_field, (p.curvature, p.centre, p.table, p.row), p.smooth, p.offsets, p.weights)
    kernel = fit_for(move_chains, p.in_field.size * PROPOSALS)
    trace: list[float] = []
    for _ in range(rounds):
        if shift_regions(p, state) or not trace:
            trace.append(energy(p, *state))
        low = trace[-1]  # what the moves of regions leave: they need no other look if it stays
        before = len(trace)
        while p.model.order < 3 and len(trace) < before + rounds:
            changed = kernel(*work, p.observed, state.across, state.down, state.labels, True)
            changed += kernel(*work, p.observed, state.across, state.down, state.labels, False)
            if not changed:
                break
            trace.append(energy(p, *state))
        trace += run(p, state, np.full(n_sweeps, np.inf), None)
        if p.model.lines == "explicit" and p.model.order == 1:
            own = p.in_field, p.curvature, p.centre, p.table, p.row, p.smooth, p.weights
            boxes = fit_for(move_boxes, p.in_field.size * PROPOSALS)
            if boxes(*own, p.pattern, p.parallel, p.one, p.observed, *state):
                trace.append(energy(p, *state))
        if not trace[-1] < low:
            break
    return trace
