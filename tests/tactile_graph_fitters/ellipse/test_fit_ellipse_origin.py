"""The thesis' ellipse about a known centre: truth, the error of appendix D, the simplex."""

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.optimize import minimize

from helpers_rectangles import off_rad, points, rectangle_xy, seeds, some_ellipse, some_rectangle
from tactile_graph.errors import Degenerate
from tactile_graph.wires import Ellipse, Points, Rectangle
from tactile_graph_fitters.ellipse.fit_ellipse_origin import (
    fit_ellipse_origin,
    polar,
    radial_error,
    simplex_search,
)
from tactile_graph_fitters.orientation.orientation import Orientation
from tactile_graph_fitters.orientation.rotate_points import rotate_points


def at(x, y, angle=0.0):
    return Orientation(angle, x, y, 0.5, 0.0, False)


def error_of_appendix_d(x, y, a, b):
    """D.8 and D.9 as printed: the nearer of the two intersections."""
    total = 0.0
    for xi, yi in zip(x, y, strict=True):
        xs = math.sqrt(a * a * b * b / (b * b + a * a * (yi / xi) ** 2))
        ys = yi / xi * xs
        total += min((xs - xi) ** 2 + (ys - yi) ** 2, (xs + xi) ** 2 + (ys + yi) ** 2)
    return total


@pytest.mark.slow
@settings(max_examples=40, deadline=None)
@given(seed=seeds)
def test_truth_to_turned_points_to_truth(seed):
    truth = some_ellipse(np.random.default_rng(seed))
    axis = at(truth.x_cm, truth.y_cm, truth.angle_rad)
    got = fit_ellipse_origin(rotate_points(points(truth.outline_cm(40)), axis), axis)
    assert got.semi_major_cm == pytest.approx(truth.semi_major_cm, rel=1e-6)
    assert got.semi_minor_cm == pytest.approx(truth.semi_minor_cm, rel=1e-6)
    assert (got.x_cm, got.y_cm) == (truth.x_cm, truth.y_cm)
    assert off_rad(got.angle_rad, truth.angle_rad) < 1e-12
    assert got.rms_cm < 1e-6


@pytest.mark.parametrize("by", ["reference", "compiled"])
@settings(max_examples=30, deadline=None)
@given(seed=seeds, a=st.floats(0.5, 5.0), b=st.floats(0.5, 5.0))
def test_the_error_is_that_of_appendix_d(by, seed, a, b):
    x, y = np.random.default_rng(seed).uniform(0.5, 5.0, (2, 12)) * (1, -1)[seed % 2]
    r = np.hypot(x, y)
    polar = r, (x / r) ** 2, (y / r) ** 2
    wanted = error_of_appendix_d(x, y, a, b)
    kernel = getattr(radial_error, by)
    assert kernel(*polar, a, b, np.empty(12)) == pytest.approx(wanted, rel=1e-10)


@settings(max_examples=15, deadline=None)
@given(seed=seeds)
@pytest.mark.slow
def test_finds_the_minimum_scipy_finds(seed):
    rng = np.random.default_rng(seed)
    truth = some_rectangle(rng)
    flat = Rectangle(0.0, 0.0, truth.length_cm, truth.breadth_cm, 0.0)
    xy = rectangle_xy(flat, 60) + rng.normal(0, 0.2, (60, 2))
    r = np.hypot(*xy.T)
    polar = r, (xy[:, 0] / r) ** 2, (xy[:, 1] / r) ** 2
    got = fit_ellipse_origin(Points(xy.copy()), at(0.0, 0.0))
    peer = minimize(
        lambda p: radial_error.reference(*polar, p[0], p[1], np.empty(60)),
        [truth.length_cm / 2, truth.breadth_cm / 2],
        method="Nelder-Mead",
        options={"xatol": 1e-10, "fatol": 1e-12},
    )
    assert 60 * got.rms_cm**2 == pytest.approx(peer.fun, rel=1e-6)
    axes = sorted(np.abs(peer.x), reverse=True)
    assert (got.semi_major_cm, got.semi_minor_cm) == pytest.approx(axes, rel=1e-4)


@pytest.mark.parametrize("times", [(2.0, 2.0), (0.5, 0.5), (0.3, 2.0), (2.0, 0.3)])
def test_where_the_search_starts_makes_no_difference(times):
    for seed in range(5):
        x, y = np.random.default_rng(seed).normal(0.0, [[4.0], [1.5]], (2, 40))
        scale, a, b, points = polar(x, y)
        _, a, b, _, _ = settled = simplex_search(points, a, b, 1e-8, 2000)
        other = simplex_search(points, times[0] * a, times[1] * b, 1e-8, 2000)
        again = simplex_search(points, other[1], other[2], 1e-8, 2000)
        assert again[1:3] == pytest.approx(settled[1:3], rel=1e-5)
        assert scale > 0.0


def test_an_ellipse_longer_across_turns_its_angle_by_a_quarter():
    tall = Ellipse(0.0, 0.0, 5.0, 2.0, math.pi / 2)
    got = fit_ellipse_origin(points(tall.outline_cm(30)), at(0.0, 0.0, 0.2))
    assert got.semi_major_cm == pytest.approx(5.0)
    assert off_rad(got.angle_rad, 0.2 + math.pi / 2) < 1e-12


@pytest.mark.slow
@settings(max_examples=20, deadline=None)
@given(seed=seeds, power=st.floats(-9.0, 9.0))
def test_scaling_the_points_scales_the_ellipse(seed, power):
    rng = np.random.default_rng(seed)
    xy = some_ellipse(rng).outline_cm(25) + rng.normal(0, 0.1, (25, 2))
    xy -= xy.mean(axis=0)
    scale = 10.0**power
    small = fit_ellipse_origin(Points(xy.copy()), at(0.0, 0.0))
    large = fit_ellipse_origin(Points(xy * scale), at(0.0, 0.0))
    assert large.semi_major_cm / scale == pytest.approx(small.semi_major_cm, rel=1e-6)
    assert large.semi_minor_cm / scale == pytest.approx(small.semi_minor_cm, rel=1e-6)


@pytest.mark.parametrize(
    ("xy", "words"),
    [
        (np.empty((0, 2)), "0 points: an ellipse about a known centre needs at least 2"),
        ([[1.0, 2.0]], "1 point: an ellipse about a known centre needs at least 2"),
        ([[1, 2], [np.inf, 2]], "1 of 2 points not finite: no ellipse fits"),
        ([[1, 2], [2, 4], [-1, -2]], "3 points on one line through the centre"),
        ([[0, 0], [0, 0]], "2 points on one line through the centre"),
    ],
)
def test_says_why_there_is_no_ellipse(xy, words):
    with pytest.raises(Degenerate, match=words):
        fit_ellipse_origin(points(xy), at(0.0, 0.0))


def test_gives_up_in_words():
    xy = Ellipse(0, 0, 5, 2, 0).outline_cm(20)
    with pytest.raises(Degenerate, match="no ellipse found within 5 steps of the simplex"):
        fit_ellipse_origin(points(xy), at(0.0, 0.0), max_iterations=5)
