from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

from helpers_classifiers import digital_disc, image_and_mask
from helpers_modes import held
from tactile_graph.errors import DataError, Degenerate, RuleError
from tactile_graph_classifiers.measuring.feature_sums import feature_sums
from tactile_graph_classifiers.measuring.features import NAMES, FeaturesOf
from tactile_graph_classifiers.measuring.measurements import Measurements

features = FeaturesOf()


def test_a_rectangle_has_the_weight_area_moments_and_axes_of_a_rectangle():
    on = np.zeros((12, 20), bool)
    on[3:7, 5:15] = True
    found = features(*image_and_mask(on, np.where(on, 2.5, 9.0), pitch=(1.3, 1.3)))
    length, breadth = 10 * 1.3, 4 * 1.3
    assert found.weight == pytest.approx(100.0)
    assert found.area_cm2 == pytest.approx(length * breadth)
    assert found.moment_xx_cm2 == pytest.approx(length**2 / 12)
    assert found.moment_yy_cm2 == pytest.approx(breadth**2 / 12)
    assert found.moment_xy_cm2 == pytest.approx(0.0, abs=1e-12)
    assert found.semi_major_cm == pytest.approx(length / math.sqrt(3))
    assert found.axis_ratio == pytest.approx(0.4)
    assert (found.load_mean, found.load_sd, found.peak) == pytest.approx((2.5, 0.0, 2.5))
    assert found.peak_share == pytest.approx(1 / 40)
    assert found.load_offset_cm == pytest.approx(0.0, abs=1e-12)
    assert found.quantity == "gram"


def test_a_large_disc_is_compact_and_round_with_hus_moments_of_a_disc():
    found = features(*image_and_mask(digital_disc(25.0), pitch=(0.2, 0.2)))
    assert found.semi_major_cm == pytest.approx(5.0, rel=0.005)
    assert found.perimeter_cm == pytest.approx(2 * math.pi * 5.0, rel=0.02)
    assert found.compactness == pytest.approx(1.0, abs=0.04)
    assert found.hu_1 == pytest.approx(1 / (2 * math.pi), rel=0.002)
    assert found.hu_2 == pytest.approx(0.0, abs=1e-6)
    assert found.axis_ratio == pytest.approx(1.0, abs=1e-6)
    assert found.holes == 0


def test_the_perimeter_of_a_disc_is_right_on_cells_that_are_no_squares():
    x, y = np.meshgrid((np.arange(80) + 0.5) * 0.15, (np.arange(48) + 0.5) * 0.25)
    on = (x - 6.0) ** 2 + (y - 6.0) ** 2 <= 25.0
    found = features(*image_and_mask(on, pitch=(0.15, 0.25)))
    assert found.perimeter_cm == pytest.approx(2 * math.pi * 5.0, rel=0.03)
    assert found.axis_ratio == pytest.approx(1.0, abs=0.01)


def test_holes_are_background_enclosed_by_sides_and_those_at_the_edge_are_none():
    on = np.array(
        [[0, 1, 1, 1, 1, 0], [1, 0, 1, 0, 1, 1], [1, 1, 1, 1, 0, 1], [0, 1, 1, 1, 1, 1]], bool
    )
    # the middle two touch at a corner only: two holes; the corners are open
    assert features(*image_and_mask(on)).holes == 3
    ring = np.ones((5, 5), bool)
    ring[2, 2] = False
    assert features(*image_and_mask(ring)).holes == 1
    ring[2, 0:2] = False
    assert features(*image_and_mask(ring)).holes == 0


def test_the_load_offset_points_from_the_centroid_to_the_load():
    found = features(*image_and_mask([[1, 1, 1]], [[1.0, 1.0, 4.0]], pitch=(2.0, 1.0)))
    assert found.load_offset_cm == pytest.approx(1.0)  # load centre at 1.5 cells of 2 cm, not 1


