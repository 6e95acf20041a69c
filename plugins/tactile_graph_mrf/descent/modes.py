"""Iterated conditional modes: each cell and line its best state in turn, until none changes."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from tactile_graph.compiled import compiled_as_is
from tactile_graph_mrf.energy.conditionals import (
    cell_costs,
    cell_parabola,
    difference_costs,
    least_of,
    line_rise,
    turn,
)
from tactile_graph_mrf.energy.layout import Layout, layout
from tactile_graph_mrf.energy.potentials import Potentials
from tactile_graph_mrf.energy.problem import Problem
from tactile_graph_mrf.energy.state import Sites, State, sites_of
from tactile_graph_mrf.energy.total import total
from tactile_graph_mrf.kernels import fit_for


@compiled_as_is
def take_modes(
    potentials: Potentials, gaussian: bool, layout: Layout, state: Sites, trace: Any
) -> int:
    """Sweep until nothing changes, or ``trace`` is full of energies; return how many sweeps."""
    pairwise = potentials.pairwise
    offsets, in_field = pairwise.offsets, potentials.unary.in_field
    costs = np.empty((len(pairwise.weights), 2 * len(pairwise.bare) - 1))
    difference_costs(pairwise, math.inf, costs)
    for t in range(len(trace)):
        changed = label_modes(potentials, costs, gaussian, layout, state)
        for s in range(len(layout.sites)):
            site = layout.sites[s]
            rise = line_rise(potentials.lines, in_field, offsets, costs, state, site)
            was = state.lines[site[0]]
            on = rise < 0.0 or (rise == 0.0 and was)
            if on != was:
                turn(state, site, on)
                changed = True
        trace[t] = total(potentials, state.labels, state.across, state.down)
        if not changed:
            return t + 1
    return len(trace)


@compiled_as_is
def label_modes(
    potentials: Potentials, costs: Any, gaussian: bool, layout: Layout, state: Sites
) -> bool:
    """Give each cell its best label, the present one if tied; return whether any changed."""
    unary, offsets = potentials.unary, potentials.pairwise.offsets
    flat = state.labels.reshape(-1)
    n_levels = costs.shape[1] // 2 + 1
    buffer = np.empty(n_levels)
    changed = False
    for s in range(len(layout.cells)):
        now = flat[layout.cells[s]]
        label = now
        if gaussian:
            sharpness, pull = cell_parabola(unary, offsets, costs, layout, state, s)
            if sharpness > 0.0:
                middle = math.floor(pull / sharpness + 0.5)
                label = int(min(max(middle, 0.0), n_levels - 1.0))
        else:
            cell_costs(unary, offsets, costs, layout, state, s, buffer)
            least = least_of(buffer)
            if buffer[now] != least:
                label = 0
                while buffer[label] != least:
                    label += 1
        if label != now:
            flat[layout.cells[s]] = label
            changed = True
    return changed


def settle(problem: Problem, state: State, n_sweeps: int) -> list[float]:
    """Sweep until nothing changes; write into ``state``, return the energy after each sweep."""
    tables = layout(problem)
    visits = len(tables.cells) + len(tables.sites)
    kernel = fit_for(take_modes, visits * n_sweeps * problem.levels_per_draw)
    sites, trace = sites_of(state), np.empty(n_sweeps)
    done = kernel(problem.potentials, problem.gaussian, tables, sites, trace)
    state.across[...], state.down[...] = sites.across, sites.down
    found: list[float] = trace[:done].tolist()
    return found
