"""Masks turned cell by cell and rounded, as figures 4.30 and 4.31 show."""

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import references_fitters as references
from helpers_modes import held
from helpers_rectangles import covered, off_rad, seeds
from tactile_graph.errors import Degenerate
from tactile_graph.wires import Mask, Rectangle
from tactile_graph_filters.morphology.close import Close
from tactile_graph_fitters.orientation.orientation import Orientation, orientation
from tactile_graph_fitters.orientation.rotate_mask import rotate_mask, rotated


@pytest.mark.slow
@settings(max_examples=30, deadline=None)
@given(degrees=st.floats(-89.0, 90.0))
def test_a_turned_mask_lies_along_x_about_the_same_centre(degrees):
    truth = Rectangle(10.2, 9.7, 14.0, 5.0, math.radians(degrees))
    mask = covered(truth, (160, 160), 0.13)
    axis = orientation(mask)
    # Filled first: where cells were hit by two, the voids shift the mean.
    got = orientation(Close(element="cross3")(rotate_mask(mask, axis)))
    assert off_rad(got.angle_rad, 0.0) < 0.01
    # Rounding to cells of 0.13 cm may shift all of a nearly level edge by up to half a cell.
    assert (got.x_cm, got.y_cm) == pytest.approx((axis.x_cm, axis.y_cm), abs=0.065)


def test_rounding_leaves_voids_that_closing_with_a_cross_fills():
    mask = covered(Rectangle(10.0, 10.0, 14.0, 6.0, 0.7), (160, 160), 0.13)
    axis = orientation(mask)
    rounded = rotate_mask(mask, axis)
    filled = Close(element="cross3")(rounded)
    inner = (slice(4, rounded.rows - 4), slice(4, rounded.columns - 4))
    assert 0.0 < 1.0 - rounded.values[inner].mean() < 0.2
    assert filled.values[inner].all()
    assert filled.area_cm2 == pytest.approx(84.0, rel=0.03)


def test_no_turn_moves_the_cells_by_half_a_cell_at_most():
    mask = covered(Rectangle(5.0, 4.0, 6.0, 3.0, 0.0), (20, 20), 0.5)
    axis = Orientation(0.0, 5.1, 4.2, 0.5, 0.0, False)
    got = rotate_mask(mask, axis)
    assert got.count == mask.count
    here, there = orientation(mask), orientation(got)
    assert abs(there.x_cm - here.x_cm) <= 0.25
    assert abs(there.y_cm - here.y_cm) <= 0.25


def test_cells_that_are_not_square_become_square_ones_as_large():
    values = np.zeros((30, 20), bool)
    values[5:25, 8:12] = True
    mask = Mask(values, (1.0, 0.5), (2.0, 1.0))
    axis = orientation(mask)
    got = rotate_mask(mask, axis)
    assert got.pitch_cm == (math.sqrt(0.5), math.sqrt(0.5))
    x, y = got.x_cm, got.y_cm
    assert np.ptp(x) == pytest.approx(9.5, abs=1.0)
    assert np.ptp(y) == pytest.approx(3.0, abs=1.0)


def test_an_empty_mask_cannot_be_turned():
    axis = Orientation(0.3, 1.0, 1.0, 0.5, 0.0, False)
    with pytest.raises(Degenerate, match="no cell is on: nothing to turn"):
        rotate_mask(Mask(np.zeros((5, 5), bool)), axis)


@pytest.mark.slow  # much is compiled
@settings(max_examples=20, deadline=None)
@given(seed=seeds, angle=st.floats(-1.5, 1.5))
def test_it_turns_as_the_reference_does(seed, angle):
    values = held(np.random.default_rng(seed).random((9, 12)) < 0.4)
    settings_ = (5.3, 4.1, math.cos(angle), math.sin(angle), 1.1, 0.9)
    expected = references.rotated(values, *settings_)
    for which in (rotated.loops, rotated.compiled):
        got = which(values, *settings_)
        np.testing.assert_array_equal(got[0], expected[0])
        assert got[1:] == expected[1:]


def test_cells_far_from_square_make_no_endless_mask() -> None:
    mask = Mask(np.ones((4, 4), dtype=np.bool_), (1e-6, 1e6))
    with pytest.raises(Degenerate, match=r"turned, cells of 1e-06 by 1e\+06 cm would be too many"):
        rotate_mask(mask, Orientation(0.5, 0.0, 0.0, 1.0, 0.0, False))
