"""Thesis section 4.4 in small: what it concludes comes out on the simulated pad."""

from __future__ import annotations

import numpy as np
import pytest

from tactile_graph_thesis.measure.identification_errors import (
    PAIRS,
    Confusion,
    Trials,
    added,
    error_curves,
    strangers_rejected,
    table_4_9,
)
from tactile_graph_thesis.measure.weighing import calibration_curve


@pytest.mark.slow  # much is compiled
def test_all_readings_of_the_five_objects_are_identified_where_weights_are_right():
    found = table_4_9(seed=3, kind="footprint")
    assert {name: c.share_right for name, c in found.items()} == dict.fromkeys(found, 1.0)
    assert all(c.n >= 120 for c in found.values())
    assert all(c.share_rejected < 0.06 for c in found.values())


@pytest.mark.slow
@pytest.mark.parametrize("seed", [0, 4, 11])
def test_with_the_thesis_weights_the_modified_distance_is_right_and_equation_4_8_is_not(seed):
    found = table_4_9(seed=seed)
    assert found["minimum_distance_normalised"].share_right == 1.0
    assert 0.8 < found["minimum_distance"].share_right < 0.99


def test_confusions_add_up():
    one = Confusion(("a", "b"), {("a", "a"): 3, ("b", "a"): 1}, {"a": 1}, 4)
    two = Confusion(("a", "b"), {("b", "b"): 4}, {}, 4)
    both = added([one, two])
    assert (both.n, both.share_right, both.share_rejected) == (8, 7 / 8, 1 / 8)
    assert both.names == ("a", "b")


@pytest.mark.slow
def test_an_object_that_was_not_learned_is_called_unknown():
    assert min(strangers_rejected(seed=1).values()) > 0.95


@pytest.mark.slow
@pytest.mark.parametrize("kind", ["curve", "decoupled"])
def test_beyond_1000_g_fewer_than_5_percent_are_wrong_and_at_0_g_it_is_a_guess(kind):
    curves = error_curves(PAIRS[:1], Trials(kind, (0, 1500), n_test=25))
    for step in ("minimum_distance_normalised", "mahalanobis"):
        same, beyond = curves[0].error[step]
        assert 0.25 < same < 0.75
        assert beyond < 0.05


@pytest.mark.slow
def test_discs_of_different_radius_are_told_apart_even_at_equal_weight():
    curve = error_curves(PAIRS[4:5], Trials("decoupled", (0,), n_test=25))[0]
    assert curve.error["mahalanobis"][0] < 0.02


def test_the_calibration_curve_rises_up_to_the_supply():
    curve = np.array(calibration_curve(seed=1))
    assert (np.diff(curve[:, 0]) > 0).all()
    assert (np.diff(curve[:, 1]) >= 0).all()
    assert curve[-1, 0] == 5.0
    assert curve[-1, 1] <= 750.0
