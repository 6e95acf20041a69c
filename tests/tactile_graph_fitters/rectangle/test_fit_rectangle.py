"""The rectangle nearest to points: truth, equivariance, outliers, words for nothing."""

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.optimize import least_squares

from helpers_rectangles import off_rad, points, rectangle_xy, seeds, some_rectangle, turned
from tactile_graph.errors import Degenerate
from tactile_graph.wires import Points, Rectangle
from tactile_graph_fitters.rectangle.fit_rectangle import equations, fit_rectangle

pytestmark = pytest.mark.usefixtures("warm_kernels")

ALONG = np.linspace(-4.0, 4.0, 12)
LONG = np.array([(u, v) for v in (2.0, -2.0) for u in ALONG])
SHORT = np.array([(-4.0, v) for v in (-1.5, -0.5, 0.5, 1.5)])


def five(r):
    return np.array([r.x_cm, r.y_cm, r.length_cm, r.breadth_cm])


def noisy(seed, noise=0.03, n=60):
    rng = np.random.default_rng(seed)
    truth = some_rectangle(rng, (0.3, 0.8))
    return rng, truth, rectangle_xy(truth, n) + rng.normal(0, noise, (n, 2))


@pytest.mark.slow  # takes seconds
@settings(max_examples=40, deadline=None)
@given(seed=seeds)
def test_truth_to_points_to_truth(seed):
    truth = some_rectangle(np.random.default_rng(seed), (0.1, 0.95))
    got = fit_rectangle(points(rectangle_xy(truth, 60)))
    assert five(got) == pytest.approx(five(truth), abs=1e-8)
    assert off_rad(got.angle_rad, truth.angle_rad) < 1e-8
    assert got.misfit < 1e-8


@pytest.mark.slow
@settings(max_examples=25, deadline=None)
@given(seed=seeds, dx=st.floats(-1e3, 1e3), dy=st.floats(-1e3, 1e3))
def test_moved_points_move_the_rectangle(seed, dx, dy):
    _, _, xy = noisy(seed)
    here, there = fit_rectangle(Points(xy.copy())), fit_rectangle(Points(xy + np.array([dx, dy])))
    assert five(there) - (dx, dy, 0, 0) == pytest.approx(five(here), abs=1e-3)
    assert off_rad(there.angle_rad, here.angle_rad) < 1e-3


@pytest.mark.slow
@settings(max_examples=25, deadline=None)
@given(seed=seeds, angle=st.floats(-3.0, 3.0))
def test_turned_points_turn_the_rectangle(seed, angle):
    _, _, xy = noisy(seed)
    here, there = fit_rectangle(Points(xy.copy())), fit_rectangle(Points(turned(xy, angle)))
    centre = turned(np.array([[here.x_cm, here.y_cm]]), angle)[0]
    assert five(there) == pytest.approx([*centre, *five(here)[2:]], abs=1e-3)
    assert off_rad(there.angle_rad, here.angle_rad + angle) < 1e-3


@pytest.mark.slow
@settings(max_examples=25, deadline=None)
@given(seed=seeds, power=st.floats(-6.0, 6.0))
def test_scaled_points_with_a_scaled_threshold_scale_the_rectangle(seed, power):
    _, _, xy = noisy(seed)
    scale = 10.0**power
    here = fit_rectangle(Points(xy.copy()), scale_cm=0.5)
    there = fit_rectangle(Points(scale * xy), scale_cm=0.5 * scale)
    assert five(there) / scale == pytest.approx(five(here), abs=1e-3)


@pytest.mark.slow
@settings(max_examples=25, deadline=None)
@given(seed=seeds)
def test_order_of_the_points_does_not_matter(seed):
    rng, _, xy = noisy(seed)
    one, two = fit_rectangle(Points(xy.copy())), fit_rectangle(Points(rng.permutation(xy)))
    assert five(two) == pytest.approx(five(one), abs=1e-3)


def test_reaches_the_cost_scipy_reaches():
    for seed in range(8):
        _, truth, xy = noisy(seed, 0.1)
        got = fit_rectangle(Points(xy.copy()), scale_cm=0.2)

        def off(p, xy=xy):
            flat = turned(xy - p[:2], -p[4])
            over = np.abs(flat) - p[2:4]
            outside = np.hypot(*np.maximum(over, 0.0).T)
            return np.where((over > 0).all(axis=1), outside, over.max(axis=1))

        start = [truth.x_cm, truth.y_cm, truth.length_cm / 2, truth.breadth_cm / 2, truth.angle_rad]
        peer = least_squares(off, start, loss="soft_l1", f_scale=0.2)
        assert len(xy) * got.misfit**2 <= 2.0 * peer.cost * (1 + 1e-3)


