"""The thesis' divider: exact both ways, and honest about impossible data."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import references_pads as references
from helpers_circuits import exact_ratio, spread_siemens
from helpers_modes import compiled, plainly
from tactile_graph_pads.circuits.divider import Divider, ratio_kernel, siemens_kernel

CIRCUITS = [
    Divider(),
    Divider(bias_ohm=1e3, mux_ohm=40.0),
    Divider(driver_ohm=40.0),
    Divider(bias_ohm=1e3, driver_ohm=100.0, mux_ohm=70.0),
]


@pytest.mark.slow
@pytest.mark.parametrize("circuit", CIRCUITS)
@pytest.mark.parametrize(("low", "high"), [(1.0, 1e12), (1.0, 1e3), (1e9, 1e12), (1e3, 1e6)])
def test_it_measures_what_nodal_analysis_says_from_1_ohm_to_1_tohm(circuit, low, high):
    siemens = spread_siemens(5, (4, 5), low, high)
    siemens[1, 2] = 0.0
    expected = exact_ratio(
        "divider", siemens, circuit.bias_ohm, circuit.driver_ohm, circuit.mux_ohm
    )
    np.testing.assert_allclose(circuit.ratio(siemens), expected, rtol=1e-12, atol=0)


@pytest.mark.parametrize("circuit", CIRCUITS)
def test_the_inverse_gives_noiseless_conductances_back_to_1e_9(circuit):
    siemens = spread_siemens(7)
    siemens[3, :] = 0.0
    siemens[5, 5] = 0.0
    found = circuit.inverse(circuit.ratio(siemens))
    assert found.valid.all()
    assert found.residual < 1e-12
    # an open element reads what comes through the others: it is found open to 1e-12 of those
    open_s = 1e-12 * float(np.median(siemens))
    np.testing.assert_allclose(found.siemens, siemens, rtol=1e-9, atol=open_s)


@given(st.integers(0, 10_000), st.floats(0.0, 9.0))
@settings(max_examples=40, deadline=None)
def test_the_closed_inverse_holds_at_every_scale(seed, log10_ohm):
    siemens = spread_siemens(seed, (16, 16), 10**log10_ohm, 10 ** (log10_ohm + 3.0))
    found = Divider().inverse(Divider().ratio(siemens))
    np.testing.assert_allclose(found.siemens, siemens, rtol=1e-9, atol=0)


def test_a_column_is_shadowed_by_its_own_elements_only():
    siemens = np.zeros((16, 16))
    siemens[4, 4] = 1.0 / 80e3
    alone = Divider().ratio(siemens)[4, 4]
    siemens[7, 9] = 1.0 / 1e3
    assert Divider().ratio(siemens)[4, 4] == alone
    siemens[7, 4] = 1.0 / 1e3
    assert Divider().ratio(siemens)[4, 4] < 0.1 * alone


@pytest.mark.parametrize("kernel", ["reference", "compiled"])
def test_a_column_that_sums_to_the_supply_or_more_is_invalid_and_not_clipped(kernel):
    ratio = np.full((16, 3), 0.03)
    ratio[:2, 1] = 0.5, 0.5
    ratio[:2, 2] = 0.8, 0.9
    siemens, valid = getattr(siemens_kernel, kernel)(ratio, 1.0 / 33e3, 1.0)
    assert valid[:, 0].all()
    assert not valid[:, 1:].any()
    assert (siemens[:, 1:] == 0.0).all()
    assert siemens[0, 0] == pytest.approx(0.03 / 33e3 / (1.0 - 0.48))


def test_impossible_columns_do_not_stop_the_others_where_drivers_have_resistance():
    circuit = Divider(driver_ohm=40.0)
    siemens = spread_siemens(2, (6, 6))
    siemens[:, 4] = 0.0
    ratio = circuit.ratio(siemens)
    ratio[:, 4] = 0.5
    found = circuit.inverse(ratio)
    assert not found.valid[:, 4].any()
    np.testing.assert_allclose(found.siemens, siemens, rtol=1e-9, atol=0)


def test_noise_below_zero_stays_below_zero():
    ratio = np.full((4, 4), -1e-4)
    assert (Divider().inverse(ratio).siemens < 0.0).all()


def test_a_multiplexer_left_out_of_the_model_costs_percents():
    real, believed = Divider(bias_ohm=1e3, mux_ohm=40.0), Divider(bias_ohm=1e3)
    siemens = spread_siemens(1, (16, 16), 1.3e3, 1e5)
    error = believed.inverse(real.ratio(siemens)).siemens / siemens - 1.0
    assert 0.02 < np.abs(error).mean() < 0.5


def test_an_empty_pad_measures_and_inverts_as_nothing():
    for circuit in CIRCUITS:
        nothing = np.zeros((16, 16))
        assert (circuit.ratio(nothing) == 0.0).all()
        found = circuit.inverse(nothing)
        assert (found.siemens == 0.0).all()
        assert found.valid.all()


@pytest.mark.parametrize("by", [plainly, compiled])
def test_the_loops_agree_with_the_references(by):
    siemens = spread_siemens(11)
    ratio = references.ratio_kernel(siemens, 1 / 33e3, 0.9)
    np.testing.assert_allclose(by(ratio_kernel)(siemens, 1 / 33e3, 0.9), ratio, rtol=1e-14)
    ratio[:, 3] *= 30.0
    expected, expected_valid = references.siemens_kernel(ratio, 1 / 33e3, 0.9)
    got, valid = by(siemens_kernel)(ratio, 1 / 33e3, 0.9)
    np.testing.assert_allclose(got, expected, rtol=1e-12)
    assert (valid == expected_valid).all()
    assert not expected_valid[:, 3].any()


def test_a_better_start_takes_fewer_iterations():
    circuit = Divider(bias_ohm=1e3, driver_ohm=100.0)
    siemens = spread_siemens(4, (8, 8), 2e3, 1e5)
    ratio = circuit.ratio(siemens)
    assert circuit.inverse(ratio, siemens * 1.01).iterations < circuit.inverse(ratio).iterations
