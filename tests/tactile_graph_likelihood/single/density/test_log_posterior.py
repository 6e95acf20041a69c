"""The log likelihood of outlines: twins agree, windows are enough, slopes are right."""

import math

import numpy as np
import pytest

from helpers_likelihood import NOISE, drawn, problem_and_point
from helpers_modes import plainly
from tactile_graph.wires import Circle, Ellipse, Polygon, Rectangle
from tactile_graph_likelihood.geometry.covered import covered
from tactile_graph_likelihood.geometry.outlines import packed
from tactile_graph_likelihood.single.density.element_terms import OFF, ON, OVER, UNDER, UNKNOWN
from tactile_graph_likelihood.single.density.information import Information, information
from tactile_graph_likelihood.single.density.log_posterior import log_likelihood
from tactile_graph_likelihood.single.density.problem import problem_of
from tactile_graph_likelihood.single.noise import Noise
from tactile_graph_likelihood.single.readings import readings_of

SHAPES = [
    Circle(9.1, 8.7, 5.2),
    Ellipse(12.0, 7.0, 6.0, 2.2, 0.7),
    Rectangle(10.0, 9.0, 14.0, 3.0, -0.4),
    Polygon(np.array([[3.0, 3.0], [13.0, 2.5], [9.0, 11.0]])),
]


@pytest.mark.slow
@pytest.mark.parametrize("shape", SHAPES, ids=lambda s: type(s).__name__)
def test_twins_agree(shape):
    problem, p = problem_and_point(shape, 60.0, np.random.default_rng(2))
    expected = plainly(log_likelihood)(problem, p)
    assert log_likelihood.compiled(problem, p) == pytest.approx(expected, rel=1e-10)


@pytest.mark.slow
@pytest.mark.parametrize("shape", SHAPES, ids=lambda s: type(s).__name__)
@pytest.mark.parametrize(
    "estimated", [(), ("sigma", "voids"), ("foam",), ("fall", "lean"), ("contrast", "sigma")]
)
def test_slopes_are_those_of_the_likelihood(shape, estimated):
    noise = Noise(0.48, 0.16, 1e-9, 5.0, 0.6 if "foam" in estimated else 0.0, estimated)
    problem, p = problem_and_point(shape, 60.0, np.random.default_rng(2), noise)
    # slivers pull no harder than a tenth of an element: left out here
    share = covered.reference(problem.kind, problem.corners, p, problem.grid, (0, 0, 16, 16))
    if "foam" not in estimated:
        problem.states[share < (0.3 if "fall" in estimated else 0.15)] = UNKNOWN
    if "contrast" in estimated:
        untouched, ceiling = problem.states == OFF, 4.5
        problem.logs[untouched] = np.random.default_rng(3).normal(1.6, 0.3, int(untouched.sum()))
        problem.states[untouched & (problem.states != UNKNOWN)] = UNDER
        high = (problem.states == ON) & (problem.logs > ceiling)
        problem.states[high], problem.logs[high] = OVER, ceiling
    p = np.append(p, noise.as_taken(1.3).guess[:, 0])
    n = len(p)
    slope, matrix = out = Information(np.empty(n), np.empty((n, n)))
    information.compiled(problem, p, out)
    for k in range(n):
        up, down = p.copy(), p.copy()
        up[k] += 1e-4
        down[k] -= 1e-4
        rise = log_likelihood.compiled(problem, up)
        rise -= log_likelihood.compiled(problem, down)
        scale = math.sqrt(matrix[k, k])
        # coverage is differenced over a finite step: right to a part of its own spread
        assert slope[k] / scale == pytest.approx(
            rise / 2e-4 / scale, abs=0.5 if "foam" in estimated else 0.15
        )
    assert np.linalg.eigvalsh(matrix).min() > 0.0


@pytest.mark.slow
def test_information_is_the_same_plain_and_compiled():
    problem, p = problem_and_point(SHAPES[2], 60.0, np.random.default_rng(2))
    found = []
    for which in (plainly(information), information.compiled):
        out = Information(np.empty(6), np.empty((6, 6)))
        which(problem, p, out)
        found.append(np.vstack(out))
    np.testing.assert_allclose(*found, rtol=1e-6, atol=1e-6)


@pytest.mark.slow  # much is compiled
def test_the_truth_is_likelier_than_what_is_half_a_centimetre_off():
    rng = np.random.default_rng(4)
    ahead = 0
    for _ in range(10):
        readings = readings_of(drawn(SHAPES[0], 60.0, rng), 0.3, 5.0)
        kind, corners, p = packed(SHAPES[0])
        points = np.append(p, math.log(60.0)) + np.array(
            [[0, 0, 0, 0], [0.5, 0, 0, 0], [0, -0.5, 0, 0], [0, 0, 0.5, 0], [0, 0, -0.5, 0]]
        )
        problem = problem_of(kind, corners, *readings[:3], NOISE.vector(1.3), np.zeros(9))
        found = np.array([log_likelihood.compiled(problem, one) for one in points])
        ahead += found.argmax() == 0
    assert ahead >= 8
