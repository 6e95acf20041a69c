"""The thesis' iteration, where it settles and where not."""

import numpy as np
import pytest

import references_fitters as references
from helpers_circles import arc, arc_xy, three
from helpers_modes import compiled, plainly
from tactile_graph.errors import Degenerate
from tactile_graph.wires import Circle
from tactile_graph_fitters.circle.fit_circle import fit_circle
from tactile_graph_fitters.circle.fit_circle_thesis import fit_circle_thesis, iterated

DISC = Circle(10.0, 9.0, 4.0)


@pytest.mark.parametrize("degrees", [180, 270, 360])
def test_settles_on_the_geometric_fit(degrees):
    points = arc(DISC, degrees, 40, 0.2, np.random.default_rng(5))
    fit = fit_circle_thesis(points)
    assert three(fit) == pytest.approx(three(fit_circle(points)), abs=1e-4)
    assert fit.iterations > 10


def test_solves_equations_b8_to_b10():
    points = arc(DISC, 360, 40, 0.2, np.random.default_rng(6))
    fit = fit_circle_thesis(points, tolerance=1e-13)
    x, y = points.xy_cm.T
    d = np.hypot(x - fit.x_cm, y - fit.y_cm)
    n, r = len(d), fit.radius_cm
    b8 = n * fit.x_cm - x.sum() - fit.x_cm * r * (1 / d).sum() + r * (x / d).sum()
    b9 = n * fit.y_cm - y.sum() - fit.y_cm * r * (1 / d).sum() + r * (y / d).sum()
    assert [b8, b9, r - d.mean()] == pytest.approx([0.0, 0.0, 0.0], abs=1e-10)


def test_more_iterations_reach_shorter_arcs():
    points = arc(DISC, 90, 30)
    with pytest.raises(Degenerate, match="no circle found within 200 iterations"):
        fit_circle_thesis(points, max_iterations=200)
    fit = fit_circle_thesis(points, max_iterations=20_000)
    assert three(fit) == pytest.approx(three(DISC), abs=1e-3)


def test_point_at_the_centre_counts_for_the_radius_alone():
    uv = np.array([[1.0, 0.0, -1.0, 0.0, 0.0], [0.0, 1.0, 0.0, -1.0, 0.0]])
    assert iterated(uv, 50, 1e-9) == (True, 0.0, 0.0, pytest.approx(0.8), 1)


@pytest.mark.parametrize("by", [plainly, compiled])
def test_it_iterates_as_the_reference_does(by):
    uv = np.ascontiguousarray(arc_xy(DISC, 200, 21, 0.1, np.random.default_rng(1)).T)
    uv -= uv.mean(axis=1, keepdims=True)
    expected = pytest.approx(references.iterated(uv, 500, 1e-9), abs=1e-9)
    assert by(iterated)(uv, 500, 1e-9) == expected
