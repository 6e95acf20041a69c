"""What an empty pad says: offset, noise, drift, bad elements; and what is not empty."""

import tracemalloc

import numpy as np
import pytest

from tactile_graph.errors import DataError
from tactile_graph_pads.learning.resting import resting, resting_among_objects, step_of

SHAPE = (9, 12)


def still_pad(n=80, noise=0.5, seed=0):
    rng = np.random.default_rng(seed)
    offset = rng.uniform(-3.0, 3.0, SHAPE)
    return offset, offset + noise * rng.standard_normal((n, *SHAPE))


def test_offset_and_noise_are_each_elements_own():
    rng = np.random.default_rng(1)
    offset, noise = rng.uniform(-3.0, 3.0, SHAPE), rng.uniform(0.3, 0.8, SHAPE)
    found = resting(offset + noise * rng.standard_normal((400, *SHAPE)), "it")
    assert found.offset == pytest.approx(offset, abs=0.25)
    assert found.noise == pytest.approx(noise, rel=0.2)
    assert found.good.all()
    assert found.usual_noise == pytest.approx(np.median(noise), rel=0.1)


def test_a_straight_drift_is_told_and_is_not_in_the_noise():
    _, values = still_pad()
    found = resting(values + np.linspace(0.0, 20.0, 80)[:, None, None], "it")
    assert found.drift == pytest.approx(20.0, rel=0.05)
    assert found.usual_noise == pytest.approx(0.5, rel=0.1)


def test_single_elements_and_lines_that_read_high_are_stuck_but_blocks_are_an_object():
    _, values = still_pad()
    values[:, 2, 3] += 100.0
    values[:, 7, :] += 100.0
    stuck = resting(values, "it").stuck
    assert stuck[2, 3]
    assert stuck[7].all()
    assert stuck.sum() == 1 + SHAPE[1]
    values[:, 3:5, 5:8] += 100.0
    with pytest.raises(DataError, match=r"it: not empty: 6 neighbouring elements around row \d"):
        resting(values, "it")


def cut_off(spread, seed, shape=(16, 16)):
    """Return frames of a device that reads no less than 0, with offsets of each element's own."""
    rng = np.random.default_rng(seed)
    offset = rng.normal(0.0, spread, shape)
    return np.maximum(np.round(offset + rng.normal(0.0, 0.8, (50, *shape))), 0.0)


@pytest.mark.parametrize("spread", [8.0, 40.0])
@pytest.mark.parametrize("seed", range(6))
def test_offsets_that_a_device_cuts_off_at_0_are_no_object(spread, seed):
    values = cut_off(spread, seed)
    assert resting(values, "it").good.all()
    assert resting_among_objects(values, "it").stuck.sum() == 0
    values[:, 3, 5] += 20.0 * spread
    assert [tuple(at) for at in np.argwhere(resting(values, "it").stuck)] == [(3, 5)]
    values[:, 8:11, 5:8] += 20.0 * spread
    with pytest.raises(DataError, match="not empty: 9 neighbouring elements around row 9, column"):
        resting(values, "it")


@pytest.mark.parametrize("n", [2, 6, 11])
def test_an_object_on_a_pad_that_reads_nothing_is_no_offset(n):
    values = np.zeros((20, 16, 16))
    values[:, 2 : 2 + n, 3 : 3 + n] = 30.0 + np.arange(n)
    with pytest.raises(DataError, match=rf"not empty: {n * n} neighbouring elements"):
        resting(values, "it")


def test_hum_that_a_device_cuts_off_at_0_is_no_touch():
    rng = np.random.default_rng(6)
    phase = 0.155 * np.arange(16)[:, None] + rng.random((50, 1, 1))
    hum = 4.0 * np.sin(2.0 * np.pi * phase) + rng.normal(0.0, 0.5, (50, 16, 16))
    values = np.maximum(np.round(hum), 0.0)
    found = resting(values, "it")
    assert found.left_out == 0
    assert found.good.all()
    values[20:30, 3:5, 5:8] += 100.0
    with pytest.raises(DataError, match="not empty: in 10 of 50 frames, first in frame 20"):
        resting(values, "it")


