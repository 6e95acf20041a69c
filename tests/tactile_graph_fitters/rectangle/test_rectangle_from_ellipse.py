"""Sides read off an ellipse, as the thesis reports them and corrected."""

import math

import numpy as np
import pytest
from hypothesis import given, settings
from scipy.optimize import least_squares

from helpers_rectangles import points, rectangle_xy, seeds, some_rectangle
from tactile_graph.wires import Ellipse, Image, Rectangle
from tactile_graph_fitters.ellipse.fit_ellipse_origin import fit_ellipse_origin
from tactile_graph_fitters.orientation.orientation import Orientation
from tactile_graph_fitters.orientation.rotate_points import rotate_points
from tactile_graph_fitters.rectangle.rectangle_from_ellipse import (
    BIAS,
    EllipseRectangle,
    rectangle_from_ellipse,
)


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


@pytest.mark.slow  # much is fitted
@settings(max_examples=25, deadline=None)
@given(seed=seeds)
def test_corrected_sides_are_those_of_the_rectangle_the_ellipse_was_fitted_to(seed):
    truth = some_rectangle(np.random.default_rng(seed), (0.1, 1.0))
    got = rectangle_from_ellipse(fitted(truth))
    assert got.corrected_length_cm == pytest.approx(truth.length_cm, rel=2e-3)
    assert got.corrected_breadth_cm == pytest.approx(truth.breadth_cm, rel=2e-3)
    assert got.length_cm > 1.12 * truth.length_cm
    assert got.breadth_cm > 1.14 * truth.breadth_cm


def nearest_to_outline(ratio, n=5000):
    """Half axes of the ellipse nearest by the ray to the outline of half sides 1 and ``ratio``."""
    along = (np.arange(n) + 0.5) / n * (1.0 + ratio)
    x, y = np.minimum(along, 1.0), np.minimum(1.0 + ratio - along, ratio)
    far = np.hypot(x, y)
    off = least_squares(
        lambda p: far - 1.0 / np.hypot(x / far / p[0], y / far / p[1]),
        (1.1, 1.1 * ratio), xtol=1e-12, ftol=1e-12, gtol=1e-12,
    )  # fmt: skip
    return off.x


@pytest.mark.slow
def test_the_table_is_of_the_ellipses_nearest_to_rectangles():
    sides = (0.02, 0.05, 0.1, 0.15, 0.2, 0.25, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9, 1.0)
    found = [(b / a, 1.0 / a, side / b) for side in sides for a, b in [nearest_to_outline(side)]]
    assert np.array(found) == pytest.approx(BIAS, rel=2e-4)


def test_a_rectangle_made_by_hand_has_no_points_and_a_certain_angle():
    one = EllipseRectangle(1.0, 2.0, 5.0, 3.0, 0.2, 4.5, 2.5)
    assert (one.rms_cm, one.n_points, one.ambiguous) == (0.0, 0, False)


@pytest.mark.slow
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


def test_how_far_inside_can_be_told_in_pitches_of_the_elements():
    ellipse, elements = Ellipse(3.0, 4.0, 5.0, 2.0, 0.4), Image(np.zeros((2, 2)), (0.5, 0.5))
    by_cells = rectangle_from_ellipse(ellipse, elements, inside_cells=0.6)
    assert by_cells == rectangle_from_ellipse(ellipse, inside_cm=0.3, cell_cm=0.5)
    near = Ellipse(3.0, 4.0, 0.52, 0.42, 0.4)
    fine = Image(np.zeros((2, 2)), (0.01, 0.01))
    assert rectangle_from_ellipse(near).ambiguous
    assert not rectangle_from_ellipse(near, fine).ambiguous
