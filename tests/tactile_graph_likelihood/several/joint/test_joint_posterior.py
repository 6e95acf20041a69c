"""The joint likelihood of outlines, its slopes and its evidence."""

import math

import numpy as np
import pytest

from helpers_likelihood import GRID, NOISE
from helpers_modes import compiled, plainly
from tactile_graph_likelihood.geometry.covered import covered
from tactile_graph_likelihood.geometry.outlines import DISC, RECTANGLE, REGULAR
from tactile_graph_likelihood.several.joint.joint_posterior import (
    JointProblem,
    Outlines,
    add_outline,
    gain,
    log_rest_of,
    overlap,
    slopes,
)
from tactile_graph_likelihood.several.joint.maximise_jointly import maximise_jointly
from tactile_graph_likelihood.several.posteriors import goodness_of_load
from tactile_graph_likelihood.single.density.element_terms import OFF, ON
from tactile_graph_likelihood.single.density.goodness_of_fit import goodness_of_fit
from tactile_graph_likelihood.single.density.information import Information
from tactile_graph_likelihood.single.density.log_posterior import log_likelihood
from tactile_graph_likelihood.single.density.problem import problem_of

pytestmark = pytest.mark.usefixtures("plain_kernels")

VECTOR = NOISE.vector(1.3)
PRIOR = np.array([0.0, 0.0, 20.5, 20.5, 1.0, 12.0, 1.0, 0.0, 0.0, 4.5, 1.5])
KINDS, CORNERS = np.array([DISC, RECTANGLE]), np.array([0, 0])
POINTS = np.array([[6.0, 6.0, 2.6, 4.5, 0.0, 0.0], [10.9, 7.2, 3.0, 2.1, 0.4, 5.0]])
BARE = np.zeros((16, 16))
BOTH = [
    plainly,
    pytest.param(compiled, marks=pytest.mark.slow),  # what is for several outlines takes 8 s
]


def table(points, *rows):
    at = list(rows or range(len(points)))
    return Outlines(KINDS[at], CORNERS[at], points[at])


def problem_of_joint(logs=BARE, states=None, load=BARE, share=BARE):
    states = np.zeros(BARE.shape, np.uint8) if states is None else states
    return JointProblem(GRID, logs, states, VECTOR, PRIOR, load, share)


def beside(*rows, outlines=None):
    found = problem_of_joint(load=BARE.copy(), share=BARE.copy())
    for k in rows:
        add_outline.call(found, outlines or table(POINTS), k)
    return found


def image(seed):
    load = beside(0, 1).load
    rng = np.random.default_rng(seed)
    load *= np.exp(0.48 * rng.standard_normal(load.shape)) * (rng.random(load.shape) > 0.16)
    on = load > 5.0
    return np.log(np.where(on, load, 1.0)), np.where(on, ON, OFF).astype(np.uint8)


def both(points, logs, states):
    return gain.call(problem_of_joint(logs, states), table(points))


def test_one_outline_adds_what_the_single_likelihood_says():
    logs, states = image(1)
    for k in (0, 1):
        alone = log_likelihood.call(
            problem_of(int(KINDS[k]), 0, GRID, logs, states, VECTOR, PRIOR), POINTS[k]
        )
        own = gain.call(problem_of_joint(logs, states), table(POINTS, k))
        assert own == pytest.approx(alone, abs=1e-9)


def test_two_outlines_add_what_one_and_then_the_other_beside_it_do():
    logs, states = image(2)
    first = beside(0)
    assert first.share == pytest.approx(covered.call(DISC, 0, POINTS[0], GRID, (0, 0, 16, 16)))
    assert first.load == pytest.approx(math.exp(4.5) * first.share)
    one = gain.call(problem_of_joint(logs, states), table(POINTS, 0))
    two = gain.call(problem_of_joint(logs, states, first.load, first.share), table(POINTS, 1))
    assert both(POINTS, logs, states) == pytest.approx(one + two, abs=1e-9)


@pytest.mark.slow
def test_the_compiled_kernel_gives_the_same():
    logs, states = image(3)
    got = gain.compiled(problem_of_joint(logs, states), table(POINTS))
    assert both(POINTS, logs, states) == pytest.approx(got, abs=1e-8)


