"""What the geometric fit steps by: its sums and their twin."""

import numpy as np
import pytest

import references_fitters as references
from helpers_circles import arc_xy
from helpers_modes import compiled, plainly
from tactile_graph.wires import Circle
from tactile_graph_fitters.circle.algebraic import HYPER, algebraic_circle
from tactile_graph_fitters.circle.geometric import refined, slopes, step_of
from tactile_graph_fitters.circle.principal_axes import OK, ONE_LINE, into_frame


@pytest.fixture
def uv():
    rng = np.random.default_rng(11)
    xy = arc_xy(Circle(0.0, 0.0, 1.0), 200, 23, 0.05, rng)
    return np.ascontiguousarray((xy - xy.mean(axis=0)).T)


@pytest.mark.parametrize("centre", [(0.1, -0.2), (0.0, 0.0), (0.3, 40.0)])
def test_gradient_and_second_derivatives_are_those_of_the_cost(uv, centre):
    """Against central differences of F and of its gradient."""
    a, b = centre
    h = 1e-5
    now = slopes.loops(uv, a, b)
    along = [slopes.loops(uv, a + s * h, b) for s in (1, -1)]
    across = [slopes.loops(uv, a, b + s * h) for s in (1, -1)]
    d_a = [(p - m) / (2 * h) for p, m in zip(*along, strict=True)]
    d_b = [(p - m) / (2 * h) for p, m in zip(*across, strict=True)]
    assert d_a[1] / 2 == pytest.approx(now[2], rel=1e-6, abs=1e-10)
    assert d_b[1] / 2 == pytest.approx(now[3], rel=1e-6, abs=1e-10)
    assert d_a[2] == pytest.approx(now[4] + now[7], rel=1e-6, abs=1e-9)
    assert d_a[3] == pytest.approx(now[5] + now[8], rel=1e-6, abs=1e-9)
    assert d_b[3] == pytest.approx(now[6] + now[9], rel=1e-6, abs=1e-9)


@pytest.mark.parametrize("by", [plainly, compiled])
@pytest.mark.parametrize("centre", [(0.1, -0.2), (0.0, 0.0), (30.0, 400.0)])
def test_slopes_are_those_of_the_reference(uv, centre, by):
    uv[:, 3] = 0.0  # with (0, 0) as the centre: a point without a direction
    expected = pytest.approx(references.slopes(uv, *centre), rel=1e-9, abs=1e-13)
    assert by(slopes)(uv, *centre) == expected


def test_step_goes_downhill_where_the_second_derivative_has_no_minimum():
    now = (1.0, 1.0, 0.3, -0.2, 0.5, 0.1, 0.4, -5.0, 0.0, -5.0)
    du, dv, promised, upward = step_of(now, 0.0)
    assert not upward
    assert promised > 0.0
    assert 0.3 * du - 0.2 * dv < 0.0


def test_damping_shortens_the_step():
    now = (1.0, 1.0, 0.3, -0.2, 0.5, 0.1, 0.4, 0.0, 0.0, 0.0)
    free, damped = step_of(now, 0.0), step_of(now, 1.0)
    assert np.hypot(*damped[:2]) < 0.7 * np.hypot(*free[:2])


@pytest.mark.parametrize("start", [(0.9, -0.5), (-0.7, 0.3), (0.0, -3.0)])
def test_bad_start_is_damped_to_the_same_minimum(uv, start):
    good, bad = refined(uv, 0.0, 0.0), refined(uv, *start)
    assert good[0] == bad[0] == 0
    assert bad[1:5] == pytest.approx(good[1:5], abs=1e-9)


@pytest.mark.slow
def test_no_start_finds_a_lower_minimum_where_the_rms_is_within_a_tenth_of_the_radius():
    rng = np.random.default_rng(4)
    within = 0
    for _ in range(150):
        degrees, noise = rng.uniform(60.0, 360.0), rng.choice([0.03, 0.1])
        xy = arc_xy(Circle(0.0, 0.0, 1.0), degrees, int(rng.integers(6, 40)), noise, rng)
        _, uv, _ = into_frame(xy)
        status, _, _, radius, rms, _ = refined(uv, *algebraic_circle(uv, HYPER)[:2])
        if status != OK or rms > 0.1 * radius:
            continue
        within += 1
        others = [refined(uv, *start) for start in rng.uniform(-2.0, 2.0, (8, 2))]
        assert all(other[4] >= rms * (1.0 - 1e-6) for other in others if other[0] == OK)
    assert within > 100


def test_saddle_between_two_equal_rows_is_left():
    """All points lie as much above the middle line as below: level there, but no minimum."""
    u = np.linspace(-1.0, 1.0, 8)
    uv = np.vstack([np.tile(u, 2), np.repeat([0.05, -0.05], 8)])
    assert abs(slopes(uv, 0.0, 0.0)[3]) < 1e-15
    assert not step_of(slopes(uv, 0.0, 0.0), 0.0)[3]
    assert refined(uv, 0.0, 0.0)[0] == ONE_LINE


def test_where_the_cost_is_flat_all_round_no_step_is_taken():
    """Nothing to divide by: no number may come of it."""
    assert step_of.loops((1.0, 0.5, 0.1, 0.1, *[0.0] * 6), 0.0) == (0.0, 0.0, 0.0, False)
