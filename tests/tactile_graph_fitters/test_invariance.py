"""Moving, turning, scaling or shuffling the points does the same to the circle."""

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from helpers_circles import ALL_FITS, arc_xy, three
from tactile_graph.wires import Circle, Points

seeds = st.integers(0, 2**32 - 1)


def scene(seed):
    rng = np.random.default_rng(seed)
    degrees = rng.uniform(150.0, 360.0)  # where the thesis' iteration settles as well
    circle = Circle(*rng.uniform(-5, 5, 2), rng.uniform(1, 9))
    return rng, arc_xy(circle, degrees, int(rng.integers(8, 40)), 0.02 * circle.radius_cm, rng)


def allowed(fit):
    """The thesis' iteration stops at 1e-8 of the radius a round, the others at rounding."""
    return 1e-5 if fit.__name__ == "fit_circle_thesis" else 1e-10


@pytest.mark.slow
@pytest.mark.parametrize("fit", ALL_FITS)
@settings(max_examples=40, deadline=None)
@given(seed=seeds, dx=st.floats(-1e3, 1e3), dy=st.floats(-1e3, 1e3))
def test_moved_points_move_the_circle(fit, seed, dx, dy):
    _, xy = scene(seed)
    shift = np.array([dx, dy, 0.0])
    moved = three(fit(Points(xy + shift[:2]))) - shift
    assert moved == pytest.approx(three(fit(Points(xy))), abs=10 * allowed(fit))


@pytest.mark.slow
@pytest.mark.parametrize("fit", ALL_FITS)
@settings(max_examples=40, deadline=None)
@given(seed=seeds, angle=st.floats(0.0, 2.0 * math.pi))
def test_turned_points_turn_the_circle(fit, seed, angle):
    _, xy = scene(seed)
    cos, sin = math.cos(angle), math.sin(angle)
    turn = np.array([[cos, sin], [-sin, cos]])
    x, y, radius = three(fit(Points(xy)))
    expected = [*(np.array([x, y]) @ turn), radius]
    assert three(fit(Points(xy @ turn))) == pytest.approx(expected, abs=10 * allowed(fit))


@pytest.mark.slow
@pytest.mark.parametrize("fit", ALL_FITS)
@settings(max_examples=40, deadline=None)
@given(seed=seeds, power=st.floats(-9.0, 9.0))
def test_scaled_points_scale_the_circle(fit, seed, power):
    _, xy = scene(seed)
    scale = 10.0**power
    scaled = three(fit(Points(xy * scale))) / scale
    assert scaled == pytest.approx(three(fit(Points(xy))), abs=10 * allowed(fit))


@pytest.mark.slow
@pytest.mark.parametrize("fit", ALL_FITS)
@settings(max_examples=40, deadline=None)
@given(seed=seeds)
def test_order_of_the_points_does_not_matter(fit, seed):
    rng, xy = scene(seed)
    shuffled = three(fit(Points(rng.permutation(xy))))
    assert shuffled == pytest.approx(three(fit(Points(xy))), abs=allowed(fit))


@pytest.mark.parametrize("fit", ALL_FITS)
def test_truth_to_points_to_truth(fit):
    truth = Circle(10.4, 9.75, 4.5)
    got = fit(Points(arc_xy(truth, 360, 32)))
    assert three(got) == pytest.approx(three(truth), abs=100 * allowed(fit))
