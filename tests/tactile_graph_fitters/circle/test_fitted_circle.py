"""The record of a fit."""

import dataclasses

import pytest

from tactile_graph.wires import Circle
from tactile_graph_fitters.circle.fitted_circle import FittedCircle


def test_quick_way_makes_the_same_record():
    slow = FittedCircle(1.0, 2.0, 3.0, 0.5, 12, 4)
    quick = FittedCircle.quickly(1.0, 2.0, 3.0, 0.5, 12, 4)
    assert quick == slow
    assert hash(quick) == hash(slow)
    assert repr(quick) == repr(slow)
    assert dataclasses.replace(quick, n_points=7).n_points == 7


def test_quickly_made_records_are_frozen_circles_with_more_columns():
    quick = FittedCircle.quickly(1.0, 2.0, 3.0, 0.5, 12, 4)
    assert isinstance(quick, Circle)
    assert quick.columns_shown == ("x_cm", "y_cm", "radius_cm", "rms_cm", "n_points")
    with pytest.raises(dataclasses.FrozenInstanceError, match="radius_cm"):
        quick.radius_cm = 1.0
