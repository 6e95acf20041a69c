"""Points turned about a footprint's centre: the axis comes to lie along x."""

import numpy as np
import pytest

from helpers_rectangles import points, rectangle_xy, turned
from tactile_graph.wires import Points, Rectangle
from tactile_graph_fitters.orientation.orientation import Orientation, orientation
from tactile_graph_fitters.orientation.rotate_points import rotate_points


def test_a_turned_rectangle_comes_to_lie_along_x_about_its_centre():
    truth = Rectangle(7.0, 4.0, 10.0, 4.0, 0.6)
    axis = Orientation(0.6, 7.0, 4.0, 0.6, 0.0, False)
    got = rotate_points(points(truth.outline_cm()), axis).xy_cm
    flat = Rectangle(7.0, 4.0, 10.0, 4.0, 0.0).outline_cm()
    np.testing.assert_allclose(got, flat, atol=1e-12)


def test_turning_by_the_axis_and_back_changes_nothing():
    xy = rectangle_xy(Rectangle(3, 5, 9, 2, -1.1), 50)
    axis = orientation(points(xy))
    there = rotate_points(points(xy), axis).xy_cm - (axis.x_cm, axis.y_cm)
    np.testing.assert_allclose(
        turned(there, axis.angle_rad) + np.array([axis.x_cm, axis.y_cm]), xy, atol=1e-12
    )


def test_no_points_stay_no_points():
    axis = Orientation(0.3, 1.0, 1.0, 0.5, 0.0, False)
    assert rotate_points(Points(np.empty((0, 2))), axis).count == 0


def test_distances_from_the_centre_are_kept():
    rng = np.random.default_rng(1)
    xy = rng.normal(0, 5, (20, 2))
    axis = Orientation(1.2, 2.0, -3.0, 0.5, 0.0, False)
    got = rotate_points(Points(xy), axis).xy_cm
    before, after = (np.hypot(*(p - (2.0, -3.0)).T) for p in (xy, got))
    assert after == pytest.approx(before)
