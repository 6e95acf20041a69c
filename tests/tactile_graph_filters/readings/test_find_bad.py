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
    with pytest.raises(DataError, match="row 0, column 0: must be a number, got nan"):
        FindBad()(image_of([[math.nan]]))


def test_an_element_only_a_few_times_as_noisy_as_the_others_is_found():
    def noisy(values, rng):
        values[2, 5] += rng.normal(0.0, 8.0)

    found = run(FindBad(), change=noisy)
    assert found.valid is not None
    assert np.argwhere(~found.valid).tolist() == [[2, 5]]
