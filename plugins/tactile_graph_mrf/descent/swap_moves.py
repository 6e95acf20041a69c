"""The kernel of swaps: every pair of labels traded as is best for the cells that have them."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from tactile_graph.compiled import compiled_as_is
from tactile_graph_mrf.descent.grid_cut import Graph, cut_grid
from tactile_graph_mrf.energy.layout import Layout, by_cell
from tactile_graph_mrf.energy.potentials import Unary


class Bonds(NamedTuple):
    """What pairs cost: of each difference, shape (L,), and the weight of each kind of clique."""

    rho: NDArray[np.float64]
    weights: NDArray[np.float64]


@compiled_as_is
def swap_graph(
    unary: Unary, bonds: Bonds, near: Any, labels: Any, alpha: int, beta: int, nodes: Any,
    node_of: Any, graph: Graph,
) -> None:  # fmt: skip
    """Write the graph whose cut gives ``beta`` to some of the nodes and ``alpha`` to the rest.

    ``nodes`` are their cells; ``node_of`` the node of each cell, -1 if it is none.
    """
    _, curvature, centre, table, row = unary
    rho, weights = bonds
    beside, cap, excess, sink = graph
    step = rho[beta - alpha] - rho[0]
    for s in range(len(nodes)):
        i = nodes[s]
        rise = curvature[i] * ((beta - centre[i]) ** 2 - (alpha - centre[i]) ** 2)
        rise += table[row[i], beta] - table[row[i], alpha]
        for q in range(near.shape[1]):
            j = near[i, q]
            beside[s, q] = node_of[j] if j >= 0 else -1
            cap[s, q] = weights[q // 2] * step
            if j >= 0 and node_of[j] < 0:
                y = labels[j]
                rise += weights[q // 2] * (rho[abs(beta - y)] - rho[abs(alpha - y)])
        sink[s], excess[s] = max(rise, 0.0), max(-rise, 0.0)


@compiled_as_is
def swap_cycle(unary: Unary, bonds: Bonds, layout: Layout, labels: Any) -> None:
    """Trade every two labels that are there, and each for the next one; all cells in a row.

    Where one label only is there, it is offered all others.
    """
    n_levels, size = len(bonds.rho), len(labels)
    cells, near, _ = by_cell(layout, size)
    counts = np.zeros(n_levels, np.int64)
    for s in range(len(cells)):
        counts[labels[cells[s]]] += 1
    flat = np.count_nonzero(counts) == 1
    node_of, nodes = np.full(size, -1), np.empty(size, np.int64)
    beside, cap = np.empty(near.shape, np.int64), np.empty(near.shape)
    excess, sink = np.empty(size), np.empty(size)
    goes = np.empty(size, np.bool_)
    for alpha in range(n_levels):
        for beta in range(alpha + 1, n_levels):
            here, there = counts[alpha] > 0, counts[beta] > 0
            if not (here or there) or not ((here and there) or flat or beta == alpha + 1):
                continue
            n = 0
            for s in range(len(cells)):
                i = cells[s]
                if labels[i] == alpha or labels[i] == beta:
                    nodes[n], node_of[i] = i, n
                    n += 1
            graph = Graph(beside[:n], cap[:n], excess[:n], sink[:n])
            swap_graph(unary, bonds, near, labels, alpha, beta, nodes[:n], node_of, graph)
            counts[beta] = cut_grid(graph, goes[:n])
            counts[alpha] = n - counts[beta]
            for s in range(n):
                labels[nodes[s]] = beta if goes[s] else alpha
                node_of[nodes[s]] = -1
