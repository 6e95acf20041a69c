"""Iterated conditional modes: no sweep raises the energy, and no single change lowers the end."""

from __future__ import annotations

import numpy as np
import pytest

from helpers_mrf import label_energies, label_states, picture, tiny
from tactile_graph.wires import Image, Mask
from tactile_graph_mrf.descent.icm import icm
from tactile_graph_mrf.descent.modes import settle
from tactile_graph_mrf.energy.model import Model
from tactile_graph_mrf.energy.problem import prepare
from tactile_graph_mrf.energy.state import observed_state
from tactile_graph_mrf.energy.total import energy

pytestmark = pytest.mark.slow

MODELS = [
    Model(n_levels=12, lambda_l=10.0),
    Model(n_levels=12, lambda_l=10.0, order=3),
    Model(n_levels=12, lines="marginal", lambda_l=10.0, noise="student_t", sigma=2.0),
    Model(n_levels=12, lines="none", smoothness="absolute", order=2),
]


@pytest.mark.slow
@pytest.mark.parametrize("model", MODELS, ids=str)
def test_it_ends_where_no_single_cell_or_line_can_lower_the_energy(model):
    problem = prepare(model, picture(6, 5, noise=0.2))
    state = observed_state(problem)
    trace = settle(problem, state, 100)
    assert len(trace) < 100
    assert (np.diff([energy(problem, *observed_state(problem)), *trace]) <= 1e-9).all()
    least = energy(problem, *state) - 1e-9
    for cell in np.ndindex(problem.shape):
        kept = state.labels[cell]
        for level in range(12):
            state.labels[cell] = level
            assert energy(problem, *state) >= least
        state.labels[cell] = kept
    if model.lines != "explicit":
        return
    for lines in (state.across, state.down):
        for site in np.ndindex(lines.shape):
            lines[site] = not lines[site]
            assert energy(problem, *state) >= least
            lines[site] = not lines[site]


def test_convex_energies_of_a_tiny_field_come_close_to_their_minimum():
    problem = tiny(lines="none")
    state = observed_state(problem)
    trace = settle(problem, state, 100)
    energies = np.sort(label_energies(problem, label_states(9, 4)))
    assert energies[0] - 1e-9 <= trace[-1] <= energies[10]


def test_energy_and_trace_are_those_of_the_model():
    restored = icm(picture())
    assert restored.energy == pytest.approx(restored.trace[-1])
    assert restored.sweeps == len(restored.trace)
    assert icm(picture(), n_sweeps=2).sweeps == 2


def test_constant_images_are_not_swept_and_ties_stay():
    assert icm(Image(np.ones((3, 3)))).sweeps == 0
    image = picture(5, 5)
    free = icm(image, model=Model(noise="laplace", lambda_d=0.0, lambda_l=0.0, lines="none"))
    step = np.ptp(image.values) / 199
    assert np.abs(free.image.values - image.values).max() <= step / 2 * 1.001


def test_a_region_is_restored_as_if_cut_out():
    image = picture(8, 12)
    on = np.zeros((8, 12), np.bool_)
    on[1:6, 3:9] = True  # an even way off, so that both go by the same colours
    within, alone = icm(image, Mask(on)), icm(Image(image.values[1:6, 3:9].copy()))
    np.testing.assert_allclose(within.image.values[1:6, 3:9], alone.image.values)
    assert within.energy == pytest.approx(alone.energy)
    assert within.lines.count == alone.lines.count
    assert (within.image.values[~on] == image.values[~on]).all()


def test_the_expected_load_draws_the_restoration_to_it():
    image = picture()
    expected = Image(np.full((16, 16), 0.4))
    near = icm(image, None, expected, model=Model(lambda_prior=1e6))
    assert np.abs(near.image.values - 0.4).max() < 0.01


@pytest.mark.usefixtures("plain_kernels")
def test_a_cell_that_nothing_is_known_of_stays_as_it_starts():
    values, valid = np.array([[0.0, 0.0, 5.0, 5.0], [0.0, 0.0, 5.0, 7.0]]), np.ones((2, 4), bool)
    valid[1, 3] = False
    lone = Mask(np.array([[True, True, False, False], [True, True, False, True]]))
    got = icm(Image(values, valid=valid), lone, model=Model(lines="none"))
    assert np.isfinite(got.image.values).all()
    assert (got.image.values[:, :2] == 0.0).all()
