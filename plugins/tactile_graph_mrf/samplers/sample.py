"""The kernel of `posterior`: sweeps at one temperature and the sums of what they visit."""

from __future__ import annotations

import math

import numpy as np

from tactile_graph.compiled import compiled_as_is
from tactile_graph_mrf.energy.line_rise import corner_codes
from tactile_graph_mrf.energy.total import total
from tactile_graph_mrf.samplers.sweep import clique_costs, sweep


@compiled_as_is
def sample(  # type: ignore[no-untyped-def]
    in_field, curvature, centre, table, row, smooth, offsets, weights, pattern, parallel, one,
    bare, price, gaussian, cells, near, cut, sites, corners,
    beta, uniforms, labels, lines, across, down, origin, sums, squares, on, probes, seen,
):  # fmt: skip
    """Take a sample after each group of sweeps in ``uniforms`` (samples, sweeps, visits).

    Adds the labels less ``origin`` and their squares to ``sums`` and ``squares``, the lines to
    ``on``; writes the labels of ``probes`` and the energy into ``seen`` (samples, probes + 1).
    """
    n_levels = len(bare)
    costs = np.empty((len(weights), 2 * n_levels - 1))
    buffer, kept = np.empty(n_levels), np.empty(n_levels, np.int64)
    codes = np.empty(corners.size, np.int64)
    corner_codes(across, down, corners, codes)
    clique_costs(bare, weights, price, beta, costs)
    flat = labels.reshape(-1)
    for t in range(uniforms.shape[0]):
        for s in range(uniforms.shape[1]):
            sweep(
                in_field, curvature, centre, table, row, offsets, pattern, parallel, one, costs,
                gaussian, cells, near, cut, sites, beta, uniforms[t, s], labels, lines, across,
                down, codes, buffer, kept,
            )  # fmt: skip
        for i in range(labels.shape[0]):
            for j in range(labels.shape[1]):
                off = labels[i, j] - origin[i, j]
                sums[i, j] += off
                squares[i, j] += off * off
        if price >= 0.0:
            add_chances(bare, price, beta, in_field, labels, on)
        else:
            for k in range(len(lines)):
                on[k] += lines[k]
        for q in range(len(probes)):
            seen[t, q] = flat[probes[q]]
        seen[t, len(probes)] = total(
            in_field, curvature, centre, table, row, smooth, offsets, weights, pattern, parallel,
            one, labels, across, down,
        )  # fmt: skip


@compiled_as_is
def add_chances(bare, price, beta, in_field, labels, on):  # type: ignore[no-untyped-def]
    """Add to ``on`` the probability of each line that is summed out, given the labels.

    It is 1 / (1 + exp(beta (price - rho))), which spares the noise of drawing the line.
    """
    rows, columns = labels.shape
    n_across = (rows - 1) * columns
    for i in range(rows):
        for j in range(columns):
            for way in range(2):
                m, n = (i + 1, j) if way == 0 else (i, j + 1)
                if m >= rows or n >= columns or not (in_field[i, j] and in_field[m, n]):
                    continue
                height = beta * (price - bare[abs(labels[i, j] - labels[m, n])])
                k = i * columns + j if way == 0 else n_across + i * (columns - 1) + j
                if height > 0.0:
                    chance = math.exp(-height)
                    on[k] += chance / (1.0 + chance)
                else:
                    on[k] += 1.0 / (1.0 + math.exp(height))
