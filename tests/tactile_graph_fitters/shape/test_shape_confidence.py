"""What the confidences of a shape decision are made of."""

import math

import numpy as np
import pytest

from tactile_graph_fitters.shape.shape_confidence import (
    KINDS,
    MOST_CORNERS,
    WEIGHTS,
    confidences,
    features,
)


def test_features_are_logarithms_of_length_and_squared_distances_in_cells():
    mean_squares = np.array([0.3, 0.2, 0.1, 0.5, 0.4, 0.2, 0.1])
    found = features(52.0, mean_squares, 1.3)
    assert found[:2] == pytest.approx([1.0, math.log(2.0)])
    assert found[2:] == pytest.approx(np.log(mean_squares / 1.69 + 0.01))


def test_a_hull_of_few_corners_is_its_own_polygon_and_what_does_not_fit_is_far_off():
    mean_squares = np.array([0.3, np.inf, 0.1, 0.5, 0.002, np.inf, np.inf])
    found = features(26.0, mean_squares, 1.0)
    assert found[3] == pytest.approx(math.log(5.01))
    assert found[6] == found[7] == found[8] == pytest.approx(math.log(0.012))


def test_only_polygons_of_up_to_six_corners_count():
    mean_squares = np.linspace(0.7, 0.1, MOST_CORNERS + 3)
    assert np.array_equal(features(30.0, mean_squares, 1.3), features(30.0, mean_squares[:-2], 1.3))


def test_confidences_are_a_logistic_regression_and_sum_to_1():
    found = features(30.0, np.full(7, 0.2), 1.3)
    for temperature in (0.5, 1.0, 3.0):
        share = confidences(found, temperature)
        scores = np.exp(found @ WEIGHTS / temperature)
        assert share == pytest.approx(scores / scores.sum())


@pytest.mark.parametrize("row", range(3))
def test_the_nearer_a_shape_the_likelier_it_is(row):
    mean_squares = np.full(7, 0.2)
    before = confidences(features(30.0, mean_squares, 1.3))[row]
    mean_squares[row] = 0.1
    assert confidences(features(30.0, mean_squares, 1.3))[row] > before


def test_the_weights_are_those_of_every_kind():
    assert WEIGHTS.shape == (4 + MOST_CORNERS - 1, len(KINDS))
    assert WEIGHTS.sum(axis=1) == pytest.approx(0.0, abs=0.005)


def test_confidences_are_those_of_temperature_1_unless_told():
    found = features(52.0, np.array([0.3, 0.2, 0.1, 0.5, 0.4, 0.2, 0.1]), 1.3)
    assert confidences(found) == confidences(found, 1.0)
