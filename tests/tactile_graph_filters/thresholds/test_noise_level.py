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


@pytest.mark.parametrize("size", [0.95, 1.0, 1.02, 1.05, 1.2])
def test_lines_beside_a_large_load_are_untouched_not_dead(size):
    y, x = np.mgrid[:64, :27]
    hump = np.clip(size - np.hypot((y - 32) / 26, (x - 13) / 11), 0.0, None)
    values = np.round(60.0 * hump)
    assert noise_level(image_of(values)) == pytest.approx(0.03 * values.max())


@pytest.mark.parametrize("load", [0.0, 30.0])
@pytest.mark.parametrize("middle", [1.0, 1.5, 2.0])
def test_dead_lines_say_nothing_of_noise_that_is_cut_off_at_what_they_read(middle, load):
    rng = np.random.default_rng(8)
    for _ in range(8):
        noise = np.maximum(np.round(rng.normal(middle, 1.0, (40, 30))), 0.0)
        values = noise.copy()
        values[5:20, 10:25] += load
        values[[2, 9, 30, 31], :] = 0.0
        values[:, [0, 12, 20]] = 0.0
        assert noise_level(image_of(values)) > noise.max()


@pytest.mark.parametrize("shape", [(1, 5), (2, 4), (3, 3), (1, 16), (4, 6), (6, 6), (6, 8), (8, 8)])
def test_an_empty_pad_of_few_cells_is_as_seldom_reached_as_one_of_more(shape):
    rng = np.random.default_rng(4)
    n = 1000
    frames = rng.normal(100.0, 1.0, (n, *shape))
    reached = sum(noise_level(image_of(frame)) <= frame.max() for frame in frames)
    assert reached <= (0.016 if 5 <= math.prod(shape) <= 8 else 0.004) * n


@pytest.mark.parametrize("shape", [(2, 3), (2, 4), (3, 3), (3, 4), (4, 4), (4, 5)])
@pytest.mark.parametrize("loads", [(100.0,), (60.0, 100.0)])
def test_loads_far_above_the_noise_of_few_cells_are_reached(shape, loads):
    rng = np.random.default_rng(6)
    for _ in range(200):
        values = rng.normal(100.0, 1.0, shape)
        values.flat[: len(loads)] += loads
        assert noise_level(image_of(values)) <= values.max()


def test_from_8_by_8_cells_on_and_without_noise_the_level_is_the_plain_one():
    values = np.random.default_rng(5).normal(size=(8, 8))
    low, base, _ = lower_readings(image_of(values))
    assert noise_level(image_of(values)) == base + 10.0 * ((base - low) / 0.9704)
    assert noise_level(image_of([[0.0, 0.0, 0.0], [0.0, 5.0, 0.0]])) == pytest.approx(0.15)


@pytest.mark.parametrize("load", [0.0, 300.0])
def test_hum_that_is_cut_off_at_zero_lies_below_the_level(load: float) -> None:
    rng = np.random.default_rng(6)
    found = []
    for _ in range(20):
        hum = 5.0 * np.sin(rng.uniform(0.0, 2.0 * np.pi) + 0.41 * np.arange(16)[:, None])
        values = rng.normal(hum, 2.0, (16, 16))
        values[5:9, 5:10] += load
        values = np.clip(np.round(values), 0.0, 4095.0)
        level = noise_level(image_of(values))
        found.append(values[values < 100.0].max() < level < 60.0)
    assert np.mean(found) >= 0.9
