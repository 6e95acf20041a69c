"""`polish`: moves of regions, chains, cells and lines in turn, none of which raises the energy."""

from __future__ import annotations

from tactile_graph_mrf.descent.box_moves import move_boxes
from tactile_graph_mrf.descent.chain_moves import PROPOSALS, move_chains
from tactile_graph_mrf.descent.modes import settle
from tactile_graph_mrf.descent.region_moves import shift_regions
from tactile_graph_mrf.energy.problem import Problem
from tactile_graph_mrf.energy.state import State
from tactile_graph_mrf.energy.total import energy
from tactile_graph_mrf.kernels import fit_for


def polish(problem: Problem, state: State, rounds: int, n_sweeps: int = 50) -> list[float]:
    """Lower the energy in place by moves of regions, chains, cells and lines; return energies.

    The energies never rise; it ends where no kind of move helps, or after ``rounds``.
    """
    trace: list[float] = []
    for _ in range(rounds):
        if shift_regions(problem, state) or not trace:
            trace.append(energy(problem, *state))
        low = trace[-1]  # what the moves of regions leave: they need no other look if it stays
        trace += _chains_moved(problem, state, rounds) if problem.model.order < 3 else []
        trace += settle(problem, state, n_sweeps)
        if _boxes_moved(problem, state):
            trace.append(energy(problem, *state))
        if not trace[-1] < low:
            break
    return trace


def _chains_moved(problem: Problem, state: State, rounds: int) -> list[float]:
    kernel = fit_for(move_chains, problem.in_field.size * PROPOSALS)
    trace: list[float] = []
    while len(trace) < rounds:
        changed = kernel(problem.potentials, problem.observed, state, True)
        changed += kernel(problem.potentials, problem.observed, state, False)
        if not changed:
            break
        trace.append(energy(problem, *state))
    return trace


def _boxes_moved(problem: Problem, state: State) -> bool:
    if problem.model.lines != "explicit" or problem.model.order > 1:
        return False
    kernel = fit_for(move_boxes, problem.in_field.size * PROPOSALS)
    return bool(kernel(problem.potentials, problem.observed, state))
