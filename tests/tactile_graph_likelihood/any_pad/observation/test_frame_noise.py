"""Zero and noise of a frame, whatever lies on part of it."""

import numpy as np
import pytest

from helpers_modes import plainly
from tactile_graph_filters.readings.ordered import in_order
from tactile_graph_likelihood.any_pad.observation.frame_noise import frame_noise, noise_of_sorted


def readings(rng, touched, sigma=2e-3, zero=0.0):
    values = zero + sigma * rng.standard_normal(256)
    values[:touched] += rng.uniform(0.02, 0.3, touched)
    return values


@pytest.mark.parametrize("touched", [0, 40, 110])
@pytest.mark.parametrize("zero", [0.0, 1.7])
def test_the_zero_is_found_and_noise_never_comes_out_too_small(touched, zero):
    rng = np.random.default_rng(touched)
    found = [frame_noise(readings(rng, touched, zero=zero)) for _ in range(50)]
    assert np.mean([f.zero for f in found]) == pytest.approx(zero, abs=6e-4)
    assert min(f.sigma for f in found) > 0.6 * 2e-3
    assert max(f.sigma for f in found) < 2.5 * 2e-3


def test_readings_that_are_whole_steps_tell_the_step():
    rng = np.random.default_rng(1)
    step = 10.0 / 256
    found = frame_noise(np.round(readings(rng, 60) / step) * step)
    assert found.step == pytest.approx(step)
    assert found.zero == 0.0
    assert found.sigma == 0.0


def test_a_frame_without_noise_has_none():
    values = np.zeros(256)
    values[:90] = np.linspace(0.1, 0.5, 90)
    assert frame_noise(values)[:2] == (0.0, 0.0)


@pytest.mark.parametrize("saturated", [64, 90, 150])
@pytest.mark.parametrize("beyond", [0, 3])
def test_the_end_of_the_range_is_no_zero(saturated, beyond):
    rng = np.random.default_rng(3)
    values = np.round(rng.normal(10.0, 1.5, 256))
    values[:saturated] = 255.0
    values[:beyond] = 300.0
    found = frame_noise(values)
    assert found.zero == pytest.approx(10.0, abs=1.0)
    assert 0.6 * 1.5 < found.sigma < 2.5 * 1.5


def test_a_zero_that_hardly_any_reading_exceeds_is_one():
    values = np.full(256, 20.0)
    values[:60] = np.random.default_rng(4).uniform(0.0, 19.0, 60)
    assert frame_noise(values).zero == 20.0


def test_of_a_large_pad_a_part_is_enough():
    rng = np.random.default_rng(2)
    assert frame_noise(2e-3 * rng.standard_normal(65536)).sigma == pytest.approx(2e-3, rel=0.1)


@pytest.mark.parametrize("n", [0, 1, 3, 4, 5, 9, 256, 5000])
def test_noise_is_told_alike_in_loops(n):
    rng = np.random.default_rng(n)
    normal = rng.standard_normal(n)
    for values in (normal, np.round(normal), np.zeros(n), np.minimum(normal, 0.0)):
        ordered = in_order(values)
        assert plainly(noise_of_sorted)(ordered) == noise_of_sorted.reference(ordered)


def readings_in_steps(rng, sigma, touched=0, side=32, step=1.0):
    values = 100.0 + sigma * rng.standard_normal(side * side)
    values[:touched] += sigma * rng.uniform(6.0, 150.0, touched)
    return np.round(values) * step


@pytest.mark.parametrize("sigma", [1.6, 1.8, 2.0, 2.3, 2.6, 3.5, 5.0])
@pytest.mark.parametrize("touched", [0, 300])
@pytest.mark.parametrize("step", [1.0, 0.15])
def test_of_stretches_as_short_in_coarse_steps_none_is_preferred(sigma, touched, step):
    rng = np.random.default_rng(5)
    found = [frame_noise(readings_in_steps(rng, sigma, touched, step=step)) for _ in range(30)]
    assert np.mean([f.zero for f in found]) / step == pytest.approx(100.0, abs=0.1 * sigma)
    assert np.mean([f.zero + 4.0 * f.sigma for f in found]) > (100.0 + 3.9 * sigma) * step
    if not touched:
        assert np.mean([f.sigma for f in found]) < 1.1 * sigma * step


def test_a_load_as_close_together_as_the_zero_is_none_in_coarse_steps():
    values = np.concatenate([np.repeat([9.0, 10.0, 11.0], 100), np.repeat([49.0, 50.0, 51.0], 100)])
    found = frame_noise(values)
    assert found.zero == 10.0
    assert found.sigma < 3.0


def test_coarse_steps_are_told_alike_in_loops():
    rng = np.random.default_rng(6)
    for side in (3, 4, 8, 32):
        for sigma in (0.5, 1.0, 1.7, 2.0, 2.6, 4.0, 9.0):
            for step in (1.0, 0.15):
                touched = int(rng.integers(side * side // 2))
                ordered = in_order(readings_in_steps(rng, sigma, touched, side, step))
                assert plainly(noise_of_sorted)(ordered) == noise_of_sorted.reference(ordered)
