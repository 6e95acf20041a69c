"""What one site costs given all others, against the energy of the whole field."""

from __future__ import annotations

import math

import numpy as np
import pytest

from helpers_modes import plainly
from helpers_mrf import RHO, picture
from tactile_graph.wires import Image, Mask
from tactile_graph_mrf.energy.conditionals import (
    difference_costs,
    far_parted,
    far_rise,
    least_of,
    line_rise,
    turn,
    write_codes,
)
from tactile_graph_mrf.energy.layout import layout
from tactile_graph_mrf.energy.model import Model
from tactile_graph_mrf.energy.problem import Problem, prepare
from tactile_graph_mrf.energy.state import Sites, State, sites_of
from tactile_graph_mrf.energy.total import energy, parted

pytestmark = pytest.mark.usefixtures("plain_kernels")

L = 6


@pytest.fixture(params=[1, 2, 3])
def problem(request: pytest.FixtureRequest) -> Problem:
    """A field of 5 x 4 cells with holes."""
    on = np.ones((5, 4), bool)
    on[1, 0] = on[4, 3] = False
    costs = {"end": 2.7, "straight": 0.9, "corner": 1.3, "tee": 2.1, "cross": 3.3}
    model = Model(
        n_levels=L, order=request.param, parallel=1.7, one=0.4, lambda_l=0.7, lambda_d=0.9, **costs
    )
    return prepare(model, picture(5, 4), Mask(on))


def lined(problem: Problem) -> Sites:
    rng = np.random.default_rng(3)
    lines = (sites & (rng.random(sites.shape) < 0.5) for sites in problem.sites)
    return sites_of(State(rng.integers(0, L, problem.shape), *lines))


def differences(problem: Problem, beta: float = math.inf) -> np.ndarray:
    costs = np.full((len(problem.pairwise.weights), 2 * L - 1), np.nan)
    difference_costs.loops(problem.pairwise, beta, costs)
    return costs


@pytest.mark.parametrize("beta", [1e-3, 0.5, 7.0, 900.0, math.inf])
@pytest.mark.parametrize("lines", ["none", "marginal"])
def test_differences_cost_what_is_left_when_the_line_is_summed_out(lines: str, beta: float) -> None:
    model = Model(n_levels=L, order=2, lines=lines, lambda_d=0.6, lambda_l=2.0)
    problem = prepare(model, Image(np.arange(4.0).reshape(2, 2)))
    price = problem.pairwise.price
    assert (price > 0) == (lines == "marginal")
    found = differences(problem, beta)
    for k, weight in enumerate((1.0, 1.0, 0.5, 0.5)):
        for d in range(-L + 1, L):
            bond = wanted = weight * 0.6 * RHO[model.smoothness](abs(d), model.truncation)
            if lines == "marginal":
                wanted = min(bond, weight * price)
                if beta < math.inf:
                    wanted = -np.logaddexp(-beta * bond, -beta * weight * price) / beta
            assert found[k, L - 1 + d] == pytest.approx(wanted, rel=1e-12, abs=1e-12), (k, d)


def test_a_line_rises_the_energy_by_what_the_whole_field_says(problem: Problem) -> None:
    state, tables, costs = lined(problem), layout(problem), differences(problem)
    pattern, parallel, one = problem.line_cliques
    labels = state.labels.reshape(-1)
    assert len(tables.sites) > 20
    for site in tables.sites:
        now = state.lines[site[0]]
        both = []
        for on in (False, True):
            plainly(turn)(site, on, state.lines, state.codes)
            both.append(energy(problem, state.labels, state.across, state.down))
        plainly(turn)(site, now, state.lines, state.codes)
        kind = 0 if site[7] == 1 else 1
        pair = costs[kind, L - 1 + labels[site[1]] - labels[site[2]]]
        rise = plainly(line_rise)(pattern, parallel, one, pair, site, state.lines, state.codes)
        before = state.lines.copy()
        rise += plainly(far_rise)(
            *(problem.in_field, problem.pairwise.offsets, costs, state.labels),
            *(state.across, state.down, site),
        )
        assert rise == pytest.approx(both[1] - both[0], abs=1e-9), site
        np.testing.assert_array_equal(state.lines, before)


def test_codes_are_the_lines_that_meet_at_a_corner_and_go_with_each_turn(problem: Problem) -> None:
    state, tables = lined(problem), layout(problem)
    for site in tables.sites:
        plainly(turn)(site, not state.lines[site[0]], state.lines, state.codes)
    wanted = np.zeros_like(state.codes)
    plainly(write_codes)(state.across, state.down, wanted)
    whole = tables.corners.reshape(-1)
    np.testing.assert_array_equal(state.codes[whole], wanted[whole])
    for corner, code in enumerate(wanted.tolist()):
        i, j = divmod(corner, 3)
        lines = state.down[i, j], state.down[i + 1, j], state.across[i, j], state.across[i, j + 1]
        assert code == sum(int(on) << k for k, on in enumerate(lines))


def test_far_pairs_are_parted_alike_from_both_ends(problem: Problem) -> None:
    state, tables = lined(problem), layout(problem)
    offsets = problem.pairwise.offsets
    for cell, near in zip(tables.cells.tolist(), tables.near.tolist(), strict=True):
        for q in range(4, len(near)):
            if near[q] < 0:
                continue
            found = plainly(far_parted)(state.across, state.down, offsets, cell, near[q], q)
            first = min(cell, near[q])
            step = offsets[q // 2]
            at = divmod(first, 4)
            assert found == plainly(parted)(state.across, state.down, *at, *step.tolist())


@pytest.mark.parametrize("n", range(1, 12))
def test_the_least_of_any_number_of_costs_wherever_it_is(n: int) -> None:
    for at in range(n):
        costs = np.linspace(2.0, 3.0, n)
        costs[at] = 1.0
        assert least_of.loops(costs) == 1.0
