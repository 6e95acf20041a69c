"""Zero and noise of a frame, whatever lies on part of it."""

import numpy as np
import pytest

from helpers_modes import plainly
from tactile_graph_likelihood.any_pad.frame_noise import (
    frame_noise,
    in_order,
    noise_of_sorted,
)


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


def test_of_a_large_pad_a_part_is_enough():
    rng = np.random.default_rng(2)
    assert frame_noise(2e-3 * rng.standard_normal(65536)).sigma == pytest.approx(2e-3, rel=0.1)


@pytest.mark.parametrize("n", [0, 1, 3, 4, 5, 9, 256, 5000])
def test_noise_is_told_alike_in_loops(n):
    rng = np.random.default_rng(n)
    for values in (rng.standard_normal(n), np.round(rng.standard_normal(n)), np.zeros(n)):
        ordered = in_order(values)
        assert plainly(noise_of_sorted)(ordered) == noise_of_sorted.reference(ordered)
