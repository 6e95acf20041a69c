"""What lies above the noise, by the lower readings alone."""

from __future__ import annotations

import math

import numpy as np
import pytest

from helpers_filters import image_of
from tactile_graph_filters.thresholds.noise_level import LOW, MIDDLE, lower_readings, noise_level


@pytest.mark.parametrize("n", [*range(2, 45), 101])
def test_the_lower_readings_are_those_of_the_sorted_cells(n):
    values = np.random.default_rng(n).normal(size=(1, n))
    values[0, 0] = 9.0
    low, base, peak = lower_readings(image_of(values))
    expected = np.sort(values[0])
    assert low == expected[math.floor(LOW * (n - 1))]
    assert base == expected[math.floor(MIDDLE * (n - 1))]
    assert peak == 9.0


def test_cells_that_are_not_read_say_nothing():
    values = np.random.default_rng(1).normal(size=(6, 7))
    valid = values < 1.0
    rest = image_of([values[valid]])
    assert lower_readings(image_of(values, valid=valid)) == lower_readings(rest)
    assert lower_readings(image_of(values, valid=np.zeros((6, 7)))) is None
    assert noise_level(image_of(values, valid=np.zeros((6, 7)))) == math.inf


@pytest.mark.parametrize("noise", [0.3, 1.0, 3.0])
def test_noise_that_is_cut_off_at_zero_is_not_reached_either(noise):
    rng = np.random.default_rng(2)
    for _ in range(10):
        empty = np.maximum(np.round(rng.normal(0.0, noise, (16, 16))), 0.0)
        assert noise_level(image_of(empty)) > empty.max()


def test_loads_on_a_pad_that_truly_reads_nothing_are_reached():
    values = np.zeros((16, 16))
    values[4:9, 5:11] = np.random.default_rng(3).integers(2, 9, (5, 6))
    assert noise_level(image_of(values)) == pytest.approx(0.03 * values.max())
