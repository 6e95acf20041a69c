import math

import numpy as np
import pytest

from helpers_filters import image_of
from tactile_graph.errors import DataError
from tactile_graph_filters.readings.find_bad import FindBad


def run(finder, n=30, seed=0, shape=(8, 8), change=None):
    rng = np.random.default_rng(seed)
    for _ in range(n):
        values = 100.0 + rng.normal(0.0, 1.0, shape)
        if change is not None:
            change(values, rng)
        found = finder(image_of(values, "counts"))
    return found


@pytest.mark.parametrize("seed", range(10))
def test_a_sound_pad_has_no_bad_elements(seed):
    assert run(FindBad(), seed=seed).valid is None


def test_hot_noisy_and_dead_elements_are_found_and_nothing_else():
    def broken(values, rng):
        values[1, 2] += 300.0
        values[4, 4] += rng.normal(0.0, 60.0)
        values[6, :] = 0.0

    found = run(FindBad(), change=broken)
    expected = np.ones((8, 8), bool)
    expected[1, 2] = expected[4, 4] = expected[6, :] = False
    assert np.array_equal(found.valid, expected)
    assert found.values[1, 2] == 0.0


def test_elements_that_never_change_may_be_left_alone():
    def still(values, rng):
        values[3, 3] = 100.0

    assert not run(FindBad(), change=still).valid[3, 3]
    assert run(FindBad(dead=False), change=still).valid is None


def test_before_enough_frames_nothing_is_judged():
    def hot(values, rng):
        values[0, 0] = 1e6

    finder = FindBad(n_frames=30)
    assert run(finder, n=29, change=hot).valid is None
    assert not run(finder, n=1, change=hot).valid[0, 0]


def test_an_even_pad_read_without_noise_is_not_judged_by_rounding():
    finder = FindBad(n_frames=3)
    for _ in range(4):
        found = finder(image_of(np.full((4, 4), 0.1) + 1e-17))
    assert found.valid is None


def test_what_was_invalid_stays_so():
    finder = FindBad(n_frames=2)
    valid = np.ones((4, 4), bool)
    valid[0, 0] = False
    rng = np.random.default_rng(0)
    for _ in range(3):
        values = rng.normal(0.0, 1.0, (4, 4))
        values[3, 3] = 500.0
        found = finder(image_of(np.where(valid, values, 0.0), valid=valid))
    assert not found.valid[0, 0]
    assert not found.valid[3, 3]


def test_another_shape_is_refused():
    finder = FindBad()
    finder(image_of([[1.0, 2.0]]))
    with pytest.raises(DataError, match=r"must keep its shape, got \(1, 1\) after \(1, 2\)"):
        finder(image_of([[1.0]]))


def test_nan_is_refused():
    for value in (math.nan, math.inf, -math.inf):
        with pytest.raises(DataError, match=f"row 0, column 1: must be a number, got {value}"):
            FindBad()(image_of([[1.0, value]]))


def test_an_element_only_a_few_times_as_noisy_as_the_others_is_found():
    def noisy(values, rng):
        values[2, 5] += rng.normal(0.0, 8.0)

    found = run(FindBad(), change=noisy)
    assert found.valid is not None
    assert np.argwhere(~found.valid).tolist() == [[2, 5]]


@pytest.mark.parametrize("n_sigma", [0.7, 1.5, 3.0])
@pytest.mark.parametrize("n", [2, 5, 12])
@pytest.mark.parametrize("seed", range(4))
def test_an_element_is_good_where_its_mean_and_its_noise_are_near_the_others(seed, n, n_sigma):
    """By the definition, and at limits so near that many elements lie beside them."""
    rng = np.random.default_rng([seed, n])
    frames = rng.normal(3.0, 0.5, (4, 5)) + rng.normal(
        0.0, rng.uniform(0.1, 1.0, (4, 5)), (n, 4, 5)
    )
    frames[:, 2, 3] = 3.0
    mean, noise = frames.mean(axis=0), frames.std(axis=0, ddof=1)
    far = np.abs(mean - np.median(mean))
    good = far <= n_sigma * max(1.4826 * np.median(far), np.median(noise))
    logs = np.log(noise[noise > 0.0])
    spread = max(1.4826 * np.median(np.abs(logs - np.median(logs))), math.sqrt(0.5 / n))
    good[noise > 0.0] &= logs <= np.median(logs) + n_sigma * spread
    for dead in (True, False):
        finder = FindBad(n_frames=n, n_sigma=n_sigma, dead=dead)
        for frame in frames:
            found = finder(image_of(frame))
        wanted = good & (noise > 0.0) if dead else good
        assert np.array_equal(np.ones((4, 5), bool) if found.valid is None else found.valid, wanted)
        assert np.array_equal(found.values, np.where(wanted, frames[-1], 0.0))


@pytest.mark.parametrize("share", [0.3, 0.7, 0.97, 1.0])
def test_elements_are_judged_by_those_that_are_there_and_by_their_valid_readings(share):
    rng = np.random.default_rng(0)
    missing = rng.random((20, 10)) < share
    missing.flat[:3] = share == 1.0
    finder = FindBad()
    for k in range(31):
        values = 100.0 + rng.normal(0.0, 1.0, (20, 10))
        values[0, 2] = 400.0  # hot, and without noise
        valid = ~missing
        valid[0, 1] &= k != 3  # a single one that drops out
        valid[0, 0] &= k < 5  # and one that was there for too short a time to tell
        found = finder(image_of(np.where(valid, values, 0.0), "counts", valid))
    expected = ~missing
    expected[0, 0] = expected[0, 2] = False
    assert np.array_equal(found.valid, expected)
