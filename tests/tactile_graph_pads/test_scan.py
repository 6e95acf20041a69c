"""Samples, noise and conversion."""

import numpy as np
import pytest

from tactile_graph_pads.scan import Converter, Scan


def test_twelve_bits_over_ten_volts_make_steps_of_2_44_mv():
    converter = Converter()
    assert converter.step_v == pytest.approx(10.0 / 4096.0)
    assert converter.counts(np.array([0.0, 1.0, -5.0])).tolist() == [2048.0, 2458.0, 0.0]


def test_conversion_rounds_to_the_nearest_step_and_back():
    converter, volts = Converter(), np.linspace(-4.99, 4.99, 5001)
    back = converter.volts(converter.counts(volts))
    assert np.abs(back - volts).max() <= 0.5 * converter.step_v * (1 + 1e-9)


def test_beyond_its_range_the_converter_stays_at_the_end():
    converter = Converter()
    counts = converter.counts(np.array([-7.0, 5.0, 99.0]))
    assert counts.tolist() == [0.0, 4095.0, 4095.0]
    assert converter.volts(counts)[2] == pytest.approx(converter.max_v)


def test_an_ideal_converter_changes_nothing():
    volts = np.array([[0.1234567, -88.0]])
    converter = Converter(bits=None)
    assert (converter.volts(converter.counts(volts)) == volts).all()
    assert converter.max_v == np.inf


def test_an_empty_range_is_refused():
    with pytest.raises(ValueError, match="high_v must be above low_v, got 5 to -5"):
        Converter(low_v=5.0, high_v=-5.0)


def test_averaging_hundred_samples_leaves_a_tenth_of_the_noise():
    volts, converter = np.full((16, 16), 0.5), Converter()

    def error(samples):
        rng = np.random.default_rng(1)
        scan = Scan(samples=samples, noise_v=0.02)
        readings = [converter.volts(scan.counts(volts, converter, rng)) for _ in range(8)]
        return float(np.std(np.array(readings) - 0.5))

    assert error(100) == pytest.approx(error(1) / 10.0, rel=0.1)
    assert error(10) == pytest.approx(error(1) / 10**0.5, rel=0.1)


def test_noise_lets_the_mean_fall_between_two_counts():
    converter = Converter()
    volts = np.full((16, 16), 0.3 * converter.step_v)
    still = Scan(noise_v=0.0).counts(volts, converter, np.random.default_rng(0))
    assert (still == 2048.0).all()
    shaken = Scan(noise_v=0.004).counts(volts, converter, np.random.default_rng(0))
    assert shaken.mean() == pytest.approx(2048.3, abs=0.05)


def test_noise_can_differ_from_element_to_element():
    scale = np.ones((4, 50))
    scale[2] = 10.0
    scan = Scan(samples=1, noise_v=0.01)
    counts = scan.counts(np.zeros((4, 50)), Converter(), np.random.default_rng(3), scale)
    spread = counts.std(axis=1)
    assert spread[2] > 6.0 * spread[[0, 1, 3]].max()


def test_hundred_samples_of_the_whole_array_take_under_a_minute():
    assert 30.0 < Scan().frame_s(256) < 60.0
    assert Scan(samples=10).frame_s(256) == pytest.approx(Scan().frame_s(256) / 10.0)
