"""Sides read off an ellipse, as the thesis reports them and corrected."""

import math

import numpy as np
import pytest
from hypothesis import given, settings

from helpers_rectangles import points, rectangle_xy, seeds, some_rectangle
from tactile_graph.wires import Ellipse, Rectangle
from tactile_graph_fitters.ellipse.fit_ellipse_origin import fit_ellipse_origin
from tactile_graph_fitters.orientation.orientation import Orientation
from tactile_graph_fitters.orientation.rotate_points import rotate_points
from tactile_graph_fitters.rectangle.rectangle_from_ellipse import BIAS, rectangle_from_ellipse


def fitted(truth, n=2000):
    axis = Orientation(truth.angle_rad, truth.x_cm, truth.y_cm, 0.5, 0.0, False)
    return fit_ellipse_origin(rotate_points(points(rectangle_xy(truth, n)), axis), axis)


def test_reports_the_full_axes_and_beside_them_the_sides():
    got = rectangle_from_ellipse(Ellipse(3.0, 4.0, 5.0, 2.0, 0.4))
    assert (got.length_cm, got.breadth_cm) == (10.0, 4.0)
    assert (got.x_cm, got.y_cm, got.angle_rad) == (3.0, 4.0, 0.4)
    assert 8.5 < got.corrected_length_cm < 9.0
    assert 3.2 < got.corrected_breadth_cm < 3.4
    corrected = got.corrected
    assert corrected.length_cm == got.corrected_length_cm
    assert corrected.breadth_cm == got.corrected_breadth_cm


@settings(max_examples=25, deadline=None)
@given(seed=seeds)
def test_corrected_sides_are_those_of_the_rectangle_the_ellipse_was_fitted_to(seed):
    truth = some_rectangle(np.random.default_rng(seed), (0.1, 1.0))
    got = rectangle_from_ellipse(fitted(truth))
    assert got.corrected_length_cm == pytest.approx(truth.length_cm, rel=2e-3)
    assert got.corrected_breadth_cm == pytest.approx(truth.breadth_cm, rel=2e-3)
    assert got.length_cm > 1.12 * truth.length_cm
    assert got.breadth_cm > 1.14 * truth.breadth_cm


@pytest.mark.slow
def test_the_table_is_what_fits_to_rectangles_give():
    for ratio in (0.05, 0.2, 0.5, 0.8, 1.0):
        ellipse = fitted(Rectangle(0.0, 0.0, 2.0, 2.0 * ratio, 0.0), 8000)
        flatness = ellipse.semi_minor_cm / ellipse.semi_major_cm
        row = BIAS[np.abs(BIAS[:, 0] - flatness).argmin()]
        assert flatness == pytest.approx(row[0], rel=1e-3)
        assert 1.0 / ellipse.semi_major_cm == pytest.approx(row[1], rel=1e-3)
        assert ratio / ellipse.semi_minor_cm == pytest.approx(row[2], rel=1e-3)


def test_points_inside_the_outline_are_put_back():
    truth = Rectangle(1.0, 2.0, 12.0, 6.0, 0.3)
    shrunk = Rectangle(1.0, 2.0, 11.0, 5.0, 0.3)
    got = rectangle_from_ellipse(fitted(shrunk), inside_cm=0.5)
    assert got.corrected_length_cm == pytest.approx(truth.length_cm, rel=2e-3)
    assert got.corrected_breadth_cm == pytest.approx(truth.breadth_cm, rel=2e-3)


def test_squares_are_declared_ambiguous():
    assert rectangle_from_ellipse(Ellipse(0, 0, 4.0, 3.9, 0.1)).ambiguous
    assert not rectangle_from_ellipse(Ellipse(0, 0, 8.0, 3.9, 0.1)).ambiguous


def test_the_quality_of_the_fit_is_passed_on():
    ellipse = fitted(Rectangle(0, 0, 8, 4, 0.0), 100)
    got = rectangle_from_ellipse(ellipse)
    assert got.rms_cm == ellipse.rms_cm > 0.0
    assert got.n_points == 100
    assert math.isfinite(got.corrected_length_cm)
