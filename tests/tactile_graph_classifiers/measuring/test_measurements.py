from __future__ import annotations

import numpy as np
import pytest

from helpers_classifiers import reading
from tactile_graph import Circle
from tactile_graph.errors import DataError
from tactile_graph_classifiers.measuring.fitted_area import fitted_area
from tactile_graph_classifiers.measuring.mean_reading import MeanReading
from tactile_graph_classifiers.measuring.measurements import Measurements


def test_positions_follow_the_wanted_order():
    assert reading(1.0, 2.0).positions(("area_cm2", "weight")).tolist() == [1, 0]


def test_a_feature_that_was_not_measured_is_named_with_the_nearest():
    with pytest.raises(DataError, match="'wieght' was not measured; did you mean 'weight'"):
        reading(1.0, 2.0).positions(("wieght",))
    with pytest.raises(DataError, match="'holes' was not measured; there are: area_cm2, weight"):
        reading(1.0, 2.0).positions(("holes",))


def test_the_area_of_a_fitted_circle_takes_the_place_of_the_footprints():
    found = fitted_area(reading(5.0, 2.0), Circle(1.0, 1.0, 2.0))
    assert found.names == ("weight", "area_cm2")
    assert found.values.tolist() == pytest.approx([5.0, np.pi * 4.0])
    assert found.quantity == "gram"
    added = fitted_area(Measurements(("weight",), np.array([5.0])), Circle(0.0, 0.0, 1.0))
    assert added.names == ("weight", "area_cm2")


def test_the_mean_is_of_the_last_readings_only():
    mean = MeanReading(readings=2)
    found = [mean(reading(w, 1.0)).values[0] for w in (1.0, 3.0, 7.0)]
    assert found == [1.0, 2.0, 5.0]


def test_the_mean_starts_anew_after_a_long_gap_or_with_other_features():
    mean = MeanReading(readings=5, start_anew_s=10.0)
    mean(reading(1.0, 1.0), gap_s=None)
    assert mean(reading(3.0, 1.0), gap_s=9.0).values[0] == 2.0
    assert mean(reading(8.0, 1.0), gap_s=11.0).values[0] == 8.0
    assert mean(reading(5.0, 1.0), gap_s=-2.0).values[0] == 5.0  # the clock goes back
    assert mean(Measurements(("weight",), np.array([4.0])), gap_s=1.0).values.tolist() == [4.0]
