"""What a fit found is told with its longer extent first and its angle in one half turn."""

import math

import numpy as np
import pytest

from tactile_graph_fitters.orientation.oriented import Oriented, axis_angle


def test_the_longer_extent_comes_first_and_the_angle_is_its_own() -> None:
    found = Oriented(1.0, 2.0, 3.0, 5.0, 0.25).longer_first()
    assert found == (1.0, 2.0, 5.0, 3.0, pytest.approx(0.25 - 0.5 * math.pi))
    assert found.longer_first() == found


def test_numbers_come_out_as_plain_floats() -> None:
    found = Oriented(*np.array([1.0, 2.0, 3.0, 5.0, 0.25])).longer_first()
    assert {type(value) for value in found} == {float}


@pytest.mark.parametrize("turns", [-3, -1, 0, 1, 2])
def test_an_axis_is_the_same_after_half_turns(turns: int) -> None:
    assert axis_angle(0.3 + turns * math.pi) == pytest.approx(0.3)


def test_an_upright_axis_points_up() -> None:
    assert axis_angle(-0.5 * math.pi) == 0.5 * math.pi
