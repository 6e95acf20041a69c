"""Coverage of windows: exact, the same as the pad's own, and blurred as its foam blurs."""

import numpy as np
import pytest

import references_likelihood as references
from helpers_likelihood import GRID
from helpers_modes import compiled, plainly
from tactile_graph.wires import Circle, Ellipse, Polygon, Rectangle
from tactile_graph_likelihood.geometry.covered import covered, window
from tactile_graph_likelihood.geometry.disc_areas import disc_areas
from tactile_graph_likelihood.geometry.outlines import bounds, packed
from tactile_graph_likelihood.single.density.load_shares import blurred
from tactile_graph_pads.contact import spread
from tactile_graph_pads.coverage.coverage import coverage_cm2
from tactile_graph_pads.geometry import Geometry

SHAPES = [
    Circle(9.1, 8.7, 5.2),
    Circle(0.4, 19.9, 3.0),
    Ellipse(12.0, 7.0, 6.0, 2.2, 0.7),
    Rectangle(10.0, 9.0, 14.0, 3.0, -0.4),
    Rectangle(19.0, 2.0, 7.0, 5.0, 1.2),
    Polygon(np.array([[3.0, 3.0], [9.0, 2.5], [8.0, 9.0]])),
]
BOTH = (plainly, compiled)


@pytest.mark.parametrize("shape", SHAPES, ids=lambda s: type(s).__name__)
@pytest.mark.parametrize("by", [plainly, pytest.param(compiled, marks=pytest.mark.slow)])
def test_a_window_holds_all_that_an_outline_covers(shape, by):
    kind, corners, p = packed(shape)
    r0, c0, rows, columns = by(window)(kind, corners, p, GRID, 16, 16, 0.0)
    shares = np.zeros((16, 16))
    box = (r0, c0, rows, columns)
    shares[r0 : r0 + rows, c0 : c0 + columns] = by(covered)(kind, corners, p, GRID, box)
    np.testing.assert_allclose(shares, coverage_cm2(shape, Geometry()), atol=1e-11)
    assert 0 < rows * columns < 256


@pytest.mark.slow  # much is compiled
def test_an_outline_off_the_pad_has_no_window():
    kind, corners, p = packed(Circle(1e30, -5.0, 2.0))
    assert min(window.compiled(kind, corners, p, GRID, 16, 16, 0.0)[2:]) == 0


@pytest.mark.parametrize("by", BOTH)
@pytest.mark.parametrize("shape", SHAPES, ids=lambda s: type(s).__name__)
def test_bounds_are_those_of_the_drawn_outline(shape, by):
    kind, corners, p = packed(shape)
    xy = shape.outline_cm(4000) if not isinstance(shape, Polygon) else shape.xy_cm
    expected = (*xy.min(axis=0), *xy.max(axis=0))
    np.testing.assert_allclose(by(bounds)(kind, corners, p), expected, atol=1e-4)


@pytest.mark.slow
def test_a_disc_is_an_ellipse_at_half_the_cost():
    rng = np.random.default_rng(1)
    for _ in range(300):
        element = rng.choice([1.0, 1.3, 3.0])
        place = (*rng.uniform(-3, 24, 2), rng.uniform(0.01, 12))
        args = (*place, 1.3, element, 16, 16)
        expected = references.disc_areas(*args)
        for by in BOTH:
            np.testing.assert_allclose(by(disc_areas)(*args), expected, atol=1e-12)


@pytest.mark.parametrize("by", BOTH)
def test_foam_blurs_as_the_pads_does(by):
    shape, geometry = Circle(3.1, 8.7, 2.2), Geometry()
    share = coverage_cm2(shape, geometry)
    found = by(blurred)(share, 0.8 / 1.3, (0, 0, 16, 16), 16, 16)
    np.testing.assert_allclose(found, spread(share, geometry, 0.8), atol=2e-4)
    assert found.sum() == pytest.approx(share.sum(), rel=1e-3)
