"""Ellipses by geometric and by direct least squares, and the nearest point they need."""

import math
from unittest import mock

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from helpers_rectangles import off_rad, points, seeds, some_ellipse, turned
from tactile_graph.errors import Degenerate
from tactile_graph.wires import Ellipse, Points
from tactile_graph_fitters.ellipse.fit_ellipse import equations, fit_ellipse, semi_major_std_cm
from tactile_graph_fitters.ellipse.fit_ellipse_direct import fit_ellipse_direct
from tactile_graph_fitters.ellipse.fitted_ellipse import FittedEllipse
from tactile_graph_fitters.ellipse.nearest_on_ellipse import distances, nearest

EIG = np.linalg.eig


def skimage_ellipse(xy):
    """Return scikit-image's model of points; its 0.26 needs an `eig` that gives real numbers where
    all are, as NumPy's did before 2.5."""
    from skimage.measure import EllipseModel

    with mock.patch.object(np.linalg, "eig", lambda a: map(np.real_if_close, EIG(a))):
        return EllipseModel.from_estimate(xy)


BOTH = [fit_ellipse, fit_ellipse_direct]


def four(e):
    return np.array([e.x_cm, e.y_cm, e.semi_major_cm, e.semi_minor_cm])


def noisy(seed, noise=0.05, n=40):
    rng = np.random.default_rng(seed)
    truth = some_ellipse(rng)
    return rng, truth, truth.outline_cm(n) + rng.normal(0, noise, (n, 2))


@pytest.mark.parametrize("fit", BOTH)
@settings(max_examples=30, deadline=None)
@given(seed=seeds)
def test_truth_to_points_to_truth(fit, seed):
    truth = some_ellipse(np.random.default_rng(seed))
    got = fit(points(truth.outline_cm(17)))
    assert four(got) == pytest.approx(four(truth), abs=1e-7)
    assert off_rad(got.angle_rad, truth.angle_rad) < 1e-7
    assert got.rms_cm < 1e-7


@pytest.mark.slow
@pytest.mark.parametrize("fit", BOTH)
@settings(max_examples=20, deadline=None)
@given(seed=seeds, angle=st.floats(-3, 3), dx=st.floats(-1e3, 1e3), power=st.floats(-6, 6))
def test_moving_turning_and_scaling_the_points_does_the_same_to_the_ellipse(
    fit, seed, angle, dx, power
):
    _, _, xy = noisy(seed)
    scale = 10.0**power
    here, there = fit(Points(xy.copy())), fit(Points(scale * (turned(xy, angle) + dx)))
    centre = turned(np.array([[here.x_cm, here.y_cm]]), angle)[0] + dx
    assert four(there) / scale == pytest.approx([*centre, *four(here)[2:]], abs=1e-6)
    assert off_rad(there.angle_rad, here.angle_rad + angle) < 1e-6


@pytest.mark.slow
@pytest.mark.parametrize("fit", BOTH)
@settings(max_examples=20, deadline=None)
@given(seed=seeds)
def test_order_of_the_points_does_not_matter(fit, seed):
    rng, _, xy = noisy(seed)
    one, two = fit(Points(xy.copy())), fit(Points(rng.permutation(xy)))
    assert four(two) == pytest.approx(four(one), abs=1e-7)


def test_the_direct_fit_is_scikit_images_on_the_same_points():
    """Both minimise the same; scikit-image's EllipseModel is Halíř and Flusser's too."""
    for seed in range(10):
        _, _, xy = noisy(seed, 1e-4)
        peer = skimage_ellipse(xy)
        got = fit_ellipse_direct(Points(xy.copy()))
        assert (got.x_cm, got.y_cm) == pytest.approx(tuple(peer.center), abs=2e-4)
        axes = sorted(peer.axis_lengths, reverse=True)
        assert (got.semi_major_cm, got.semi_minor_cm) == pytest.approx(axes, abs=2e-4)


@pytest.mark.slow
def test_the_geometric_fit_has_the_least_distances():
    for seed in range(10):
        _, _, xy = noisy(seed, 0.3)
        best, direct = fit_ellipse(Points(xy.copy())), fit_ellipse_direct(Points(xy.copy()))
        peer = skimage_ellipse(xy).residuals(xy)
        assert best.rms_cm <= direct.rms_cm
        assert best.rms_cm <= math.sqrt(np.mean(peer**2)) * (1 + 1e-9)
        for k in range(4):
            for step in (-1e-3, 1e-3):
                p = [best.x_cm, best.y_cm, best.semi_major_cm, best.semi_minor_cm]
                p[k] += step
                off = distances(np.ascontiguousarray(xy.T), *p, -best.angle_rad)
                assert math.sqrt(np.mean(off**2)) >= best.rms_cm


def test_an_arc_of_a_quarter_is_enough_for_the_geometric_fit():
    truth = Ellipse(2.0, 3.0, 6.0, 3.0, 0.5)
    xy = truth.outline_cm(160)[:60]
    got = fit_ellipse(Points(xy.copy()))
    assert four(got) == pytest.approx(four(truth), abs=1e-4)


@pytest.mark.parametrize("fit", BOTH)
def test_a_circle_is_an_ellipse(fit):
    got = fit(points(Ellipse(1.0, 2.0, 3.0, 3.0, 0.0).outline_cm(24)))
    assert four(got) == pytest.approx([1.0, 2.0, 3.0, 3.0], abs=1e-8)


