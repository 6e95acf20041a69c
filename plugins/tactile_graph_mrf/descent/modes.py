"""Iterated conditional modes: each cell and line its best state in turn, until none changes."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from tactile_graph.compiled import compiled_as_is
from tactile_graph_mrf.energy.conditionals import (
    difference_costs,
    far_parted,
    far_rise,
    least_of,
    line_rise,
    turn,
)
from tactile_graph_mrf.energy.layout import Layout, layout
from tactile_graph_mrf.energy.potentials import Potentials
from tactile_graph_mrf.energy.problem import Problem
from tactile_graph_mrf.energy.state import Sites, State, sites_of
from tactile_graph_mrf.energy.total import total


@compiled_as_is
def take_modes(
    potentials: Potentials, gaussian: bool, layout: Layout, state: Sites, trace: Any
) -> int:
    """Sweep until nothing changes, or ``trace`` is full of energies; return how many sweeps."""
    pairwise = potentials.pairwise
    costs = np.empty((len(pairwise.weights), 2 * len(pairwise.bare) - 1))
    difference_costs(pairwise, math.inf, costs)
    for t in range(len(trace)):
        changed = label_modes(potentials, costs, gaussian, layout, state)
        changed = line_modes(potentials, costs, layout.sites, state) or changed
        trace[t] = total(potentials, state.labels, state.across, state.down)
        if not changed:
            return t + 1
    return len(trace)


@compiled_as_is
def label_modes(
    potentials: Potentials, costs: Any, gaussian: bool, layout: Layout, state: Sites
) -> bool:
    """Give each cell its best label, the present one if tied; return whether any changed."""
    _, curvature, centre, table, row = potentials.unary
    offsets = potentials.pairwise.offsets
    cells, near, cut, _, _ = layout
    labels, lines, across, down, _ = state
    flat, curvatures, centres = labels.reshape(-1), curvature.reshape(-1), centre.reshape(-1)
    rows_of = row.reshape(-1)
    n_levels = costs.shape[1] // 2 + 1
    buffer = np.empty(n_levels)
    changed = False
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
                weight = costs[q // 2, n_levels]
                sharpness += weight
                pull += weight * flat[other]
            else:
                first = n_levels - 1 - flat[other]
                tie = costs[q // 2, first : first + n_levels]
                for x in range(n_levels):
                    buffer[x] += tie[x]
        label = flat[cell]
        if not gaussian:
            least = least_of(buffer)
            if buffer[label] != least:
                label = 0
                while buffer[label] != least:
                    label += 1
        elif sharpness > 0.0:
            nearest = math.floor(pull / sharpness + 0.5)
            label = int(min(max(nearest, 0.0), n_levels - 1.0))
        if label != flat[cell]:
            flat[cell] = label
            changed = True
    return changed


@compiled_as_is
def line_modes(potentials: Potentials, costs: Any, sites: Any, state: Sites) -> bool:
    """Turn each line on or off as is best, leave it if tied; return whether any changed."""
    in_field, offsets = potentials.unary.in_field, potentials.pairwise.offsets
    pattern, parallel, one = potentials.lines
    labels, lines, across, down, codes = state
    flat, last = labels.reshape(-1), costs.shape[1] // 2
    changed = False
    for s in range(len(sites)):
        site = sites[s]
        standing = site[7] == 1
        cost = costs[0 if standing else 1, last + flat[site[1]] - flat[site[2]]]
        rise = line_rise(pattern, parallel, one, cost, site, lines, codes)
        if len(offsets) > 2:
            rise += far_rise(in_field, offsets, costs, labels, across, down, site)
        was = lines[site[0]]
        on = rise < 0.0 or (rise == 0.0 and was)
        if on != was:
            turn(site, on, lines, codes)
            changed = True
    return changed


def settle(problem: Problem, state: State, n_sweeps: int) -> list[float]:
    """Sweep until nothing changes; write into ``state``, return the energy after each sweep."""
    tables = layout(problem)
    sites, trace = sites_of(state), np.empty(n_sweeps)
    done = take_modes.call(problem.potentials, problem.gaussian, tables, sites, trace)
    state.across[...], state.down[...] = sites.across, sites.down
    found: list[float] = trace[:done].tolist()
    return found
