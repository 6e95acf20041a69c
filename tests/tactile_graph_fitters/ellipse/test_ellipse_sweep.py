"""The ellipse of least error over orientations tried in steps."""

import math

import numpy as np
import pytest
from hypothesis import given, settings

from helpers_rectangles import off_rad, points, rectangle_xy, seeds, some_ellipse
from tactile_graph.errors import Degenerate
from tactile_graph.wires import Points, Rectangle
from tactile_graph_fitters.ellipse.ellipse_sweep import ellipse_sweep, straight
from tactile_graph_fitters.ellipse.fit_ellipse_origin import Polar, origin_fit, polar
from tactile_graph_fitters.orientation.orientation import Orientation

pytestmark = pytest.mark.usefixtures("warm_kernels")


@pytest.mark.slow
@settings(max_examples=8, deadline=None)
@given(seed=seeds)
def test_truth_to_points_to_truth(seed):
    truth = some_ellipse(np.random.default_rng(seed), (0.3, 0.8))
    centre = Orientation(0.0, truth.x_cm, truth.y_cm, 0.5, 0.0, False)
    got = ellipse_sweep(points(truth.outline_cm(30)), centre)
    assert off_rad(got.angle_rad, truth.angle_rad) < 1e-3
    assert got.semi_major_cm == pytest.approx(truth.semi_major_cm, rel=1e-4)
    assert got.semi_minor_cm == pytest.approx(truth.semi_minor_cm, rel=1e-4)


@pytest.mark.slow
def test_straight_to_the_axes_that_the_simplex_finds():
    found = 0
    for seed in range(40):
        rng = np.random.default_rng(seed)
        xy = some_ellipse(rng).outline_cm(30) + rng.normal(0, 0.2, (30, 2))
        x, y = (xy - xy.mean(axis=0)).T
        scale, a, b, points = polar(x, y)
        a, b, error = straight.loops(points, a, b)
        _, first, second, rms, _ = origin_fit(x, y, 1e-8, 1000)
        if a > 0.0:
            assert (scale * a, scale * b) == pytest.approx((first, second), rel=1e-6)
            assert scale * math.sqrt(error / 30) == pytest.approx(rms, rel=1e-9)
            assert scale * math.sqrt(error / 30) <= rms * (1 + 1e-12)
            found += 1
    assert found > 30


def test_it_goes_straight_nowhere_from_far_away():
    r, t = np.ones(12), np.linspace(0, 2 * np.pi, 12)
    assert straight.loops(Polar(r, np.cos(t) ** 2, np.sin(t) ** 2), 30.0, 0.01) == (0.0, 0.0, 0.0)


def test_without_refining_the_angle_is_one_of_the_steps():
    truth = Rectangle(0.0, 0.0, 10.0, 4.0, math.radians(33))
    got = ellipse_sweep(points(rectangle_xy(truth, 60)), step_deg=10, refine=False)
    assert got.angle_deg == pytest.approx(30.0, abs=1e-6)
    assert got.iterations == 9


def test_the_centre_is_that_of_the_box_around_the_points_unless_given():
    truth = Rectangle(3.0, -2.0, 10.0, 4.0, 0.4)
    got = ellipse_sweep(points(rectangle_xy(truth, 60)), step_deg=15)
    assert (got.x_cm, got.y_cm) == pytest.approx((3.0, -2.0), abs=0.2)
    assert off_rad(got.angle_rad, 0.4) < 0.05


def test_the_angle_given_with_the_centre_does_not_matter():
    xy = rectangle_xy(Rectangle(3.0, -2.0, 10.0, 4.0, 0.4), 60)
    one, two = (
        ellipse_sweep(points(xy), Orientation(angle, 3.0, -2.0, 0.5, 0.0, False), step_deg=15)
        for angle in (0.0, 1.5)
    )
    assert one == two


@pytest.mark.parametrize(
    ("xy", "words"),
    [
        ([[0, 1], [1, 2]], "2 points: an ellipse to be swept needs at least 5"),
        ([[0, 1], [1, 2], [3, 3], [2, 5], [np.nan, 1]], "some of 5 points not finite"),
        ([[k, k] for k in range(-3, 4)], "7 points: at none of 18 orientations an ellipse fits"),
    ],
)
def test_says_why_there_is_no_ellipse(xy, words):
    with pytest.raises(Degenerate, match=words):
        ellipse_sweep(Points(np.array(xy, float)))


@pytest.mark.slow  # much is fitted
def test_points_that_say_nothing_of_an_axis_give_no_endless_ellipse():
    """A hull with a stray cell far from its centre has runaway minima at some orientations."""
    hull = np.array([[-3.0, -1.0], [3.0, -1.1], [3.0, 1.0], [-3.0, 1.1], [0.0, 9.0], [0.4, 9.0]])
    centre = Orientation(0.0, 0.0, 0.0, 0.5, 0.0, False)
    rng = np.random.default_rng(1)
    n_answers = 0
    for _ in range(60):
        xy = hull + rng.normal(0.0, 1.5, hull.shape)
        try:
            got = ellipse_sweep(Points(xy), centre)
        except Degenerate:
            continue
        n_answers += 1
        assert got.semi_major_cm <= 3.0 * np.hypot(*xy.T).max() * math.sqrt(2.0)
    assert n_answers > 20
