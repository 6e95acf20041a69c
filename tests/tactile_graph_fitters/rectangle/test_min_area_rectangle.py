"""The smallest rectangle around points, by calipers."""

import math

import numpy as np
import pytest
from hypothesis import given, settings

from helpers_rectangles import off_rad, points, rectangle_xy, seeds, some_rectangle, turned
from tactile_graph.errors import Degenerate
from tactile_graph.wires import Points, Rectangle
from tactile_graph_fitters.rectangle.min_area_rectangle import min_area_rectangle


@settings(max_examples=40, deadline=None)
@given(seed=seeds)
def test_truth_to_points_to_truth(seed):
    rng = np.random.default_rng(seed)
    truth = some_rectangle(rng)
    inside = rectangle_xy(truth, 30) * 0.3 + 0.7 * np.array([truth.x_cm, truth.y_cm])
    xy = np.vstack([truth.outline_cm(), inside])
    got = min_area_rectangle(Points(rng.permutation(xy)))
    assert (got.x_cm, got.y_cm) == pytest.approx((truth.x_cm, truth.y_cm), abs=1e-9)
    assert (got.length_cm, got.breadth_cm) == pytest.approx(
        (truth.length_cm, truth.breadth_cm), abs=1e-9
    )
    assert off_rad(got.angle_rad, truth.angle_rad) < 1e-9
    assert got.misfit < 1e-9


@pytest.mark.slow
@settings(max_examples=40, deadline=None)
@given(seed=seeds)
def test_no_angle_gives_a_smaller_box_and_all_points_are_inside(seed):
    xy = np.random.default_rng(seed).normal(0, 1, (25, 2)) * (3.0, 1.0)
    got = min_area_rectangle(Points(xy.copy()))
    for angle in np.linspace(0, math.pi / 2, 91):
        width, height = np.ptp(turned(xy, angle), axis=0)
        assert got.area_cm2 <= width * height * (1 + 1e-9)
    flat = turned(xy - (got.x_cm, got.y_cm), -got.angle_rad)
    assert np.abs(flat[:, 0]).max() <= got.length_cm / 2 + 1e-9
    assert np.abs(flat[:, 1]).max() <= got.breadth_cm / 2 + 1e-9
    assert 0.0 < got.misfit < 1.0


def test_the_misfit_is_the_empty_share_of_the_rectangle():
    got = min_area_rectangle(points([[0, 0], [4, 0], [0, 4]]))
    assert got.misfit == pytest.approx(0.5)


def test_points_on_a_line_have_no_rectangle():
    with pytest.raises(Degenerate, match="3 points on one line: no rectangle around them"):
        min_area_rectangle(points([[0, 0], [1, 1], [2, 2]]))


def test_a_square_is_ambiguous_and_a_slender_one_is_not():
    square, slender = (Rectangle(0, 0, 9, breadth, 0.1).outline_cm() for breadth in (9, 3))
    assert min_area_rectangle(points(square)).ambiguous
    assert not min_area_rectangle(points(slender)).ambiguous


def test_of_two_as_small_either_is_ambiguous():
    """Which one is found may hang on the last bit: 14 by 11 or 12.7 by 12.1, both of 154."""
    xy = np.array([[11, 15], [14, 8], [15, 15], [15, 1], [7, 9], [4, 6]], float)
    for its in (xy, xy * [1.0, -1.0], xy * [-1.0, 1.0], xy[:, ::-1]):
        got = min_area_rectangle(points(its))
        assert got.area_cm2 == pytest.approx(154.0)
        assert got.ambiguous
