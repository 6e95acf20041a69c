"""Kernels of the samplers: sweeps of the Gibbs sampler over cells and lines (section 5.2.3)."""

from __future__ import annotations

from typing import Any

import numpy as np

from tactile_graph.compiled import compiled_as_is
from tactile_graph_mrf.energy.conditionals import (
    difference_costs,
    far_parted,
    far_rise,
    line_rise,
    turn,
)
from tactile_graph_mrf.energy.layout import Layout
from tactile_graph_mrf.energy.potentials import Potentials
from tactile_graph_mrf.energy.state import Sites
from tactile_graph_mrf.energy.total import total
from tactile_graph_mrf.samplers.draws import draw_cost, draw_line, draw_parabola


@compiled_as_is
def sweep_cells(
    potentials: Potentials, costs: Any, gaussian: bool, layout: Layout, beta: float, uniforms: Any,
    state: Sites,
) -> tuple[bool, bool]:  # fmt: skip
    """Visit each cell once; return (whether any changed, whether none could).

    ``costs`` are `difference_costs` at this inverse temperature; ``gaussian`` is whether every
    conditional is a parabola.
    """
    _, curvature, centre, table, row = potentials.unary
    offsets = potentials.pairwise.offsets
    cells, near, cut, _, _ = layout
    labels, lines, across, down, _ = state
    flat, curvatures, centres = labels.reshape(-1), curvature.reshape(-1), centre.reshape(-1)
    rows_of = row.reshape(-1)
    n_levels = costs.shape[1] // 2 + 1
    buffer, kept = np.empty(n_levels), np.empty(n_levels, np.int64)
    changed, certain = False, True
    for s in range(len(cells)):
        cell = cells[s]
        sharpness, middle = curvatures[cell], centres[cell]
        pull = sharpness * middle
        if not gaussian:
            own = table[rows_of[cell]]
            for x in range(n_levels):
                buffer[x] = sharpness * ((x - middle) * (x - middle)) + own[x]
        for q in range(near.shape[1]):
            other = near[s, q]
            if other < 0 or (q < 4 and lines[cut[s, q]]):
                continue
            if q >= 4 and far_parted(across, down, offsets, cell, other, q):
                continue
            if gaussian:
                # Less what an equal pair costs: a line that is summed out costs that one, too.
                weight = costs[q // 2, n_levels] - costs[q // 2, n_levels - 1]
                sharpness += weight
                pull += weight * flat[other]
            else:
                first = n_levels - 1 - flat[other]
                tie = costs[q // 2, first : first + n_levels]
                for x in range(n_levels):
                    buffer[x] += tie[x]
        if not gaussian:
            label, sure = draw_cost(buffer, kept, beta, uniforms[s])
        elif sharpness > 0.0:
            label, sure = draw_parabola(sharpness, pull / sharpness, n_levels, beta, uniforms[s])
        else:
            label, sure = int(uniforms[s] * n_levels), False
        certain = certain and sure
        if label != flat[cell]:
            flat[cell] = label
            changed = True
    return changed, certain


@compiled_as_is
def sweep_lines(
    potentials: Potentials, costs: Any, sites: Any, beta: float, uniforms: Any, state: Sites
) -> tuple[bool, bool]:
    """Visit each line site once; return (whether any changed, whether none could)."""
    in_field, offsets = potentials.unary.in_field, potentials.pairwise.offsets
    pattern, parallel, one = potentials.lines
    labels, lines, across, down, codes = state
    flat, last = labels.reshape(-1), costs.shape[1] // 2
    changed, certain = False, True
    for s in range(len(sites)):
        site = sites[s]
        standing = site[7] == 1
        cost = costs[0 if standing else 1, last + flat[site[1]] - flat[site[2]]]
        rise = line_rise(pattern, parallel, one, cost, site, lines, codes)
        if len(offsets) > 2:
            rise += far_rise(in_field, offsets, costs, labels, across, down, site)
        on, sure = draw_line(rise, beta, uniforms[s])
        certain = certain and sure
        if on != lines[site[0]]:
            turn(site, on, lines, codes)
            changed = True
    return changed, certain


@compiled_as_is
def anneal(
    potentials: Potentials, gaussian: bool, layout: Layout, betas: Any, uniforms: Any,
    state: Sites, trace: Any,
) -> tuple[int, bool]:  # fmt: skip
    """Sweep at each inverse temperature in turn; return how many sweeps, and whether all froze.

    ``uniforms`` (sweeps, visits) are the random numbers. Writes labels, lines and the energy
    after each sweep. Stops after a sweep that changed nothing and could have changed nothing:
    while ``betas`` do not fall, none ever will.
    """
    pairwise = potentials.pairwise
    n = len(layout.cells)
    costs = np.empty((len(pairwise.weights), 2 * len(pairwise.bare) - 1))
    for t in range(len(betas)):
        if t == 0 or pairwise.price >= 0.0:
            difference_costs(pairwise, betas[t], costs)
        changed, certain = sweep_cells(
            potentials, costs, gaussian, layout, betas[t], uniforms[t, :n], state
        )
        turned, sure = sweep_lines(
            potentials, costs, layout.sites, betas[t], uniforms[t, n:], state
        )
        trace[t] = total(potentials, state.labels, state.across, state.down)
        if certain and sure and not (changed or turned):
            return t + 1, True
    return len(betas), False