def test_invalid_cells_count_for_the_shape_but_not_for_the_load():
    valid = np.array([[True, True, False]])
    found = features(*image_and_mask([[1, 1, 1]], [[2.0, 4.0, 0.0]], valid=valid))
    assert (found.area_cm2, found.weight, found.load_mean, found.load_sd) == (3.0, 6.0, 3.0, 1.0)


def test_readings_outside_the_footprint_count_for_nothing():
    found = features(*image_and_mask([[1, 0]], [[2.0, 400.0]]))
    assert (found.weight, found.peak) == (2.0, 2.0)


def test_what_turns_or_moves_with_the_object_does_not_change_the_other_features():
    rng = np.random.default_rng(3)
    on = np.zeros((20, 20), bool)
    on[4:9, 3:15] = rng.random((5, 12)) < 0.8
    values = rng.random((20, 20))
    first = features(*image_and_mask(on, values)).measurements
    turned = features(*image_and_mask(np.rot90(on), np.rot90(values).copy())).measurements
    shift = features(
        *image_and_mask(np.roll(on, (5, 2), (0, 1)), np.roll(values, (5, 2), (0, 1)))
    ).measurements
    np.testing.assert_allclose(shift.values, first.values, rtol=1e-9, atol=1e-12)
    for name, a, b in zip(NAMES, turned.values, first.values, strict=True):
        if not name.startswith("moment"):
            assert a == pytest.approx(b, rel=1e-9, abs=1e-12), name


def test_features_are_taken_as_measurements_in_order_with_their_quantity():
    found = features(*image_and_mask([[1, 1]], [[1.0, 2.0]], quantity="volt"))
    measured = found.measurements
    assert isinstance(measured, Measurements)
    assert measured.names == NAMES
    assert measured.values[NAMES.index("area_cm2")] == found.area_cm2
    assert measured.quantity == "volt"
    assert not measured.values.flags.writeable


@pytest.mark.parametrize("bad", [math.nan, math.inf])
def test_a_reading_that_is_no_number_is_refused(bad):
    with pytest.raises(DataError, match="holds no finite number"):
        features(*image_and_mask([[1, 1]], [[1.0, bad]]))


def test_an_empty_footprint_is_no_object():
    with pytest.raises(Degenerate, match="the footprint is empty"):
        features(*image_and_mask([[0, 0]]))


def test_a_footprint_that_bears_nothing_has_no_weight():
    with pytest.raises(Degenerate, match="2 valid readings under the footprint sum to -1"):
        features(*image_and_mask([[1, 1]], [[-2.0, 1.0]]))
    with pytest.raises(Degenerate, match="0 valid readings"):
        features(*image_and_mask([[1]], [[0.0]], valid=np.array([[False]])))


def test_image_and_mask_of_different_shape_are_refused():
    image, _ = image_and_mask([[1, 1]])
    _, mask = image_and_mask([[1]])
    with pytest.raises(RuleError, match="the same shape"):
        features(image, mask)


@pytest.mark.slow
@settings(max_examples=60, deadline=None)
@given(arrays(np.bool_, st.tuples(st.integers(1, 7), st.integers(1, 7))), st.integers(0, 99))
def test_the_twins_agree(on, seed):
    pytest.importorskip("numba")
    rng = np.random.default_rng(seed)
    values, good = rng.normal(1.0, 1.0, on.shape), on & (rng.random(on.shape) < 0.8)
    arrays_ = held(values), held(on), held(good)
    plain = feature_sums.reference(*arrays_)
    assert feature_sums.compiled(*arrays_) == pytest.approx(plain, rel=1e-9, abs=1e-9)


@settings(max_examples=60, deadline=None)
@given(arrays(np.bool_, st.tuples(st.integers(1, 7), st.integers(1, 7))))
def test_holes_agree_with_scipys_labels(on):
    from scipy.ndimage import label

    holes = feature_sums.reference(np.ones(on.shape), on, on)[16]
    assert holes == label(~np.pad(on, 1))[1] - 1 if on.any() else holes == 0
