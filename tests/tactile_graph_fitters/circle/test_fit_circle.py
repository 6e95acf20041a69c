"""The geometric fit: truth to truth, against a general optimiser, on short and noisy arcs."""

import numpy as np
import pytest
from scipy.optimize import least_squares

from helpers_circles import arc, arc_xy, three
from tactile_graph.errors import Degenerate
from tactile_graph.wires import Circle, Points
from tactile_graph_fitters.circle.fit_circle import fit_circle
from tactile_graph_fitters.circle.fit_circle_kasa import fit_circle_kasa

HUNDRED = Circle(3.0, -7.0, 100.0)


@pytest.mark.parametrize("degrees", [1, 5, 15, 30, 60, 180, 360])
def test_exact_points_give_the_circle_back(degrees):
    fit = fit_circle(arc(HUNDRED, degrees, 20, start_deg=33.0))
    # Rounding of a coordinate is magnified by radius / sagitta, squared for the centre's depth.
    allowed = 100.0 * 1e-14 / np.radians(degrees / 2) ** 2
    assert three(fit) == pytest.approx(three(HUNDRED), abs=allowed)
    assert fit.rms_cm < 1e-12
    assert fit.n_points == 20


def test_three_points_have_their_circle():
    fit = fit_circle(Points(np.array([[0.0, 0.0], [2.0, 0.0], [0.0, 2.0]])))
    assert three(fit) == pytest.approx([1.0, 1.0, np.sqrt(2.0)], abs=1e-14)


def test_point_at_the_start_centre_does_no_harm():
    """A ring with one point in the middle: the distance there has no derivative."""
    ring = np.array([[1.0, 0.0], [0.0, 1.0], [-1.0, 0.0], [0.0, -1.0], [0.0, 0.0]])
    fit = fit_circle(Points(ring))
    assert np.isfinite(three(fit)).all()
    assert fit.rms_cm <= 0.4 + 1e-12  # that of the unit ring's best radius around (0, 0)


@pytest.mark.parametrize("degrees", [20, 45, 90, 200, 360])
def test_agrees_with_a_general_least_squares_optimiser(degrees, rng):
    for _ in range(10):
        xy = arc_xy(HUNDRED, degrees, 30, 1.0, rng)

        def off(p, xy=xy):
            return np.hypot(xy[:, 0] - p[0], xy[:, 1] - p[1]) - p[2]

        fit = fit_circle(Points(xy))
        tight = {"ftol": 1e-15, "xtol": 1e-15, "gtol": 1e-15}
        peer = least_squares(off, [3.0, -7.0, 100.0], method="lm", **tight)
        assert fit.rms_cm**2 * 30 <= (2.0 * peer.cost) * (1.0 + 1e-12)
        assert three(fit) == pytest.approx(peer.x, rel=1e-4)


@pytest.mark.slow
def test_median_radius_of_60_degree_arcs_is_right_where_kasas_is_not(rng):
    arcs = [arc(HUNDRED, 60, 50, 2.0, rng) for _ in range(300)]
    assert 99.0 < np.median([fit_circle(a).radius_cm for a in arcs]) < 101.5
    assert 79.0 < np.median([fit_circle_kasa(a).radius_cm for a in arcs]) < 85.0


def test_settles_on_every_noisy_arc_that_shows_its_curvature(rng):
    rounds = [fit_circle(arc(HUNDRED, d, 25, 1.0, rng)).iterations for d in range(60, 361, 5)]
    assert max(rounds) <= 12


def test_noisy_straight_points_are_called_a_line(rng):
    """No circle beats a line here, so the radius would run away to infinity."""
    x = np.repeat(np.linspace(0.0, 10.0, 21), 2)
    xy = np.column_stack([x, np.tile([0.01, -0.01], 21)])
    with pytest.raises(Degenerate, match="42 points nearly on one line: a straight line fits"):
        fit_circle(Points(xy))


def test_far_offset_costs_only_the_digits_it_must(rng):
    xy = arc_xy(Circle(0.0, 0.0, 3.0), 360, 40, 0.1, rng)
    near, far = fit_circle(Points(xy)), fit_circle(Points(xy + 1e8))
    assert three(far) - (1e8, 1e8, 0.0) == pytest.approx(three(near), abs=1e-7)


@pytest.fixture
def rng():
    return np.random.default_rng(20240)