def test_slopes_give_the_gain_beside_others_and_where_outlines_overlap():
    logs, states = image(6)
    moved = POINTS.copy()
    moved[0, :2] = POINTS[1, :2] + 0.3
    there = beside(0, outlines=table(moved))
    first = problem_of_joint(logs, states, there.load, there.share)
    out = Information(np.empty(6), np.empty((6, 6)))
    got = slopes.call(first, table(moved, 1), out)
    assert got == pytest.approx(gain.call(first, table(moved, 1)), abs=1e-8)


def test_overlap_costs_and_touching_does_not():
    share = np.ones((3, 3))
    assert overlap.call(share) == 0.0
    share[1, 1] = 1.3
    assert overlap.call(share) == pytest.approx(0.5 * 9.0)
    logs, states = image(4)
    moved = POINTS.copy()
    moved[0, :2] = POINTS[1, :2]
    assert both(moved, logs, states) < both(POINTS, logs, states) - 100.0


def test_slopes_are_those_of_the_gain():
    logs, states = image(5)
    out = Information(np.empty(12), np.empty((12, 12)))
    got = slopes.call(problem_of_joint(logs, states), table(POINTS), out)
    slope, matrix = out
    assert got == pytest.approx(both(POINTS, logs, states), abs=1e-9)
    assert matrix == pytest.approx(matrix.T)
    assert np.linalg.eigvalsh(matrix).min() > -1e-6
    for k, at in ((0, 3), (1, 5)):  # the loads: smooth
        step = POINTS.copy()
        step[k, at] += 1e-4
        rise = (both(step, logs, states) - both(POINTS, logs, states)) / 1e-4
        assert slope[6 * k + at] == pytest.approx(rise, rel=0.01, abs=0.02)
    assert slope[4] == slope[5] == 0.0
    assert matrix[4, 4] == matrix[5, 5] == 1.0


@pytest.mark.slow
@pytest.mark.parametrize("by", BOTH)
def test_maximising_gains_and_comes_near_the_truth(by):
    off = []
    for seed in range(12):
        logs, states = image(seed)
        points = POINTS + np.array([0.4, -0.3, 0.0, 0.0, 0.0, 0.0])
        problem, outlines = problem_of_joint(logs, states), table(points)
        before = both(points, logs, states) + log_rest_of.call(problem, outlines)
        out = Information(np.empty(12), np.empty((12, 12)))
        top = by(maximise_jointly)(problem, outlines, 25, 0.1, out)
        points, there = outlines.points, Information(np.empty(12), np.empty((12, 12)))
        slopes.call(problem, outlines, there)
        assert out.matrix == pytest.approx(there.matrix)
        assert top > before
        assert top == pytest.approx(
            both(points, logs, states) + log_rest_of.call(problem, outlines)
        )
        off.append(np.hypot(*(points - POINTS)[:, :2].T))
    assert np.median(off) < 0.48  # it ends at the nearest top; 0.5 where it began


def test_no_prior_where_an_outline_is_too_small_or_too_light():
    def rest(kind, corners, p):
        outline = Outlines(np.array([kind]), np.array([corners]), p[None])
        return log_rest_of.call(problem_of_joint(), outline)

    good = np.array([8.0, 8.0, 2.1, 0.1, 4.5, 0.0])
    assert math.isfinite(rest(REGULAR, 3, good))
    assert rest(REGULAR, 3, good - [0, 0, 0.2, 0, 0, 0]) == -math.inf  # sides 0.95 cm off
    assert rest(REGULAR, 3, good - [0, 0, 0, 0, 3.0, 0]) == -math.inf  # shows not even once


def test_the_surprise_of_one_outline_is_the_single_fits():
    logs, states = image(6)
    problem = problem_of(RECTANGLE, 0, GRID, logs, states, VECTOR, PRIOR)
    alone = goodness_of_fit.call(problem, POINTS[1])
    seen = problem_of_joint(logs, states, beside(1).load)
    found, _ = goodness_of_load.call(seen, 6)
    assert found == pytest.approx(alone.surprise)
