"""Columns at virtual ground: no coupling with ideal parts, an exact inverse with real drivers."""

import numpy as np
import pytest

from helpers_circuits import exact_ratio, spread_siemens
from tactile_graph_pads.circuits.feedback import Feedback


@pytest.mark.parametrize("driver_ohm", [0.0, 40.0, 100.0])
@pytest.mark.parametrize(("low", "high"), [(1.0, 1e12), (1e3, 1e6)])
def test_it_measures_what_nodal_analysis_says(driver_ohm, low, high):
    circuit = Feedback(driver_ohm=driver_ohm)
    siemens = spread_siemens(5, (4, 5), low, high)
    expected = exact_ratio("feedback", siemens, circuit.bias_ohm, driver_ohm)
    np.testing.assert_allclose(circuit.ratio(siemens), expected, rtol=1e-12, atol=0)


@pytest.mark.parametrize("driver_ohm", [0.0, 100.0])
@pytest.mark.parametrize("low_ohm", [1e2, 1e6, 1e9])
def test_the_inverse_gives_noiseless_conductances_back_to_1e_9(driver_ohm, low_ohm):
    circuit = Feedback(driver_ohm=driver_ohm)
    siemens = spread_siemens(7, (16, 16), low_ohm, 1e3 * low_ohm)
    siemens[3] = 0.0
    found = circuit.inverse(circuit.ratio(siemens))
    assert found.valid.all()
    np.testing.assert_allclose(found.siemens, siemens, rtol=1e-9, atol=0)


def test_drivers_left_out_of_the_model_cost_percents():
    siemens = spread_siemens(1, (16, 16), 1.3e3, 1e5)
    measured = Feedback(driver_ohm=100.0).ratio(siemens)
    error = Feedback().inverse(measured).siemens / siemens - 1.0
    assert np.abs(error).mean() > 0.05


def test_a_row_whose_driver_would_drop_more_than_the_supply_is_invalid():
    ratio = np.full((3, 4), 0.01)
    ratio[1] = 3.0
    found = Feedback(driver_ohm=100.0).inverse(ratio)
    assert not found.valid[1].any()
    assert (found.siemens[1] == 0.0).all()
    assert found.valid[[0, 2]].all()
