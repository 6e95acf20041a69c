"""The force law passes through its points and can be undone."""

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import references_pads as references
from helpers_modes import compiled, plainly
from tactile_graph_pads.law import ForceLaw, conductance_kernel, load_kernel

LAWS = [
    ForceLaw(),
    ForceLaw(exponent=2.0),
    ForceLaw(exponent=1.0),
    ForceLaw(turn_on_g=0.0),
    ForceLaw(turn_on_bend=0.0),
    ForceLaw(saturation_g=3000.0, saturation_headroom=0.5),
]


def test_the_law_passes_through_the_two_points_of_the_thesis():
    law = ForceLaw()
    assert law.power == pytest.approx(1.4628, abs=1e-4)
    assert law.resistance_at(100.0) == pytest.approx(80e3, rel=1e-12)
    assert law.resistance_at(2000.0) == pytest.approx(1e3, rel=1e-12)


@pytest.mark.parametrize("exponent", [1.0, 2.0])
def test_a_given_exponent_keeps_the_first_point(exponent):
    law = ForceLaw(exponent=exponent)
    assert law.resistance_at(100.0) == pytest.approx(80e3, rel=1e-12)
    assert law.resistance_at(1000.0) == pytest.approx(80e3 / 10**exponent, rel=1e-12)


def test_below_turn_on_an_element_is_as_good_as_open():
    law = ForceLaw()
    assert law.resistance_at(0.0) == math.inf
    assert law.resistance_at(1.0) > 1e12
    straight = 80e3 * 10.0**law.power
    assert law.resistance_at(10.0) == pytest.approx(straight)
    assert law.resistance_at(5.0) > 3.0 * straight * 2.0**law.power


def test_beyond_saturation_the_resistance_levels_off():
    law = ForceLaw()
    at_10_kg, at_20_kg = law.resistance_at(10e3), law.resistance_at(20e3)
    assert at_10_kg / at_20_kg < 2.0**law.power / 1.5
    assert 1.0 / law.resistance_at(1e9) == pytest.approx(law.max_siemens, rel=1e-6)


@pytest.mark.parametrize("law", LAWS)
def test_value_and_slope_are_continuous_and_rising(law):
    loads = np.exp(np.linspace(math.log(0.5), math.log(20e3), 40_001))[None]
    log_g = np.log(law.conductance_s(loads))[0]
    slope = np.diff(log_g) / np.diff(np.log(loads[0]))
    assert (slope > 0.0).all()
    assert np.abs(np.diff(slope)).max() < 0.05


@given(st.sampled_from(LAWS), st.floats(0.3, 20e3))
@settings(max_examples=100, deadline=None)
def test_the_inverse_is_exact(law, load):
    loads = np.array([[load]])
    siemens = law.conductance_s(loads)
    slope = 1e3 * (law.conductance_s(loads * 1.001)[0, 0] / siemens[0, 0] - 1.0)
    # where the law is flat, rounding of the conductance alone moves the load this much
    tolerance = 1e-12 + 1e-15 / max(slope, 1e-12)
    assert law.load_of(siemens)[0, 0] == pytest.approx(load, rel=tolerance)


@pytest.mark.parametrize("by", [plainly, compiled])
@pytest.mark.parametrize("law", LAWS)
def test_the_loops_agree_with_the_references(law, by):
    loads = np.array([[0.0, -3.0, 0.2, 5.0, 9.99, 10.0, 50.0, 2e3, 1e4, 3e4]])
    siemens = references.conductance_kernel(loads, law.packed)
    np.testing.assert_allclose(
        by(conductance_kernel)(loads, law.packed), siemens, rtol=1e-13, atol=0
    )
    values = np.concatenate([siemens, -siemens, siemens + law.max_siemens], axis=1)
    expected = references.load_kernel(values, law.packed)
    np.testing.assert_allclose(by(load_kernel)(values, law.packed), expected, rtol=1e-12, atol=0)


@pytest.mark.parametrize("kernel", ["reference", "compiled"])
def test_conductances_no_load_can_reach_say_infinity_and_none_says_nothing(kernel):
    law = ForceLaw()
    values = np.array([[0.0, -1e-6, law.max_siemens * 1.0001]])
    found = getattr(load_kernel, kernel)(values, law.packed)
    assert found.tolist() == [[0.0, 0.0, math.inf]]


def test_two_points_that_do_not_fall_are_refused():
    with pytest.raises(ValueError, match="give no falling resistance; the heavier load needs"):
        ForceLaw(load2_g=50.0)
    with pytest.raises(ValueError, match="turn_on_g must be below saturation_g, got 500 and 100"):
        ForceLaw(turn_on_g=500.0, saturation_g=100.0)
