"""Moves of any cells at once, the best of all sets by a minimum cut: up or down, or fused."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from tactile_graph.compiled import compiled_as_is
from tactile_graph_mrf.descent.grid_cut import Graph, cut_grid
from tactile_graph_mrf.energy.layout import Neighbours, by_cell
from tactile_graph_mrf.energy.potentials import Potentials
from tactile_graph_mrf.energy.problem import Problem
from tactile_graph_mrf.energy.state import State, sites_of
from tactile_graph_mrf.kernels import fit_for

FORBIDDING = 1e30


@compiled_as_is
def move_graph(
    potentials: Potentials, around: Neighbours, lines: Any, labels: Any, target: Any, graph: Graph
) -> None:
    """Write the graph whose cut says which cells go from ``labels`` to ``target``; flat arrays.

    What a cell gains by going comes to be its excess, what it loses its ``sink``; ``cap`` is what
    a pair costs if the one goes and the other stays. Where that is less than nothing it is taken
    as nothing: a cut that pays then pays in truth even more (majorisation).
    """
    cells, near, cut = around
    _, cap, rise, sink = graph
    _, curvature, centre, table, row = potentials.unary
    curvature, centre, row = curvature.reshape(-1), centre.reshape(-1), row.reshape(-1)
    smooth, weights = potentials.pairwise.smooth, potentials.pairwise.weights
    top = len(smooth) - 1
    cap[:] = 0.0
    rise[:] = 0.0
    for s in range(len(cells)):
        i = cells[s]
        x, y = labels[i], target[i]
        if 0 <= y <= top:
            own = curvature[i] * ((y - centre[i]) ** 2 - (x - centre[i]) ** 2)
            rise[i] += own + table[row[i], y] - table[row[i], x]
        else:
            rise[i] += FORBIDDING
        for k in range(len(weights)):
            j = near[i, 2 * k]
            if j < 0 or (k < 2 and lines[cut[i, 2 * k]]):
                continue
            stay = smooth[abs(x - labels[j])]
            alone = smooth[min(abs(y - labels[j]), top)]
            other = smooth[min(abs(x - target[j]), top)]
            both = smooth[min(abs(y - target[j]), top)]
            rise[i] += weights[k] * (alone - stay)
            rise[j] += weights[k] * (both - alone)
            cap[j, 2 * k + 1] = weights[k] * max(alone + other - stay - both, 0.0)
    for s in range(len(cells)):
        i = cells[s]
        sink[i] = max(rise[i], 0.0)
        rise[i] = max(-rise[i], 0.0)


@compiled_as_is
def shift_all(
    potentials: Potentials, around: Neighbours, lines: Any, rounds: int, labels: Any, target: Any
) -> int:
    """Raise, then lower the best set of cells by one level until neither pays; count changes.

    Without ``rounds`` the best set goes to ``target`` instead, once.
    """
    size = len(labels)
    graph = Graph(around.near, np.zeros(around.near.shape), np.zeros(size), np.zeros(size))
    goes = np.zeros(size, np.bool_)
    changed, idle = 0, 0
    for turn in range(max(2 * rounds, 1)):
        for i in range(size if rounds else 0):
            target[i] = labels[i] + 1 - 2 * (turn % 2)
        move_graph(potentials, around, lines, labels, target, graph)
        count = cut_grid(graph, goes)
        for i in range(size if count else 0):
            if goes[i]:
                labels[i] = target[i]
        changed += count
        idle = 0 if count else idle + 1
        if idle == 2:
            break
    return changed


def shift_regions(problem: Problem, state: State, rounds: int = 20) -> int:
    """Raise or lower regions by one level where that lowers the energy; return cells changed.

    Every move is the best of all sets of cells, found by a minimum cut (a jump move, Kolmogorov
    and Shioura 2009, DOI 10.1016/j.disopt.2009.04.006). With explicit lines of order 2 or 3 it
    does nothing: which pairs they cut depends on several of them.
    """
    return _moved(problem, state, state.labels.copy(), rounds)


def fuse(problem: Problem, state: State, other: NDArray[np.int64]) -> int:
    """Take from ``other`` those labels that together lower the energy; return cells changed.

    Lines stay. A fusion move (V. Lempitsky et al. 2010, DOI 10.1109/TPAMI.2009.143).
    """
    return _moved(problem, state, other.copy(), 0)


def _moved(problem: Problem, state: State, target: NDArray[np.int64], rounds: int) -> int:
    if problem.model.order > 1 and problem.model.lines == "explicit":
        return 0
    labels = np.ascontiguousarray(state.labels.reshape(-1))
    kernel = fit_for(shift_all, labels.size * 20)
    around, lines = by_cell(problem), sites_of(state).lines
    changed = kernel(problem.potentials, around, lines, rounds, labels, target.reshape(-1))
    state.labels[...] = labels.reshape(state.labels.shape)
    return int(changed)
