"""Noise whose lower half no device tells, and loads on a pad that truly reads nothing."""

from __future__ import annotations

import numpy as np
import pytest

from helpers_clipped import EVERY, disc, given, legs, soles
from helpers_modes import plainly
from tactile_graph_filters.readings.clipped_noise import clipped_noise, is_anywhere

pytestmark = pytest.mark.usefixtures("plain_kernels")

NOISES = [0.3, 0.5, 1.0, 3.0]


def noise_of(values: np.ndarray, known: np.ndarray = EVERY, rest: float = 0.0) -> float:
    return clipped_noise.reference(*given(values, known, rest))


def counts(rng: np.random.Generator, noise: float, radius: float = 0.0) -> np.ndarray:
    loads = 300.0 * disc(radius) * np.exp(rng.normal(0.0, 0.4, (16, 16)))
    return np.maximum(np.round(rng.normal(0.0, noise, (16, 16)) + loads), 0.0)


@pytest.mark.parametrize("noise", NOISES)
@pytest.mark.parametrize("radius", [0.0, 2.5, 4.5])
def test_noise_that_is_cut_off_is_told_by_what_is_left_of_it(noise: float, radius: float) -> None:
    rng = np.random.default_rng(1)
    found = np.array([noise_of(counts(rng, noise, radius)) for _ in range(20)])
    assert np.count_nonzero(found == 0.0) <= 1
    assert np.median(found) == pytest.approx(noise, rel=0.2)
    assert found.max() < 1.6 * noise


def test_so_is_noise_without_steps_or_around_another_value() -> None:
    rng = np.random.default_rng(2)
    values = np.maximum(rng.normal(7.0, 2.0, (16, 16)), 7.0)
    assert noise_of(values, rest=7.0) == pytest.approx(2.0, rel=0.1)


def test_readings_that_lie_between_two_steps_are_noise_of_about_one() -> None:
    values = np.round(np.random.default_rng(3).normal(20.5, 0.3, (16, 16)))
    assert noise_of(values, rest=20.0) == pytest.approx(1.0, rel=0.1)


@pytest.mark.parametrize("radius", [1.5, 3.0, 5.0, 7.0])
@pytest.mark.parametrize("steps", [1.0, 4.0, 300.0])
@pytest.mark.parametrize("gains", [0.0, 0.5])
def test_loads_on_a_pad_that_truly_reads_nothing_all_stand_out_of_noise(
    radius: float, steps: float, gains: float
) -> None:
    rng = np.random.default_rng(4)
    loads = steps * disc(radius) * np.exp(rng.normal(0.0, gains, (16, 16)))
    loads[rng.random((16, 16)) < 0.15] = 0.0
    for values in (loads, np.round(loads)):
        assert 4.0 * noise_of(values) < values[values > 0.0].min()


@pytest.mark.parametrize("radius", [5.0, 5.5, 6.0])
def test_loads_that_no_gap_parts_from_cut_off_noise_are_none_of_it(radius: float) -> None:
    rng = np.random.default_rng(12)
    loads = disc(radius) * rng.uniform(0.0, 500.0, (20, 16, 16))
    values = np.maximum(np.round(rng.normal(loads, 20.0)), 0.0)
    found = np.array([noise_of(frame) for frame in values])
    assert np.median(found) == pytest.approx(20.0, rel=0.2)
    assert found.max() < 40.0


def with_hum(rng: np.random.Generator, steps: float, load: np.ndarray | float) -> np.ndarray:
    """Return counts over rows of 50 Hz hum, each read 3.1 ms after the other."""
    hum = steps * np.sin(2.0 * np.pi * (0.155 * np.arange(16)[:, None] + rng.random()))
    return np.maximum(np.round(rng.normal(hum, 0.4, (16, 16)) + load), 0.0)


@pytest.mark.parametrize("steps", [0.4, 0.8, 1.6, 2.5])
@pytest.mark.parametrize("radius", [1.5, 2.5, 4.5])
@pytest.mark.parametrize("by_columns", [False, True])
def test_hum_that_is_alike_along_rows_or_columns_is_noise(
    steps: float, radius: float, by_columns: bool
) -> None:
    rng = np.random.default_rng(10)
    load = 300.0 * disc(radius)
    frames = [with_hum(rng, steps, load) for _ in range(20)]
    found = np.array([noise_of(f.T.copy() if by_columns else f) for f in frames])
    assert np.count_nonzero(found == 0.0) <= 1
    assert np.median(found) == pytest.approx(np.hypot(0.4, steps / np.sqrt(2.0)), rel=0.35)


