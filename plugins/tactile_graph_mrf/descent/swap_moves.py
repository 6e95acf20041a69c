"""The kernel of swaps: every pair of labels traded as is best for the cells that have them."""

from __future__ import annotations

import numpy as np

from tactile_graph.compiled import compiled_as_is
from tactile_graph_mrf.descent.grid_cut import cut_grid


@compiled_as_is
def swap_graph(  # type: ignore[no-untyped-def]
    nodes, n, local, near, curvature, centre, table, row, rho, weights, labels, alpha, beta,
    beside, cap, excess, sink,
):  # fmt: skip
    """Write the graph whose cut gives ``beta`` to some of the nodes and ``alpha`` to the rest."""
    step = rho[beta - alpha] - rho[0]
    for s in range(n):
        i = nodes[s]
        rise = curvature[i] * ((beta - centre[i]) ** 2 - (alpha - centre[i]) ** 2)
        rise += table[row[i], beta] - table[row[i], alpha]
        for q in range(near.shape[1]):
            j = near[i, q]
            beside[s, q] = local[j] if j >= 0 else -1
            cap[s, q] = weights[q // 2] * step
            if j >= 0 and local[j] < 0:
                y = labels[j]
                rise += weights[q // 2] * (rho[abs(beta - y)] - rho[abs(alpha - y)])
        sink[s], excess[s] = max(rise, 0.0), max(-rise, 0.0)


@compiled_as_is
def swap_cycle(  # type: ignore[no-untyped-def]
    cells, near, curvature, centre, table, row, rho, weights, labels
):
    """Trade every two labels that are there, and each for the next one; flat arrays all.

    Where one label only is there, it is offered all others.
    """
    n_levels, size = len(rho), len(labels)
    counts = np.zeros(n_levels, np.int64)
    for s in range(len(cells)):
        counts[labels[cells[s]]] += 1
    flat = np.count_nonzero(counts) == 1
    local, nodes = np.full(size, -1), np.empty(size, np.int64)
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
                    nodes[n], local[i] = i, n
                    n += 1
            swap_graph(
                nodes, n, local, near, curvature, centre, table, row, rho, weights, labels,
                alpha, beta, beside, cap, excess, sink,
            )  # fmt: skip
            counts[beta] = cut_grid(beside[:n], cap[:n], excess[:n], sink[:n], goes[:n])
            counts[alpha] = n - counts[beta]
            for s in range(n):
                labels[nodes[s]] = beta if goes[s] else alpha
                local[nodes[s]] = -1
