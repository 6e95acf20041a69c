"""Sketches: their coverage and its slopes, and how they come to their mode."""

import math

import numpy as np
import pytest

from helpers_joint import DISCS, problem_of_discs
from helpers_likelihood import NOISE
from tactile_graph_likelihood.several.joint.sketch import (
    cover,
    frame_of,
    log_posterior,
    settle_sketches,
    step_from,
)
from tactile_graph_likelihood.single.density.information import Information

pytestmark = pytest.mark.usefixtures("plain_kernels")

POINT = np.array([8.0, 9.0, math.log(3.0), math.log(2.0), 0.4, 4.5])


def covered(point, x_cm, y_cm, half=1.5):
    frame, rise = np.empty(8), np.zeros(5)
    frame_of.call(point, frame)
    return cover.call(frame, x_cm, y_cm, half, rise), rise


def test_a_sketch_covers_what_is_inside_half_of_its_edge_and_nothing_outside():
    assert covered(POINT, 8.0, 9.0)[0] == 1.0
    along = 8.0 + 3.0 * math.cos(0.4), 9.0 - 3.0 * math.sin(0.4)
    assert covered(POINT, *along)[0] == pytest.approx(0.5)
    assert covered(POINT, 14.0, 9.0)[0] == 0.0


@pytest.mark.parametrize("turn", [0.3, 1.2, 2.5, 4.0, 5.8])
def test_slopes_of_coverage_on_the_edge_are_those_of_its_differences(turn):
    s, t = math.cos(turn), math.sin(turn)
    u, v = 3.0 * math.copysign(abs(s) ** 0.5, s), 2.0 * math.copysign(abs(t) ** 0.5, t)
    cos, sin = math.cos(0.4), math.sin(0.4)
    place = 8.0 + u * cos - v * sin, 9.0 - u * sin - v * cos
    share, rise = covered(POINT, *place)
    assert share == pytest.approx(0.5)
    for k in range(5):
        step = np.zeros(6)
        step[k] = 1e-5
        far, near = covered(POINT + step, *place)[0], covered(POINT - step, *place)[0]
        assert rise[k] == pytest.approx((far - near) / 2e-5, abs=1e-4)


def test_the_log_posterior_rises_with_the_load_as_its_slope_says():
    problem, points = problem_of_discs(1), np.array([POINT, POINT])
    points[1] += np.array([4.0, 0.0, 0.0, 0.0, 0.0, 0.2])
    out = Information(np.empty(12), np.empty((12, 12)))
    here = log_posterior.call(problem, points, 1.5, out)
    slope, matrix = out.slope.copy(), out.matrix.copy()
    assert matrix == pytest.approx(matrix.T)
    assert np.linalg.eigvalsh(matrix).min() > -1e-6
    for k in range(2):
        step = points.copy()
        step[k, 5] += 1e-5
        rise = (log_posterior.call(problem, step, 1.5, out) - here) / 1e-5
        assert slope[6 * k + 5] == pytest.approx(rise, abs=0.01)


def lay(problem, point, half):
    """Add what a sketch brings to each element to what lies there, in place."""
    frame, rise = np.empty(8), np.empty(5)
    frame_of.call(point, frame)
    x0, y0, pitch, side = problem.grid[:4]
    for i, j in np.ndindex(problem.load.shape):
        x_cm, y_cm = (at + 0.5 * side + pitch * k for at, k in ((x0, j), (y0, i)))
        own = cover.call(frame, x_cm, y_cm, half, rise)
        problem.load[i, j] += np.exp(point[5]) * own
        problem.share[i, j] += own


def test_one_sketch_beside_another_adds_what_both_together_do():
    problem = problem_of_discs(2)
    points = np.array([[6.0, 6.0, 0.9, 0.9, 0.0, 4.5], [10.5, 6.0, 0.9, 0.9, 0.0, 4.5]])
    lain = problem._replace(load=problem.load.copy(), share=problem.share.copy())
    lay(lain, points[0], 0.65)
    one = Information(np.empty(6), np.empty((6, 6)))
    both = Information(np.empty(12), np.empty((12, 12)))
    parts = [log_posterior.call(problem, points[:1], 0.65, one)]
    parts.append(log_posterior.call(lain, points[1:], 0.65, one))
    assert log_posterior.call(problem, points, 0.65, both) == pytest.approx(sum(parts))


@pytest.mark.slow
def test_sketches_come_near_the_discs_that_lie_there():
    for seed in range(4):
        points = np.array([[7.0, 7.0, 0.6, 0.6, 0.0, 4.0], [10.4, 5.2, 0.6, 0.6, 0.0, 4.0]])
        problem = problem_of_discs(seed)
        first = settle_sketches.call(problem, points.copy(), 0, 1)
        last = settle_sketches.call(problem, points, 0, 3)
        assert math.isfinite(first)
        assert math.isfinite(last)
        assert np.hypot(*(points - DISCS)[:, :2].T).max() < 0.8


def test_no_step_leaves_what_is_possible():
    problem, trial = problem_of_discs(), np.empty((1, 6))
    step_from.call(problem, POINT[None], np.full(6, -1e3), trial)
    assert trial[0, 0] == pytest.approx(8.0 - 1.3)
    assert (trial[0, 2:4] >= 0.0).all()
    step_from.call(problem, np.array([[0.2, 20.4, 0.0, 2.4, 0.0, -9.0]]), np.zeros(6), trial)
    assert trial[0, 5] >= math.log(2.0 * NOISE.least) - 1e-9
