"""Kernels of the conditionals: what one cell's label, or one line, costs given all others.

Samplers draw from them (Eq. 5.9, 5.10, 5.19); descents take the least.
"""

from __future__ import annotations

import math
from typing import Any

from tactile_graph.compiled import compiled_as_is
from tactile_graph_mrf.energy.layout import Layout
from tactile_graph_mrf.energy.potentials import LineCliques, Pairwise, Unary
from tactile_graph_mrf.energy.state import Sites
from tactile_graph_mrf.energy.total import parted


@compiled_as_is
def difference_costs(pairwise: Pairwise, beta: float, costs: Any) -> None:
    """Write each kind of clique's cost of each difference, its line summed out if at a price.

    Shape (K, 2 L - 1): difference d at L - 1 + d. A pair whose line is summed out costs
    -log(exp(-beta rho) + exp(-beta price)) / beta, at infinite beta the lesser of both.
    """
    bare, price, weights = pairwise.bare, pairwise.price, pairwise.weights
    last = len(bare) - 1
    for k in range(len(weights)):
        for d in range(last + 1):
            rho = weights[k] * bare[d]
            if price >= 0.0:
                line = weights[k] * price
                gap = abs(rho - line)
                rho = min(rho, line)
                if beta < math.inf and beta * gap < 40.0:
                    rho -= math.log1p(math.exp(-beta * gap)) / beta
            costs[k, last + d] = rho
            costs[k, last - d] = rho


@compiled_as_is
def tied_to(layout: Layout, offsets: Any, state: Sites, s: int, q: int) -> int:
    """Return the other cell of a cell's pair clique, -1 where there is none or lines part them.

    The cell is that of row ``s`` of the layout, the clique column ``q`` of `Layout.near`.
    """
    other = layout.near[s, q]
    if other < 0:
        return -1
    if q < 4:
        return -1 if state.lines[layout.cut[s, q]] else other
    columns = state.labels.shape[1]
    base = other if q % 2 else layout.cells[s]
    i, j = base // columns, base % columns
    cut = parted(state.across, state.down, i, j, offsets[q // 2, 0], offsets[q // 2, 1])
    return -1 if cut else other


@compiled_as_is
def cell_parabola(
    unary: Unary, offsets: Any, costs: Any, layout: Layout, state: Sites, s: int
) -> tuple[float, float]:
    """Return curvature and pull (curvature times centre) of the cost of a cell's label.

    Only for quadratic smoothness, no line summed out, and Gaussian noise.
    """
    cell = layout.cells[s]
    middle, sharpness = unary.centre.reshape(-1)[cell], unary.curvature.reshape(-1)[cell]
    pull = sharpness * middle
    one = costs.shape[1] // 2 + 1
    flat = state.labels.reshape(-1)
    for q in range(layout.near.shape[1]):
        other = tied_to(layout, offsets, state, s, q)
        if other >= 0:
            weight = costs[q // 2, one]
            sharpness += weight
            pull += weight * flat[other]
    return sharpness, pull


@compiled_as_is
def cell_costs(
    unary: Unary, offsets: Any, costs: Any, layout: Layout, state: Sites, s: int, out: Any
) -> None:
    """Write what each label of a cell costs; ``costs`` are `difference_costs`."""
    n_levels = len(out)
    cell = layout.cells[s]
    middle, sharpness = unary.centre.reshape(-1)[cell], unary.curvature.reshape(-1)[cell]
    own = unary.table[unary.row.reshape(-1)[cell]]
    for x in range(n_levels):
        out[x] = sharpness * ((x - middle) * (x - middle)) + own[x]
    flat = state.labels.reshape(-1)
    for q in range(layout.near.shape[1]):
        other = tied_to(layout, offsets, state, s, q)
        if other >= 0:
            first = n_levels - 1 - flat[other]
            tie = costs[q // 2, first : first + n_levels]
            for x in range(n_levels):
                out[x] += tie[x]


@compiled_as_is
def least_of(costs: Any) -> float:
    """Return the least of at least one cost; four chains, for one waits on each comparison."""
    a = b = c = d = costs[0]
    n = len(costs)
    for x in range(0, n - 3, 4):
        a = costs[x] if costs[x] < a else a
        b = costs[x + 1] if costs[x + 1] < b else b
        c = costs[x + 2] if costs[x + 2] < c else c
        d = costs[x + 3] if costs[x + 3] < d else d
    for x in range(n - n % 4, n):
        a = costs[x] if costs[x] < a else a
    return min(min(a, b), min(c, d))  # type: ignore[no-any-return]


@compiled_as_is
def line_rise(
    cliques: LineCliques, in_field: Any, offsets: Any, costs: Any, state: Sites, site: Any
) -> float:
    """Return the energy with a line on less that with it off (Eq. 5.20 to 5.22).

    ``site`` is its row of `Layout.sites`.
    """
    flat, columns = state.labels.reshape(-1), state.labels.shape[1]
    standing = site[7] == 1
    last = costs.shape[1] // 2
    rise = cliques.one - costs[0 if standing else 1, last + flat[site[1]] - flat[site[2]]]
    # Bits of `pattern_costs`: a vertical line is the upper one at its lower end, and so on.
    bit = 1 if standing else 4
    for end in range(3, 5):
        if site[end] >= 0:
            code = state.codes[site[end]]
            off = code & ~bit
            rise += cliques.pattern[off | bit] - cliques.pattern[off]
        bit *= 2
    for beside in range(5, 7):
        if site[beside] >= 0 and state.lines[site[beside]]:
            rise += cliques.parallel
    if len(offsets) > 2:
        i, j = site[1] // columns, site[1] % columns
        rise += far_rise(in_field, offsets, costs, state, standing, i, j)
    return rise  # type: ignore[no-any-return]


@compiled_as_is
def far_rise(
    in_field: Any, offsets: Any, costs: Any, state: Sites, standing: bool, i: int, j: int
) -> float:
    """Return what pairs of orders 2 and 3 add to `line_rise` of the line at (i, j)."""
    labels, across, down = state.labels, state.across, state.down
    rows, columns = in_field.shape
    lines = down if standing else across
    now = lines[i, j]
    rise = 0.0
    for a in range(max(i - 1, 0), i + 1):
        for b in range(max(j - 1, 0), min(j + 2, columns)):
            if not in_field[a, b]:
                continue
            for k in range(2, len(offsets)):
                di, dj = offsets[k, 0], offsets[k, 1]
                m, n = a + di, b + dj
                if m >= rows or n >= columns or n < 0 or not in_field[m, n]:
                    continue
                lines[i, j] = True
                cut = parted(across, down, a, b, di, dj)
                lines[i, j] = False
                if cut and not parted(across, down, a, b, di, dj):
                    rise -= costs[k, costs.shape[1] // 2 + labels[a, b] - labels[m, n]]
    lines[i, j] = now
    return rise


@compiled_as_is
def turn(state: Sites, site: Any, on: bool) -> None:
    """Turn a line on or off, and in the patterns of the corners at its ends."""
    state.lines[site[0]] = on
    bit = 1 if site[7] == 1 else 4
    for end in range(3, 5):
        if site[end] >= 0:
            code = state.codes[site[end]]
            state.codes[site[end]] = (code | bit) if on else (code & ~bit)
        bit *= 2
