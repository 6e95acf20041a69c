"""Each visit of a sweep against the conditional distribution, from energies of the whole field."""

from __future__ import annotations

import numpy as np
import pytest

from helpers_modes import plainly
from helpers_mrf import tiny
from tactile_graph_mrf.energy.conditionals import difference_costs
from tactile_graph_mrf.energy.layout import layout
from tactile_graph_mrf.energy.problem import Problem
from tactile_graph_mrf.energy.state import Sites, State, sites_of
from tactile_graph_mrf.energy.total import energy
from tactile_graph_mrf.samplers.sweep import sweep_cells, sweep_lines

pytestmark = pytest.mark.usefixtures("plain_kernels")

BETA = 0.7
EVEN = (np.arange(60) + 0.5) / 60
SETTINGS = [
    {"order": 1},
    {"order": 2, "smoothness": "truncated_quadratic"},
    {"order": 3, "noise": "student_t"},
    {"lines": "marginal"},
    {"lines": "marginal", "lambda_d": 0.0},
    {"lines": "none", "noise": "laplace", "smoothness": "huber"},
]


def start_of(problem: Problem) -> tuple[Sites, np.ndarray]:
    """A state with some lines, and what differences cost."""
    rng = np.random.default_rng(8)
    some = 0.4 if problem.model.lines == "explicit" else 0.0
    lines = (sites & (rng.random(sites.shape) < some) for sites in problem.sites)
    costs = np.empty((len(problem.pairwise.weights), 2 * problem.n_levels - 1))
    difference_costs.loops(problem.pairwise, BETA, costs)
    return sites_of(State(rng.integers(0, problem.n_levels, problem.shape), *lines)), costs


def whole(problem: Problem, state: Sites, costs: np.ndarray) -> float:
    """The energy; of lines that are summed out, at this temperature."""
    if problem.model.lines != "marginal":
        return energy(problem, state.labels, state.across, state.down)
    labels, last = state.labels, problem.n_levels - 1
    bonds = [costs[0, last + np.diff(labels, axis=axis)].sum() for axis in (0, 1)]
    own = problem.own_costs()[*np.indices(labels.shape), labels].sum()
    return float(own + sum(bonds))


@pytest.mark.slow
@pytest.mark.parametrize("settings", SETTINGS, ids=str)
def test_a_cell_is_drawn_from_what_the_others_leave_it(settings: dict) -> None:
    problem = tiny(3, 3, n_levels=4, **settings)
    (state, costs), tables = start_of(problem), layout(problem)
    draw = plainly(sweep_cells)
    for s, cell in enumerate(tables.cells.tolist()):
        at = divmod(cell, 3)
        was = state.labels[at]
        energies = np.empty(4)
        for x in range(4):
            state.labels[at] = x
            energies[x] = whole(problem, state, costs)
        chances = np.exp(-BETA * (energies - energies.min()))
        one = tables._replace(
            cells=tables.cells[s : s + 1], near=tables.near[s : s + 1], cut=tables.cut[s : s + 1]
        )
        seen = np.zeros(4)
        for u in EVEN:
            state.labels[at] = was
            told = (problem.potentials, costs, problem.gaussian, one, BETA, np.array([u]), state)
            changed, certain = draw(*told)
            assert changed == (state.labels[at] != was)
            assert not certain
            seen[state.labels[at]] += 1
        state.labels[at] = was
        assert np.abs(seen - 60 * chances / chances.sum()).max() <= 1.001, cell


@pytest.mark.slow
@pytest.mark.parametrize("order", [1, 2, 3])
def test_a_line_is_drawn_from_what_the_others_leave_it(order: int) -> None:
    problem = tiny(3, 3, n_levels=4, order=order)
    (state, costs), tables = start_of(problem), layout(problem)
    draw, kept = plainly(sweep_lines), state.lines.copy()
    for s, site in enumerate(tables.sites):
        one, line = tables.sites[s : s + 1], site[0]
        told = problem.potentials, costs, one, BETA
        seen = 0
        for u in EVEN:
            was = state.lines[line]
            changed, certain = draw(*told, np.array([u]), state)
            assert changed == (state.lines[line] != was)
            assert not certain
            seen += int(state.lines[line])
        both = []
        for on in (False, True):
            state.lines[line] = on
            both.append(whole(problem, state, costs))
        assert abs(seen - 60 / (1 + np.exp(BETA * (both[1] - both[0])))) <= 0.501
        state.lines[line] = kept[line]
        state.codes[:] = sites_of(State(state.labels, state.across, state.down)).codes


def test_a_cell_that_nothing_holds_has_any_label_and_is_never_certain() -> None:
    problem = tiny(1, 3, n_levels=4, lambda_d=0.0, lines="none")
    problem.unary.curvature[0, 1] = 0.0
    (state, costs), tables = start_of(problem), layout(problem)
    where = tables.cells.tolist().index(1)
    uniforms = np.full(3, 0.5)
    for u, label in ((0.1, 0), (0.3, 1), (0.6, 2), (0.9, 3)):
        uniforms[where] = u
        told = (problem.potentials, costs, problem.gaussian, tables, 1e9, uniforms, state)
        assert not plainly(sweep_cells)(*told)[1]
        assert state.labels[0, 1] == label


def test_the_coldest_cells_are_certain_and_so_is_what_changed() -> None:
    problem = tiny(2, 2, n_levels=4, lines="none")
    (state, costs), tables = start_of(problem), layout(problem)
    told = (problem.potentials, costs, problem.gaussian, tables, 1e9, np.full(4, 0.3), state)
    for _ in range(5):
        changed, certain = plainly(sweep_cells)(*told)
        assert certain
    assert not changed
