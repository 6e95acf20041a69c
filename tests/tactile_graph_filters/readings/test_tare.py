import math

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
    tare = settled(drift_s=10.0)
    found = tare(image_of(EMPTY + 5.0, "counts"), gap=10.0)
    assert found.values == pytest.approx(np.full((3, 3), 5.0 * math.exp(-1.0)))
    tare = settled(drift_s=10.0, frame_s=5.0)
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