@pytest.mark.parametrize("fit", BOTH)
@pytest.mark.parametrize(
    ("xy", "words"),
    [
        (np.empty((0, 2)), "0 points: an ellipse needs at least 5 distinct ones"),
        ([[0, 0], [1, 0], [1, 1], [0, 1]], "4 points: an ellipse needs at least 5"),
        ([[0, 0], [1, 0], [1, 1], [0, 1], [0, 1]], "5 points: an ellipse needs at least 5"),
        ([[k, 2 * k] for k in range(8)], "8 points: an ellipse .* not on one line"),
        ([[0, 0], [1, 0], [1, 1], [0, 1], [np.nan, 3]], "1 of 5 points not finite"),
    ],
)
def test_says_why_there_is_no_ellipse(fit, xy, words):
    with pytest.raises(Degenerate, match=words):
        fit(points(xy))


def test_points_on_a_parabola_give_no_endless_ellipse():
    t = np.linspace(-1, 1, 21)
    with pytest.raises(Degenerate, match="no ellipse is near them, but another conic"):
        fit_ellipse(Points(np.column_stack([t, t * t])))


@settings(max_examples=60, deadline=None)
@given(
    a=st.floats(0.1, 10.0),
    b=st.floats(0.1, 10.0),
    x=st.floats(-12.0, 12.0),
    y=st.floats(-12.0, 12.0),
)
def test_the_nearest_point_is_on_the_ellipse_and_none_is_nearer(a, b, x, y):
    fx, fy = nearest.loops(a, b, x, y)
    assert (fx / a) ** 2 + (fy / b) ** 2 == pytest.approx(1.0, abs=1e-9)
    t = np.linspace(0, 2 * np.pi, 4001)
    least = np.hypot(a * np.cos(t) - x, b * np.sin(t) - y).min()
    assert math.hypot(fx - x, fy - y) <= least + 1e-9 * (a + b + 12.0)


@pytest.mark.parametrize(("x", "y"), [(0.0, 0.0), (2.0, 0.0), (0.0, 5.0), (4.0, 0.0), (7.0, 0.0)])
def test_the_nearest_point_from_the_axes(x, y):
    fx, fy = nearest.loops(5.0, 2.0, x, y)
    t = np.linspace(0, 2 * np.pi, 100001)
    least = np.hypot(5 * np.cos(t) - x, 2 * np.sin(t) - y).min()
    assert math.hypot(fx - x, fy - y) == pytest.approx(least, abs=1e-6)


def test_the_slope_is_that_of_the_squared_distances():
    rng = np.random.default_rng(4)
    uv = Ellipse(0, 0, 1.0, 0.5, 0.2).outline_cm(30).T + rng.normal(0, 0.05, (2, 30))
    p = np.array([0.05, -0.02, 1.1, 0.55, -0.1])
    normal, slope, other = np.empty((5, 5)), np.empty(5), np.empty(5)
    equations.loops(uv, p, normal, slope)
    for k in range(5):
        step = np.zeros(5)
        step[k] = 1e-6
        high, low = (equations.loops(uv, p + s, normal, other) for s in (step, -step))
        assert slope[k] == pytest.approx((high - low) / 4e-6, abs=1e-6)


def arc(rng: np.random.Generator, span_rad: float, std_cm: float) -> Points:
    t = np.linspace(0.0, span_rad, 40)
    along, across = 5.0 * np.cos(t), 3.0 * np.sin(t)
    xy = np.column_stack([3.0 + along * 0.8 + across * 0.6, 4.0 - along * 0.6 + across * 0.8])
    return Points(xy + rng.normal(0.0, std_cm, xy.shape))


@pytest.mark.slow
def test_the_length_scatters_as_its_deviation_says() -> None:
    rng = np.random.default_rng(5)
    clouds = [arc(rng, 2 * math.pi, 0.05) for _ in range(60)]
    found = [fit_ellipse(p) for p in clouds]
    told = [semi_major_std_cm(f, p.xy_cm) for f, p in zip(found, clouds, strict=True)]
    assert np.std([f.semi_major_cm for f in found]) == pytest.approx(np.median(told), rel=0.3)


@pytest.mark.slow
def test_an_outline_whose_length_its_strays_leave_open_is_none() -> None:
    """A broken footprint of 15 x 5 cm: the nearest ellipses were up to 4 m long."""
    rng = np.random.default_rng(7)
    longest_cm, refused = 0.0, 0
    for _ in range(60):
        xy = rng.uniform((0.0, 0.0), (15.0, 5.0), (30, 2))
        try:
            longest_cm = max(longest_cm, 2.0 * fit_ellipse(Points(xy)).semi_major_cm)
        except Degenerate:
            refused += 1
    assert refused < 60
    assert longest_cm < 60.0


def test_a_short_arc_of_an_ellipse_is_one_where_its_points_are_sharp() -> None:
    found = fit_ellipse(arc(np.random.default_rng(1), 0.6, 0.0))
    assert found.semi_major_cm == pytest.approx(5.0, rel=1e-6)


def test_an_ellipse_made_by_hand_took_no_rounds():
    assert FittedEllipse(1.0, 2.0, 5.0, 3.0, 0.2, 0.1, 9).iterations == 0


def test_a_circle_has_no_angle_of_its_own():
    """The angle of axes that differ in their last bits is any."""
    turn = 2.0 * np.pi * np.arange(12) / 12 + 0.1
    for fit in (fit_ellipse, fit_ellipse_direct):
        found = fit(Points(np.column_stack([8.0 + 4.0 * np.cos(turn), 5.0 + 4.0 * np.sin(turn)])))
        assert found.semi_minor_cm == pytest.approx(found.semi_major_cm, rel=1e-9)
        assert found.angle_rad == 0.0
