"""Kernels of the conditionals: what one cell's label, or one line, costs given all others.

Samplers draw from them (Eq. 5.9, 5.10, 5.19); descents take the least. What is called for each
cell or line takes arrays, not records: taking one out of a record costs more than its use.
"""

from __future__ import annotations

import math
from typing import Any

from tactile_graph.compiled import compiled_as_is
from tactile_graph_mrf.energy.potentials import Pairwise
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
def far_parted(across: Any, down: Any, offsets: Any, cell: int, other: int, q: int) -> bool:
    """Return whether lines part a cell from the other one of a pair of orders 2 or 3.

    ``q`` is the pair's column of `Layout.near`.
    """
    columns = across.shape[1]
    base = other if q % 2 else cell
    i, j = base // columns, base % columns
    return parted(across, down, i, j, offsets[q // 2, 0], offsets[q // 2, 1])


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
    pattern: Any, parallel: float, one: float, cost: float, site: Any, lines: Any, codes: Any
) -> float:
    """Return the energy with a line on less that with it off (Eq. 5.20 to 5.22).

    ``cost`` is that of the pair it parts, ``site`` its row of `Layout.sites`; ``codes`` hold
    the pattern of lines on at each corner.
    """
    rise = one - cost
    # Bits of `pattern_costs`: a vertical line is the upper one at its lower end, and so on.
    bit = 1 if site[7] == 1 else 4
    for end in range(3, 5):
        if site[end] >= 0:
            code = codes[site[end]]
            off = code & ~bit
            rise += pattern[off | bit] - pattern[off]
        bit *= 2
    for beside in range(5, 7):
        if site[beside] >= 0 and lines[site[beside]]:
            rise += parallel
    return rise


@compiled_as_is
def far_rise(
    in_field: Any, offsets: Any, costs: Any, labels: Any, across: Any, down: Any, site: Any
) -> float:
    """Return what pairs of orders 2 and 3 add to `line_rise`."""
    rows, columns = in_field.shape
    i, j = site[1] // columns, site[1] % columns
    lines = down if site[7] == 1 else across
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
def turn(site: Any, on: bool, lines: Any, codes: Any) -> None:
    """Turn a line on or off, in ``lines`` and in the patterns of the corners at its ends."""
    lines[site[0]] = on
    bit = 1 if site[7] == 1 else 4
    for end in range(3, 5):
        if site[end] >= 0:
            codes[site[end]] = (codes[site[end]] | bit) if on else (codes[site[end]] & ~bit)
        bit *= 2


@compiled_as_is
def write_codes(across: Any, down: Any, codes: Any) -> None:
    """Write the pattern of lines on at each corner."""
    rows, columns = down.shape[0], across.shape[1]
    for i in range(rows - 1):
        for j in range(columns - 1):
            code = 1 * down[i, j] + 2 * down[i + 1, j] + 4 * across[i, j] + 8 * across[i, j + 1]
            codes[i * (columns - 1) + j] = code
