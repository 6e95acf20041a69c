"""What the thesis concludes from figures 2.8 to 2.11 comes out of its circuit."""

import numpy as np

from tactile_graph_thesis.chapter_2 import (
    coupling_volts,
    element_volts,
    random_neighbours,
    scan_error_v,
)

BIAS = np.arange(10e3, 101e3, 10e3)
RESISTANCE = np.geomspace(1e3, 1e6, 60)
EIGHT = (80e3,) * 8


def test_a_larger_bias_resistor_gives_more_volts_for_any_load():
    volts = element_volts(RESISTANCE, BIAS)
    assert volts.shape == (10, 60)
    assert (np.diff(volts, axis=0) > 0.0).all()
    np.testing.assert_allclose(volts[2], 5.0 * 30e3 / (30e3 + RESISTANCE))


def test_sensitivity_changes_less_beyond_40_kohm():
    gained = np.diff(element_volts(80e3, BIAS)[:, 0])
    assert (np.diff(gained) < 0.0).all()


def test_with_eight_loaded_neighbours_the_curves_cluster():
    alone, loaded = element_volts(RESISTANCE, BIAS), element_volts(RESISTANCE, BIAS, EIGHT)
    beyond = BIAS >= 50e3
    assert np.ptp(loaded[beyond], axis=0).max() < 0.3 * np.ptp(alone[beyond], axis=0).max()


def test_coupling_is_least_at_30_kohm_of_the_three_compared():
    taken = coupling_volts(80e3, [30e3, 40e3, 50e3])[:, 0]
    assert taken[0] < taken[1] < taken[2]


def test_at_33_kohm_heavier_neighbours_couple_more():
    taken = [coupling_volts(RESISTANCE, 33e3, (n,) * 8)[0] for n in (60e3, 100e3, 200e3, 300e3)]
    assert (np.diff(taken, axis=0) < 0.0).all()


def test_random_neighbours_lie_between_60_and_300_kohm():
    neighbours = random_neighbours(np.random.default_rng(0))
    assert neighbours.shape == (8,)
    assert ((neighbours > 60e3) & (neighbours < 300e3)).all()
    assert (coupling_volts(RESISTANCE, 33e3, neighbours) > 0.0).all()


def test_ten_samples_serve_as_well_as_hundred_beside_the_step_of_the_converter():
    volts = np.random.default_rng(1).uniform(0.0, 2.0, (16, 16))
    one, ten, hundred = scan_error_v([1, 10, 100], volts, np.random.default_rng(0))
    assert one > ten > hundred
    assert ten < 0.5 * 2.44e-3
