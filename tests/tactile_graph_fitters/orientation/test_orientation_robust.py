"""The axis of broken footprints: holes, breaks and strays."""

import math

import numpy as np
import pytest

from helpers_rectangles import covered, off_rad
from tactile_graph.errors import Degenerate
from tactile_graph.wires import Mask, Rectangle
from tactile_graph_fitters.orientation.orientation import orientation
from tactile_graph_fitters.orientation.orientation_robust import (
    area_moments,
    larger_parts,
    orientation_robust,
)


def pad(rectangle):
    return covered(rectangle, (16, 16), 1.3)


def test_a_whole_footprint_has_the_axis_of_its_scatter():
    for degrees in (-60, -20, 0, 35, 80):
        mask = covered(Rectangle(10, 10, 14, 5, math.radians(degrees)))
        robust, plain = orientation_robust(mask), orientation(mask)
        assert off_rad(robust.angle_rad, plain.angle_rad) < 0.02
        assert (robust.x_cm, robust.y_cm) == pytest.approx((plain.x_cm, plain.y_cm), abs=0.1)
        assert not robust.ambiguous


def test_survives_the_break_that_turns_the_scatter_matrix_across():
    """Most of the length is left as single cells, one end as a full bar across it."""
    values = np.zeros((16, 16), bool)
    values[2:12, 2] = True
    values[2:12, 3] = True
    values[2, 3:13:1] = True
    values[11, 12] = True
    values[11, 4:12:2] = True
    values[10, 5:12:2] = True
    mask = Mask(values)
    assert off_rad(orientation(mask).angle_rad, 0.0) > math.radians(30)
    got = orientation_robust(mask)
    assert got.ambiguous or off_rad(got.angle_rad, 0.0) < math.radians(15)


@pytest.mark.slow
def test_random_voids_cost_less_than_they_cost_the_scatter_matrix():
    rng = np.random.default_rng(1)
    plain, robust = [], []
    for _ in range(150):
        truth = Rectangle(*rng.uniform(9.8, 10.8, 2), 15.0, 7.0, rng.uniform(-1.5, 1.5))
        whole = pad(truth)
        mask = whole.with_values(whole.values & (rng.random((16, 16)) > 0.25))
        plain.append(off_rad(orientation(mask).angle_rad, truth.angle_rad))
        robust.append(off_rad(orientation_robust(mask).angle_rad, truth.angle_rad))
    assert np.mean(robust) < 0.95 * np.mean(plain)


def test_strays_far_off_are_left_out():
    whole = pad(Rectangle(11.0, 8.0, 12.0, 5.0, 0.2))
    values = whole.values.copy()
    values[15, 0] = values[14, 15] = True
    got, clean = orientation_robust(whole.with_values(values)), orientation_robust(whole)
    assert got == clean


def test_pieces_of_a_broken_footprint_are_kept_together():
    truth = Rectangle(10.0, 10.0, 16.0, 5.0, 0.5)
    whole = pad(truth)
    x, y = np.meshgrid(whole.x_cm, whole.y_cm)
    along = (x - 10.0) * math.cos(0.5) - (y - 10.0) * math.sin(0.5)
    broken = whole.with_values(whole.values & (abs(along) > 3.0))
    got = orientation_robust(broken)
    assert off_rad(got.angle_rad, 0.5) < math.radians(4)
    assert (got.x_cm, got.y_cm) == pytest.approx((10.0, 10.0), abs=0.5)


def test_squares_are_declared_ambiguous():
    assert orientation_robust(pad(Rectangle(10, 10, 9, 9, 0.3))).ambiguous


def test_one_row_of_cells_has_its_direction():
    values = np.zeros((5, 9), bool)
    values[2, 1:8] = True
    assert orientation_robust(Mask(values)).angle_rad == pytest.approx(0.0)


def test_nothing_and_a_single_cell_have_none():
    values = np.zeros((5, 5), bool)
    with pytest.raises(Degenerate, match="no cell is on: no direction"):
        orientation_robust(Mask(values.copy()))
    values[2, 2] = True
    with pytest.raises(Degenerate, match="all at one place: no direction"):
        orientation_robust(Mask(values))


def test_moments_of_an_area_are_those_of_a_rectangle():
    corners = Rectangle(3.0, 4.0, 6.0, 2.0, 0.0).outline_cm()
    assert area_moments(corners) == pytest.approx((3.0, 4.0, 3.0, 0.0, 1.0 / 3.0))


def test_parts_below_the_share_go():
    values = np.zeros((8, 8), bool)
    values[1:4, 1:5] = True
    values[6, 6] = True
    assert len(larger_parts(Mask(values), 0.15)) == 12
    assert len(larger_parts(Mask(values), 0.05)) == 13
