"""`polish`: moves of regions, chains, cells and lines in turn, none of which raises the energy."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from tactile_graph.compiled import compiled_as_is
from tactile_graph_mrf.descent.box_moves import move_boxes
from tactile_graph_mrf.descent.chain_moves import move_chains
from tactile_graph_mrf.descent.modes import take_modes
from tactile_graph_mrf.descent.region_moves import pairs_stand_alone, shift_regions
from tactile_graph_mrf.energy.conditionals import write_codes
from tactile_graph_mrf.energy.layout import Layout, layout
from tactile_graph_mrf.energy.potentials import Potentials
from tactile_graph_mrf.energy.problem import Problem
from tactile_graph_mrf.energy.state import Sites, State, sites_of
from tactile_graph_mrf.energy.total import total

SWEEPS = 50
"""Of single cells and lines in each round, at most."""


class Moves(NamedTuple):
    """What is tried.

    Parameters
    ----------
    rounds : int
        Times at most; in each, chains are moved as often.
    regions, chains, boxes : bool
        Whether sets of cells, rows and columns, and cells with the lines around them are moved.
    gaussian : bool
        Whether every cell's conditional energy is a parabola.
    """

    rounds: int
    regions: bool
    chains: bool
    boxes: bool
    gaussian: bool


def polish(problem: Problem, state: State, rounds: int) -> list[float]:
    """Lower the energy in place by moves of regions, chains, cells and lines; return energies.

    The energies never rise; it ends where no kind of move helps, or after ``rounds``.
    """
    order, explicit = problem.model.order, problem.model.lines == "explicit"
    boxes = explicit and order == 1
    moves = Moves(rounds, pairs_stand_alone(problem), order < 3, boxes, problem.gaussian)
    sites, tables = sites_of(state), layout(problem)
    trace = polish_all.call(problem.potentials, problem.observed, moves, tables, sites)
    state.across[...], state.down[...] = sites.across, sites.down
    found: list[float] = trace.tolist()
    return found


@compiled_as_is
def polish_all(
    potentials: Potentials, observed: Any, moves: Moves, layout: Layout, state: Sites
) -> NDArray[np.float64]:
    """Move in turn until nothing helps; return the energies."""
    rounds, gaussian = moves.rounds, moves.gaussian
    labels, _, across, down, codes = state
    trace = np.empty(rounds * (rounds + SWEEPS + 2))
    n = 0
    for _ in range(rounds):
        shifted = moves.regions and shift_regions(potentials, layout, state) > 0
        if shifted or n == 0:
            trace[n] = total(potentials, labels, across, down)
            n += 1
        low = trace[n - 1]  # what the moves of regions leave: they need no other look if it stays
        grids = State(labels, across, down)
        n += chain_rounds(potentials, observed, grids, trace[n : n + rounds * moves.chains])
        write_codes(across, down, codes)
        n += take_modes(potentials, gaussian, layout, state, trace[n : n + SWEEPS])
        if moves.boxes and move_boxes(potentials, observed, grids) > 0:
            trace[n] = total(potentials, labels, across, down)
            n += 1
        if not trace[n - 1] < low:
            break
    return trace[:n].copy()


@compiled_as_is
def chain_rounds(potentials: Potentials, observed: Any, state: State, trace: Any) -> int:
    """Move rows and columns until none changes, or ``trace`` is full of energies; count those."""
    for t in range(len(trace)):
        changed = 0
        for i in range(2):  # of one call: two would be compiled twice
            changed += move_chains(potentials, observed, state, i == 0)
        if not changed:
            return t
        trace[t] = total(potentials, state.labels, state.across, state.down)
    return len(trace)
