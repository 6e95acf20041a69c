"""Moves of any cells at once, the best of all sets by a minimum cut: up or down, or fused."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from tactile_graph.compiled import compiled_as_is
from tactile_graph_mrf.descent.grid_cut import Graph, cut_grid
from tactile_graph_mrf.energy.layout import Layout, Neighbours, by_cell, layout
from tactile_graph_mrf.energy.potentials import Potentials
from tactile_graph_mrf.energy.problem import Problem
from tactile_graph_mrf.energy.state import Sites, State, sites_of

FORBIDDING = 1e30
SHIFTS = 20
"""Times at most that cells are raised and lowered."""


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
def take_best(
    potentials: Potentials, around: Neighbours, lines: Any, labels: Any, target: Any, graph: Graph
) -> int:
    """Give those cells their label of ``target`` that together lower the energy most; count them.

    ``graph`` is overwritten.
    """
    move_graph(potentials, around, lines, labels, target, graph)
    goes = np.zeros(len(labels), np.bool_)
    changed = cut_grid(graph, goes)
    for i in range(len(labels) if changed else 0):
        if goes[i]:
            labels[i] = target[i]
    return changed


@compiled_as_is
def graph_of(around: Neighbours) -> Graph:
    """Return a graph of all cells, to be filled in."""
    near = around.near
    return Graph(near, np.zeros(near.shape), np.zeros(len(near)), np.zeros(len(near)))


@compiled_as_is
def shift_regions(potentials: Potentials, layout: Layout, state: Sites) -> int:
    """Raise, then lower the best set of cells by one level until neither pays; count changes.

    Every move is the best of all sets of cells, found by a minimum cut (a jump move, Kolmogorov
    and Shioura 2009, DOI 10.1016/j.disopt.2009.04.006).
    """
    labels = state.labels.reshape(-1)
    around = by_cell(layout, len(labels))
    graph = graph_of(around)
    changed, idle = 0, 0
    for turn in range(2 * SHIFTS):
        count = take_best(
            potentials, around, state.lines, labels, labels + 1 - 2 * (turn % 2), graph
        )
        changed += count
        idle = 0 if count else idle + 1
        if idle == 2:
            break
    return changed


@compiled_as_is
def fuse_all(potentials: Potentials, layout: Layout, state: Sites, target: Any) -> int:
    """Take the best set of the labels of ``target``, a flat array; count changes."""
    labels = state.labels.reshape(-1)
    around = by_cell(layout, len(labels))
    return take_best(potentials, around, state.lines, labels, target, graph_of(around))


def pairs_stand_alone(problem: Problem) -> bool:
    """Return whether regions can be moved: with explicit lines of order 2 or 3 they cannot.

    Which pairs are parted then depends on several lines.
    """
    return problem.model.order == 1 or problem.model.lines != "explicit"


def fuse(problem: Problem, state: State, other: NDArray[np.int64]) -> int:
    """Take from ``other`` those labels that together lower the energy; return cells changed.

    Lines stay. A fusion move (V. Lempitsky et al. 2010, DOI 10.1109/TPAMI.2009.143).
    """
    if not pairs_stand_alone(problem):
        return 0
    sites, target = sites_of(state), other.reshape(-1)
    return int(fuse_all.call(problem.potentials, layout(problem), sites, target))