def test_a_few_points_far_off_hardly_move_it():
    truth = Rectangle(4.0, 5.0, 10.0, 4.0, 0.5)
    xy = np.vstack([rectangle_xy(truth, 80), [[14.0, 14.0], [-4.0, 9.0]]])
    got = fit_rectangle(Points(xy), scale_cm=0.1)
    assert five(got) == pytest.approx(five(truth), abs=0.1)
    assert off_rad(got.angle_rad, truth.angle_rad) < 0.01


def test_points_inside_the_outline_are_put_back():
    xy = rectangle_xy(Rectangle(0, 0, 9, 4, 0.2), 60)
    got = fit_rectangle(points(xy), inside_cm=0.5)
    assert (got.length_cm, got.breadth_cm) == pytest.approx((10.0, 5.0))


def test_squares_are_declared_ambiguous():
    xy = rectangle_xy(Rectangle(0, 0, 6, 6, 0.2), 60)
    got = fit_rectangle(points(xy))
    assert got.ambiguous
    assert got.length_cm == pytest.approx(6.0)
    assert not fit_rectangle(points(rectangle_xy(Rectangle(0, 0, 12, 6, 0.2), 60))).ambiguous


@pytest.mark.parametrize("turn", [0.0, 0.4])
@pytest.mark.parametrize(
    ("xy", "breadth"),
    [(LONG, 4.0), (np.vstack([LONG, SHORT]), 4.0), (np.vstack([LONG[:12], SHORT]), 3.5)],
)
def test_a_side_without_points_ends_with_the_others(xy, breadth, turn):
    got = fit_rectangle(points(turned(xy, turn)))
    assert (got.length_cm, got.breadth_cm) == pytest.approx((8.0, breadth))


@pytest.mark.parametrize("seed", [45, 147, 198])
def test_a_side_without_points_lies_as_far_out_in_a_mirror(seed):
    """Of the same cost everywhere, it was left where the search happened to end."""
    xy = np.random.default_rng(seed).integers(0, 16, (12, 2)).astype(float)
    here = fit_rectangle(points(xy))
    for there in (fit_rectangle(points(xy * [-1.0, 1.0])), fit_rectangle(points(xy[:, ::-1]))):
        assert five(there)[2:] == pytest.approx(five(here)[2:], abs=1e-3)


@pytest.mark.parametrize(
    ("xy", "words"),
    [
        (np.empty((0, 2)), "0 points: a rectangle needs at least 5"),
        (np.eye(4)[:, :2], "4 points: a rectangle needs at least 5"),
        ([[k, 2 * k] for k in range(9)], "9 points: a rectangle needs at least 5 .* one line"),
        ([[0, 0], [1, 0], [1, 1], [0, 1], [np.nan, 0]], "1 of 5 points not finite"),
        (1e200 * np.random.default_rng(0).random((9, 2)), "9 points too large or too small"),
    ],
)
def test_says_why_there_is_no_rectangle(xy, words):
    with pytest.raises(Degenerate, match=words):
        fit_rectangle(points(xy))


@pytest.mark.slow  # much is compiled
@settings(max_examples=20, deadline=None)
@given(seed=seeds)
def test_twins_agree(seed):
    rng = np.random.default_rng(seed)
    uv = rng.normal(0, 1, (2, 20))
    p = np.array([0.1, -0.2, 0.9, 0.5, 0.3])
    found = []
    for kernel in (equations.reference, equations.compiled):
        normal, slope = np.empty((5, 5)), np.empty(5)
        found.append((kernel(uv, p, 0.3, normal, slope), normal, slope))
    for one, two in zip(*found, strict=True):
        np.testing.assert_allclose(one, two, rtol=1e-10, atol=1e-12)


def test_the_slope_is_that_of_the_cost():
    rng = np.random.default_rng(4)
    uv, p = rng.normal(0, 1, (2, 30)), np.array([0.1, -0.2, 0.9, 0.5, 0.3])
    normal, slope = np.empty((5, 5)), np.empty(5)
    equations.reference(uv, p, 0.3, normal, slope)
    other = np.empty(5)
    for k in range(5):
        step = np.zeros(5)
        step[k] = 1e-6
        high, low = (equations.reference(uv, p + s, 0.3, normal, other)[0] for s in (step, -step))
        assert slope[k] == pytest.approx((high - low) / 4e-6, abs=1e-4)
    assert math.isfinite(slope.sum())