@pytest.mark.parametrize("steps", [2.0, 4.0, 8.0])
def test_a_rod_from_edge_to_edge_is_no_hum(steps: float) -> None:
    rng = np.random.default_rng(11)
    for rows in (slice(2, 6), slice(4, 11), slice(0, 5)):
        rod = np.zeros((16, 16))
        rod[rows] = np.ceil(steps * rng.uniform(0.6, 1.0, rod[rows].shape))
        assert noise_of(rod) == noise_of(rod.T.copy()) == 0.0


@pytest.mark.parametrize("loads", [legs(1), legs(3), soles()], ids=["legs", "stool", "soles"])
def test_loads_of_few_steps_side_by_side_are_no_hum(loads: np.ndarray) -> None:
    for values in (loads, loads.T.copy()):
        args = given(values)
        assert plainly(clipped_noise)(*args) == clipped_noise.reference(*args) == 0.0


def test_two_rods_on_a_mat_of_switches_are_no_hum() -> None:
    mat = np.zeros((16, 16))
    mat[2:6] = mat[10:14] = 1.0
    assert noise_of(mat) == 0.0


def test_too_few_readings_tell_nothing() -> None:
    values = counts(np.random.default_rng(5), 1.0)
    assert noise_of(values[:6, :9]) == 0.0
    lone = np.zeros((16, 16))
    lone[2, 3] = lone[9, 9] = lone[14, 1] = 2.0
    assert noise_of(lone) == 0.0


@pytest.mark.parametrize("load", [2.0, 255.0, 1000.0])
@pytest.mark.parametrize("n", [4, 8])
def test_touches_apart_that_read_the_same_are_no_noise(load: float, n: int) -> None:
    """A mat of switches, or pins at the end of the converter's range."""
    rng = np.random.default_rng(8)
    for _ in range(20):
        pins = np.zeros((16, 16))
        pins.flat[rng.choice(256, n, replace=False)] = load
        assert noise_of(pins) == 0.0
    lattice = np.zeros((32, 32))
    lattice[::4, ::4] = load
    assert noise_of(lattice) == 0.0


def test_cells_that_do_not_count_say_nothing() -> None:
    values = counts(np.random.default_rng(6), 1.0)
    known = np.ones((16, 16), np.bool_)
    known[5:7] = False
    other = values.copy()
    other[5], other[6] = 2.0, np.nan
    assert noise_of(other, known) == noise_of(values, known) > 0.0


@pytest.mark.parametrize("noise", [0.5, 1.0])
@pytest.mark.parametrize("bent", [np.log1p, np.sqrt])
def test_noise_of_bent_readings_is_told_though_steps_further_up_are_smaller(
    noise: float, bent: np.ufunc
) -> None:
    rng = np.random.default_rng(14)
    for _ in range(20):
        args = given(bent(counts(rng, noise, 3.5)))
        found = clipped_noise.reference(*args)
        assert plainly(clipped_noise)(*args) == found
        assert 0.4 * bent(noise) < found < 1.6 * bent(noise)


@pytest.mark.parametrize("shape", [(0, 0), (1, 3), (1, 200), (16, 16), (40, 30)])
def test_noise_is_told_alike_in_loops(shape: tuple[int, int]) -> None:
    rng = np.random.default_rng(7)
    known = rng.random(shape) < 0.8
    for values in (
        np.maximum(rng.standard_normal(shape), 0.0),
        np.maximum(np.round(rng.standard_normal(shape)), 0.0),
        np.round(3.0 * disc(0.3 * shape[0], shape)) if shape[0] else np.zeros(shape),
    ):
        for cells in (EVERY, known):
            args = given(values, cells)
            assert plainly(clipped_noise)(*args) == clipped_noise.reference(*args)
            near = values, cells, 0.0, 1.0, 1.0
            assert plainly(is_anywhere)(*near) == is_anywhere.reference(*near)


@pytest.mark.parametrize("seed", range(30))
def test_hum_is_told_alike_in_loops(seed: int) -> None:
    rng = np.random.default_rng(seed)
    values = with_hum(rng, rng.uniform(0.0, 3.0), 300.0 * disc(rng.uniform(0.0, 5.0)))
    known = rng.random((16, 16)) < 0.9
    offsets = np.maximum(np.round(rng.normal(0.0, 20.0, (16, 16)) + rng.integers(500) * disc(4)), 0)
    for cells in (EVERY, known):
        for readings in (values, offsets):
            args = given(readings, cells)
            assert plainly(clipped_noise)(*args) == clipped_noise.reference(*args)
