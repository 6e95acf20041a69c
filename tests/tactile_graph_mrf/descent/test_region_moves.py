"""Moves of regions: what is counted, and that cells stay on the scale."""

from __future__ import annotations

import numpy as np
import pytest

from helpers_modes import plainly
from helpers_mrf import label_energies, label_states, tiny
from tactile_graph_mrf.descent.region_moves import fuse_all, shift_regions
from tactile_graph_mrf.energy.layout import layout
from tactile_graph_mrf.energy.state import State, sites_of

pytestmark = pytest.mark.usefixtures("plain_kernels")


def test_without_smoothness_every_cell_goes_level_by_level_to_its_datum() -> None:
    problem = tiny(3, 3, n_levels=5, lambda_d=0.0, lines="none")
    labels = np.random.default_rng(1).integers(0, 5, (3, 3))
    wanted = int(np.abs(labels - problem.observed).sum())
    state = sites_of(State(labels, np.zeros((2, 3), bool), np.zeros((3, 2), bool)))
    assert plainly(shift_regions)(problem.potentials, layout(problem), state) == wanted > 5
    np.testing.assert_array_equal(labels, problem.observed)


@pytest.mark.slow
@pytest.mark.parametrize("order", [1, 2, 3])
@pytest.mark.parametrize("start", [0, 3])
def test_shifts_of_regions_end_at_the_very_minimum_of_convex_costs(start: int, order: int) -> None:
    problem = tiny(2, 3, n_levels=4, order=order, lines="none", lambda_d=1.3)
    labels = np.full((2, 3), start)
    state = sites_of(State(labels, np.zeros((1, 3), bool), np.zeros((2, 2), bool)))
    assert plainly(shift_regions)(problem.potentials, layout(problem), state) > 0
    least = label_energies(problem, label_states(6, 4)).min()
    assert label_energies(problem, labels.reshape(1, 6))[0] == pytest.approx(least, abs=1e-9)


@pytest.mark.parametrize("order", [1, 2])
def test_fusion_takes_the_best_set_of_two_labels(order: int) -> None:
    problem = tiny(3, 3, n_levels=2, order=order, lines="none", lambda_d=0.4)
    labels, target = np.zeros((3, 3), np.int64), np.ones(9, np.int64)
    state = sites_of(State(labels, np.zeros((2, 3), bool), np.zeros((3, 2), bool)))
    n_changed = plainly(fuse_all)(problem.potentials, layout(problem), state, target)
    assert n_changed == labels.sum() > 0
    least = label_energies(problem, label_states(9, 2)).min()
    assert label_energies(problem, labels.reshape(1, 9))[0] == pytest.approx(least, abs=1e-9)
