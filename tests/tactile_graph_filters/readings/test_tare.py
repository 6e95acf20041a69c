import math
from contextlib import suppress

import numpy as np
import pytest

from helpers_filters import image_of, same_grid
from tactile_graph.errors import DataError, Skip
from tactile_graph_filters.readings.tare import Tare

EMPTY = np.array([[3.0, 5.0, 4.0], [2.0, 9.0, 4.0], [3.0, 3.0, 3.0]])


def settled(**settings):
    tare = Tare(n_frames=3, **settings)
    for _ in range(2):
        with pytest.raises(Skip):
            tare(image_of(EMPTY, "counts"))
    tare(image_of(EMPTY, "counts"))
    return tare


def test_the_median_of_the_first_frames_is_taken_off():
    tare = Tare(n_frames=3)
    with pytest.raises(Skip, match="warming up: frame 1 of 3 of the empty pad"):
        tare(image_of(EMPTY, "counts"))
    with pytest.raises(Skip, match="frame 2 of 3"):
        tare(image_of(EMPTY + 1000.0, "counts"))  # someone leant on it
    assert tare(image_of(EMPTY, "counts")).total == 0.0
    image = image_of(EMPTY + 7.0, "counts")
    found = tare(image)
    assert found.values.tolist() == np.full((3, 3), 7.0).tolist()
    assert found.quantity == "counts"
    assert same_grid(image, found)


def test_without_drift_the_baseline_stays():
    tare = settled()
    for _ in range(50):
        found = tare(image_of(EMPTY + 5.0, "counts"), gap=1.0)
    assert (found.values == 5.0).all()


def test_untouched_cells_drift_to_zero_by_the_true_time():
    tare = settled(drift_s=10.0, touched=25.0)
    found = tare(image_of(EMPTY + 5.0, "counts"), gap=10.0)
    assert found.values == pytest.approx(np.full((3, 3), 5.0 * math.exp(-1.0)))
    tare = settled(drift_s=10.0, frame_s=5.0, touched=25.0)
    for _ in range(2):  # without a clock two frames of 5 s are 10 s
        found = tare(image_of(EMPTY + 5.0, "counts"), gap=None)
    assert found.values == pytest.approx(np.full((3, 3), 5.0 * math.exp(-1.0)))


def test_a_resting_object_and_its_neighbours_are_frozen():
    tare = settled(drift_s=1.0, touched=25.0)
    load = np.zeros((3, 3))
    load[0, 0], load[0, 1], load[2, 2] = 100.0, 20.0, 20.0
    for _ in range(20):
        found = tare(image_of(EMPTY + load, "counts"), gap=1.0)
    assert (found.values[0, 0], found.values[0, 1]) == (100.0, 20.0)
    assert found.values[2, 2] == pytest.approx(0.0, abs=1e-6)


def test_clip_leaves_nothing_below_zero():
    assert settled()(image_of(EMPTY - 1.0, "counts")).peak == -1.0
    assert settled(clip=True)(image_of(EMPTY - 1.0, "counts")).total == 0.0


def test_invalid_cells_stay_invalid_and_hold_zero():
    valid = np.ones((3, 3), bool)
    valid[1, 1] = False
    found = settled()(image_of(np.where(valid, EMPTY + 1.0, 0.0), "counts", valid))
    assert found.values[1, 1] == 0.0
    assert not found.valid[1, 1]
    assert found.total == 8.0


def test_another_shape_is_refused():
    with pytest.raises(DataError, match=r"must keep its shape .* got \(1, 1\) after \(3, 3\)"):
        settled()(image_of([[1.0]]))
    warming = Tare(n_frames=3)
    with pytest.raises(Skip):
        warming(image_of(EMPTY))
    with pytest.raises(DataError, match="must keep its shape"):
        warming(image_of([[1.0]]))


def test_nan_is_refused():
    with pytest.raises(DataError, match="row 0, column 0: must be a number, got nan"):
        Tare()(image_of([[math.nan]]))


def test_a_missing_reading_is_none_of_the_baseline_and_lets_nothing_drift():
    rng = np.random.default_rng(0)
    tare = Tare(n_frames=30, drift_s=2.0, touched=25.0)
    for k in range(200):
        valid = np.ones((6, 6), bool)
        valid[1, 1] = k >= 16  # a loose connector for most of the first frames
        valid[2, 4] = False
        valid[3, 3] = not 40 <= k < 60
        valid[5, 5] = k >= 30  # nobody knows what it reads empty
        values = np.where(valid, 100.0 + rng.normal(0.0, 0.5, (6, 6)), 0.0)
        with suppress(Skip):
            found = tare(image_of(values, "counts", valid), gap=0.05)
            valid[5, 5] = False
            assert (found.valid == valid).all()
            assert np.abs(found.values).max() < 4.0


@pytest.mark.parametrize("unit", [1e-3, 1.0, 1e3])
def test_what_tells_a_touch_is_the_empty_pads_own_noise_in_any_unit(unit):
    rng = np.random.default_rng(0)
    tare, load = Tare(drift_s=1.0), np.zeros((8, 8))
    load[2:4, 2:4] = 20.0
    for k in range(400):
        drift = 0.01 * k
        values = 100.0 + drift + (load if k >= 100 else 0.0) + rng.normal(0.0, 0.5, (8, 8))
        with suppress(Skip):
            found = tare(image_of(unit * values, "counts"), gap=0.05)
    assert (found.values[2:4, 2:4] > 17.0 * unit).all()  # and has drifted with the pad
    assert np.abs(found.values[6:]).max() < 3.0 * unit


@pytest.mark.parametrize(("empty", "level"), [(0.0, 0.0), (EMPTY, 2.0)])
def test_a_pad_without_noise_is_touched_from_two_steps_of_its_readings_on(empty, level):
    tare = Tare(n_frames=3, drift_s=1e-3)
    for k in range(9):
        load = 0.0 if k < 3 else np.where(np.eye(3) > 0, level + 1e-9, 0.0)
        with suppress(Skip):
            found = tare(image_of(empty + load + np.zeros((3, 3)), "counts"), gap=1.0)
    assert found.values.tolist() == pytest.approx((level + 1e-9) * np.eye(3))
    assert tare._touched == pytest.approx(level, abs=1e-300)


def test_a_single_frame_of_the_empty_pad_leaves_the_drift_to_be_followed():
    rng = np.random.default_rng(0)
    tare = Tare(n_frames=1, drift_s=2.0)
    rest = rng.normal(100.0, 20.0, (8, 8))
    for k in range(400):
        values = rest + 0.02 * k + rng.normal(0.0, 0.5, (8, 8))
        found = tare(image_of(values, "counts"), gap=0.05)
    assert np.abs(found.values).max() < 4.0
