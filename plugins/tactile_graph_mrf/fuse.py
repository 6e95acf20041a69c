"""Moves that lower an energy for certain: the best of proposals for whole rows and columns."""

from __future__ import annotations

from typing import Any

import numpy as np

from tactile_graph.compiled import compiled_as_is
from tactile_graph_mrf.annealing import State, run
from tactile_graph_mrf.box_moves import move_boxes
from tactile_graph_mrf.model import Problem, energy
from tactile_graph_mrf.total import broken
from tactile_graph_mrf.visits import fit_for

PROPOSALS = 9


@compiled_as_is
def gather(
    in_field: Any, offsets: Any, weights: Any, across: Any, down: Any, labels: Any,
    i: int, j: int, ci: int, cj: int, theirs: Any, weight: Any,
) -> int:  # fmt: skip
    """Write labels and weights of the cells tied to (i, j), those (ci, cj) apart left out."""
    rows, columns = labels.shape
    count = 0
    for q in range(len(weights)):
        di, dj = offsets[q, 0], offsets[q, 1]
        if di == ci and dj == cj:
            continue
        m, n = i + di, j + dj
        if (
            m < rows
            and 0 <= n < columns
            and in_field[m, n]
            and not broken(across, down, i, j, di, dj)
        ):
            theirs[count], weight[count] = labels[m, n], weights[q]
            count += 1
        m, n = i - di, j - dj
        if (
            m >= 0
            and 0 <= n < columns
            and in_field[m, n]
            and not broken(across, down, m, n, di, dj)
        ):
            theirs[count], weight[count] = labels[m, n], weights[q]
            count += 1
    return count


@compiled_as_is
def cost_of(
    curvature: float, centre: float, costs: Any, smooth: Any, theirs: Any, weight: Any,
    count: int, x: int,
) -> float:  # fmt: skip
    """Return the cost of label ``x`` beside the gathered neighbours; ``costs`` are its table."""
    cost = curvature * (x - centre) ** 2 + costs[x]
    for k in range(count):
        cost += weight[k] * smooth[abs(x - theirs[k])]
    return float(cost)


@compiled_as_is
def propose(
    in_field: Any, own: Any, smooth: Any, observed: Any, labels: Any, i: int, j: int, out: Any
) -> None:
    """Write labels worth a try at (i, j): its own, beside it, the neighbours' and a mean."""
    curvature, centre, _, _ = own
    rows, columns = labels.shape
    top = len(smooth) - 1
    x = labels[i, j]
    out[:] = x
    out[1], out[2] = max(x - 1, 0), min(x + 1, top)
    out[3] = min(max(int(np.rint(observed[i, j])), 0), top)
    mass = max(curvature[i, j], 1e-9)
    total = mass * (centre[i, j] if curvature[i, j] > 0 else observed[i, j])
    at = 4
    for di, dj in ((-1, 0), (1, 0), (0, -1), (0, 1)):
        m, n = i + di, j + dj
        if 0 <= m < rows and 0 <= n < columns and in_field[m, n]:
            y = labels[m, n]
            out[at] = y
            # The parabola through the slope at the present step: flat costs pull no more.
            d = max(abs(x - y), 1)
            w = max(smooth[min(d + 1, top)] - smooth[d - 1], 0.0) / (4.0 * d)
            mass += w
            total += w * y
        at += 1
    out[8] = min(max(int(np.rint(total / mass)), 0), top)


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
    ci, cj = (0, 1) if along_rows else (1, 0)
    kind = 0 if along_rows else 1
    n_chains, length = (rows, columns) if along_rows else (columns, rows)
    proposals = np.empty((length, PROPOSALS), np.int64)
    best = np.empty((length, PROPOSALS))
    came = np.zeros((length, PROPOSALS), np.int64)
    theirs, weight = np.empty(12, np.int64), np.empty(12)
    curvature, centre, table, row = own
    changed = 0
    for chain in range(n_chains):
        for s in range(length):
            i, j = (chain, s) if along_rows else (s, chain)
            if not in_field[i, j]:
                proposals[s] = labels[i, j]
                best[s] = 0.0 if s == 0 else best[s - 1].min()
                came[s] = 0 if s == 0 else np.argmin(best[s - 1])
                continue
            propose(in_field, own, smooth, observed, labels, i, j, proposals[s])
            linked = (
                s > 0
                and in_field[i - ci, j - cj]
                and not (down[i, j - 1] if along_rows else across[i - 1, j])
            )
            count = gather(
                in_field, offsets, weights, across, down, labels, i, j, ci, cj, theirs, weight
            )
            costs = table[row[i, j]]
            for a in range(PROPOSALS):
                x = proposals[s, a]
                cost = cost_of(
                    curvature[i, j], centre[i, j], costs, smooth, theirs, weight, count, x
                )
                if s > 0:
                    least = np.inf
                    for b in range(PROPOSALS):
                        way = best[s - 1, b]
                        if linked:
                            way += weights[kind] * smooth[abs(x - proposals[s - 1, b])]
                        if way < least:
                            least = way
                            came[s, a] = b
                    cost += least
                best[s, a] = cost
        a = int(np.argmin(best[length - 1]))
        # Column 0 holds the labels as they are: of equals they stay.
        if best[length - 1, 0] <= best[length - 1, a]:
            a = 0
        for s in range(length - 1, -1, -1):
            i, j = (chain, s) if along_rows else (s, chain)
            if in_field[i, j] and labels[i, j] != proposals[s, a]:
                labels[i, j] = proposals[s, a]
                changed += 1
            a = came[s, a]
    return changed


def polish(problem: Problem, state: State, rounds: int, n_sweeps: int = 50) -> list[float]:
    """Lower the energy in place by moves of chains, then of cells and lines; return energies.

    The energies never rise; it ends where neither kind of move helps, or after ``rounds``.
    """
    p = problem
    work = (p.in_field, (p.curvature, p.centre, p.table, p.row), p.smooth, p.offsets, p.weights)
    kernel = fit_for(move_chains, p.in_field.size * PROPOSALS)
    trace: list[float] = []
    for _ in range(rounds):
        before = len(trace)
        while p.model.order < 3 and len(trace) < before + rounds:
            changed = kernel(*work, p.observed, state.across, state.down, state.labels, True)
            changed += kernel(*work, p.observed, state.across, state.down, state.labels, False)
            if not changed:
                break
            trace.append(energy(p, *state))
        low = trace[-1] if trace else energy(p, *state)
        trace += run(p, state, np.full(n_sweeps, np.inf), None)
        if p.model.lines == "explicit" and p.model.order == 1:
            own = p.in_field, p.curvature, p.centre, p.table, p.row, p.smooth, p.weights
            boxes = fit_for(move_boxes, p.in_field.size * PROPOSALS)
            if boxes(*own, p.pattern, p.parallel, p.one, p.observed, *state):
                trace.append(energy(p, *state))
        if not trace[-1] < low or p.model.order > 2:
            break
    return trace
