"""The floating circuit: ghosts as nodal analysis says, and their removal."""

import numpy as np
import pytest

from helpers_circuits import exact_ratio, spread_siemens
from tactile_graph_pads.circuits.floating import Floating, equivalent_s
from tactile_graph_pads.circuits.newton import MOST_ITERATIONS


@pytest.mark.parametrize("kernel", ["reference", "compiled"])
@pytest.mark.parametrize(("low", "high"), [(1.0, 1e12), (1.0, 1e3), (1e9, 1e12)])
def test_it_measures_what_nodal_analysis_says_from_1_ohm_to_1_tohm(kernel, low, high):
    siemens = spread_siemens(5, (4, 5), low, high)
    siemens[1, 2] = 0.0
    expected = exact_ratio("floating", siemens, 33e3)
    through = getattr(equivalent_s, kernel)(siemens)
    np.testing.assert_allclose(33e3 / (33e3 + 1.0 / through), expected, rtol=1e-12, atol=0)
    np.testing.assert_allclose(Floating().ratio(siemens), expected, rtol=1e-12, atol=0)


def test_resistances_in_series_are_part_of_the_model():
    circuit = Floating(bias_ohm=1e3, driver_ohm=40.0, mux_ohm=70.0)
    siemens = spread_siemens(6, (4, 5))
    expected = exact_ratio("floating", siemens, 1e3, 40.0, 70.0)
    np.testing.assert_allclose(circuit.ratio(siemens), expected, rtol=1e-12, atol=0)
    found = circuit.inverse(expected)
    np.testing.assert_allclose(found.siemens, siemens, rtol=1e-9, atol=0)


@pytest.mark.parametrize("kernel", ["reference", "compiled"])
def test_lines_that_nothing_joins_measure_as_nothing(kernel):
    siemens = np.zeros((5, 6))
    siemens[:2, :2] = 1e-4
    siemens[3:, 3:5] = 1e-3
    through = getattr(equivalent_s, kernel)(siemens)
    assert (through[:2, 2:] == 0.0).all()
    assert (through[2] == 0.0).all()
    assert (through[:, 5] == 0.0).all()
    assert through[0, 0] == pytest.approx(1e-4 * (1.0 + 1.0 / 3.0))


def test_three_corners_make_a_ghost_at_the_fourth_and_the_inverse_removes_it():
    siemens = np.full((8, 8), 1e-9)
    siemens[2, 2] = siemens[2, 5] = siemens[6, 2] = 1e-3
    circuit = Floating()
    ratio = circuit.ratio(siemens)
    assert ratio[6, 5] > 0.9 * ratio[2, 2]
    found = circuit.inverse(ratio)
    assert found.siemens[6, 5] < 1e-3 * found.siemens[2, 2]


@pytest.mark.parametrize(("low", "high"), [(1e3, 1e6), (1.0, 1e2), (1e9, 1e12), (5e3, 6e3)])
def test_the_inverse_gives_noiseless_conductances_back_to_1e_9(low, high):
    circuit = Floating(bias_ohm=float(np.sqrt(low * high)))
    siemens = spread_siemens(7, (16, 16), low, high)
    found = circuit.inverse(circuit.ratio(siemens))
    assert found.valid.all()
    assert found.residual < 1e-11
    assert found.iterations <= 15
    np.testing.assert_allclose(found.siemens, siemens, rtol=1e-9, atol=0)


def test_elements_that_do_not_conduct_are_left_out():
    circuit = Floating()
    siemens = np.zeros((8, 8))
    siemens[2:5, 1:4] = spread_siemens(3, (3, 3))
    found = circuit.inverse(circuit.ratio(siemens))
    np.testing.assert_allclose(found.siemens, siemens, rtol=1e-9, atol=0)
    assert (circuit.inverse(np.zeros((8, 8))).siemens == 0.0).all()


def test_the_last_frame_is_a_better_start():
    circuit = Floating()
    siemens = spread_siemens(8)
    ratio = circuit.ratio(siemens)
    cold = circuit.inverse(ratio)
    warm = circuit.inverse(ratio, siemens * 1.02)
    assert warm.iterations < cold.iterations
    np.testing.assert_allclose(warm.siemens, siemens, rtol=1e-9, atol=0)


def test_a_reading_beyond_a_short_circuit_makes_the_frame_invalid():
    ratio = np.full((4, 4), 0.1)
    ratio[2, 1] = 1.0
    found = Floating().inverse(ratio)
    assert not found.valid.any()
    assert (found.siemens == 0.0).all()
    assert found.residual == np.inf


def test_data_no_network_gives_end_within_the_cap_with_the_misfit_stated():
    ratio = np.full((6, 6), 1e-4)
    ratio[2, 3] = 0.9  # a short that its neighbours do not see
    found = Floating().inverse(ratio)
    assert found.iterations <= MOST_ITERATIONS
    assert np.isfinite(found.siemens).all()
    assert found.residual > 0.0


@pytest.mark.slow
def test_the_compiled_twin_agrees_with_the_reference():
    siemens = spread_siemens(11, (16, 12))
    siemens[4] = 0.0
    siemens[:, 7] = 0.0
    np.testing.assert_allclose(
        equivalent_s.compiled(siemens), equivalent_s.reference(siemens), rtol=1e-12, atol=0
    )


@pytest.mark.parametrize("ratio", [2.2e-311, 1e-300, 1e-150])
def test_readings_of_next_to_nothing_stand_for_elements_that_do_not_conduct(ratio):
    measured = np.full((3, 3), 0.1)
    measured[1, 1] = measured[0, 2] = ratio
    found = Floating().inverse(measured)
    assert found.valid.all()
    assert (found.siemens[[1, 0], [1, 2]] == 0.0).all()