def test_noisy_still_and_missing_elements_are_no_good():
    rng = np.random.default_rng(2)
    _, values = still_pad()
    values[:, 1, 1] += 5.0 * rng.standard_normal(80)
    values[:, 2, 2] = 1.0
    values[:, 4, 4] = np.nan
    found = resting(values, "it")
    assert [tuple(at) for at in np.argwhere(found.noisy)] == [(1, 1)]
    assert [tuple(at) for at in np.argwhere(found.still)] == [(2, 2)]
    assert [tuple(at) for at in np.argwhere(found.missing)] == [(4, 4)]
    assert (~found.good).sum() == 3


def test_a_few_touched_frames_are_left_out_and_many_are_refused():
    _, values = still_pad()
    values[10:14, 3:5, 5:7] += 50.0
    assert resting(values, "it").left_out == 4
    values[10:30, 3:5, 5:7] += 50.0
    with pytest.raises(DataError, match=r"not empty: in 20 of 80 frames, first in frame 10"):
        resting(values, "it")


def test_elements_touched_in_less_than_half_of_the_frames_show_their_own_rest():
    offset, values = still_pad(200, seed=3)
    rng = np.random.default_rng(4)
    values += 80.0 * (rng.random(values.shape) < 0.3)
    found = resting_among_objects(values, "it")
    assert np.median(np.abs(found.offset - offset)) < 0.4
    assert not found.stuck.any()
    assert not found.from_empty


@pytest.mark.parametrize("n", [1, 4])
def test_too_few_frames_are_refused(n):
    with pytest.raises(DataError, match=rf"too few frames of the empty pad: got {n}, at least 5"):
        resting(still_pad(n)[1], "it")
    with pytest.raises(DataError, match="without a recording of it"):
        resting_among_objects(still_pad(n)[1], "it")


def test_nothing_ever_read_is_refused():
    with pytest.raises(DataError, match="no element was ever read"):
        resting(np.full((9, *SHAPE), np.nan), "it")


def test_a_converter_coarser_than_the_noise_still_has_the_noise_of_its_rounding():
    found = resting(np.zeros((20, *SHAPE)), "it")
    assert found.usual_noise == 0.0
    assert found.stepped(4.0).usual_noise == pytest.approx(4.0 / np.sqrt(12.0))


def test_the_step_of_readings_is_their_smallest_difference():
    rng = np.random.default_rng(5)
    assert step_of(rng.standard_normal((40, 9, 9))) == 0.0
    assert step_of(0.25 * rng.integers(0, 30, (40, 9, 9))) == 0.25


def test_what_lies_in_one_place_most_of_the_time_is_not_taken_for_the_empty_pad():
    _, values = still_pad()
    values[:60, 3:5, 5:8] += 100.0
    with pytest.raises(DataError, match=r"in more than half of the frames.*give it by --empty"):
        resting_among_objects(values, "it")


@pytest.mark.parametrize("least", [-np.inf, 0.0])
@pytest.mark.parametrize("share", [0.2, 0.4])
@pytest.mark.parametrize("columns", [5, 14])
def test_what_comes_and_goes_is_no_noise_however_large_it_is(least, share, columns):
    rng = np.random.default_rng(14)
    values = rng.normal(0.0, 1.0, (80, 16, 16))
    values[rng.permutation(80)[: int(80 * share)], :, :columns] += 300.0
    with pytest.raises(DataError, match=f"not empty: in {int(80 * share)} of 80 frames"):
        resting(np.maximum(np.round(values), least), "it")


@pytest.mark.slow
def test_the_noise_among_objects_takes_little_more_memory_than_the_frames():
    values = np.random.default_rng(0).normal(size=(4000, 16, 16))
    values[3, 2] = np.nan
    tracemalloc.start()
    try:
        found = resting_among_objects(values, "it")
        _, peak = tracemalloc.get_traced_memory()
    finally:
        tracemalloc.stop()
    assert peak < 2.6 * values.nbytes
    below = np.where(values < found.offset, values - found.offset, np.nan)
    np.testing.assert_array_equal(found.noise, np.sqrt(np.nanmean(below**2, axis=0)))
