"""The fits behind a shape decision against the steps that fit one shape each."""

import math

import numpy as np
import pytest

from helpers_rectangles import some_ellipse, some_rectangle
from tactile_graph.wires import Points, Polygon
from tactile_graph_fitters.circle.fit_circle import fit_circle
from tactile_graph_fitters.ellipse.fit_ellipse import fit_ellipse
from tactile_graph_fitters.rectangle.fit_rectangle import fit_rectangle
from tactile_graph_fitters.shape.shape_fits import (
    DISC,
    ELLIPSE,
    RECTANGLE,
    evenly,
    shape_fits,
    squared_from_sides,
)
from tactile_graph_fitters.shape.simplify_polygon import SimplifyPolygon
from tactile_graph_hull.hull import hull

KERNELS = ("reference", pytest.param("compiled", marks=pytest.mark.slow))
pytestmark = pytest.mark.usefixtures("plain_kernels")


def outlines():
    for seed in range(6):
        rng = np.random.default_rng(seed)
        shape = (some_ellipse, some_rectangle)[seed % 2](rng)
        xy = shape.outline_cm() if seed % 2 else shape.outline_cm(30)
        noisy = np.repeat(xy, 6, axis=0) + rng.normal(0.0, 0.3, (6 * len(xy), 2))
        yield hull(Points(noisy)).xy_cm


def off_sides(corners, xy):
    """Distances of points from the sides of a polygon."""
    sides = np.roll(corners, -1, axis=0) - corners
    off = xy[:, None, :] - corners[None]
    along = np.clip((off * sides).sum(axis=2) / (sides * sides).sum(axis=1), 0.0, 1.0)
    return np.linalg.norm(off - along[..., None] * sides, axis=2).min(axis=1)


@pytest.mark.parametrize("kernel", KERNELS)
def test_points_are_evenly_spread_along_every_side(kernel):
    square = np.array([[0.0, 0.0], [0.0, 4.0], [4.0, 4.0], [4.0, 0.0]])
    xy, length = getattr(evenly, kernel)(square, 1.0)
    assert length == 16.0
    assert xy[:5].tolist() == [[0.0, 0.5], [0.0, 1.5], [0.0, 2.5], [0.0, 3.5], [0.5, 4.0]]
    assert len(xy) == 16
    assert len(getattr(evenly, kernel)(square, 9.0)[0]) == 12
    assert len(getattr(evenly, kernel)(square, 8.0 / 3.0)[0]) == 12
    assert len(getattr(evenly, kernel)(0.1 * square, 0.8 / 3.0)[0]) == 12
    for corners in outlines():
        xy, length = getattr(evenly, kernel)(corners, 0.4)
        sides = np.roll(corners, -1, axis=0) - corners
        sizes = np.hypot(*sides.T)
        expected = [
            corner + (i + 0.5) / parts * side
            for corner, side, parts in zip(
                corners, sides, np.round(sizes / 0.4).astype(int), strict=True
            )
            for i in range(parts)
        ]
        assert length == pytest.approx(sizes.sum())
        far = np.linalg.norm(xy[:, None] - np.array(expected)[None], axis=2)
        assert far.min(axis=0).max() < 1e-9
        assert len(expected) <= len(xy) <= len(expected) + (sizes < 0.2).sum()
        turned = np.roll(corners[::-1], 2, axis=0)
        again = getattr(evenly, kernel)(turned, 0.4)[0]
        assert np.sort(again, axis=0) == pytest.approx(np.sort(xy, axis=0))


@pytest.mark.parametrize("kernel", KERNELS)
def test_finely_drawn_corners_bear_no_more_points_than_straight_sides(kernel):
    turn = np.linspace(0.0, 0.5 * math.pi, 80)
    corners = np.concatenate(
        [
            np.transpose([2.0 * x + np.cos(turn + at), 2.0 * y + np.sin(turn + at)])
            for at, x, y in zip(
                0.5 * math.pi * np.arange(4), (1, -1, -1, 1), (1, 1, -1, -1), strict=True
            )
        ]
    )
    xy, length = getattr(evenly, kernel)(corners, 0.65)
    assert len(xy) == pytest.approx(length / 0.65, abs=4)
    gaps = np.linalg.norm(xy - np.roll(xy, 1, axis=0), axis=1)
    assert gaps.min() > 0.5
    turned = getattr(evenly, kernel)(np.roll(corners[::-1], 7, axis=0), 0.65)[0]
    assert np.sort(turned, axis=0) == pytest.approx(np.sort(xy, axis=0))


@pytest.mark.parametrize("kernel", KERNELS)
def test_points_of_nothing_are_finite(kernel):
    xy, length = getattr(evenly, kernel)(np.zeros((3, 2)), 0.5)
    assert (length, xy.tolist()) == (0.0, [[0.0, 0.0]] * 3)


@pytest.mark.parametrize("kernel", KERNELS)
def test_distances_from_sides_are_measured_to_the_nearest_side(kernel):
    square = np.array([[0.0, 0.0], [2.0, 0.0], [2.0, 2.0], [0.0, 2.0]])
    for xy, squared in (([1.0, 0.5], 0.25), ([3.0, 3.0], 2.0), ([1.0, -2.0], 4.0)):
        found = getattr(squared_from_sides, kernel)(square, np.array([xy]))
        assert found == pytest.approx(squared)


@pytest.mark.slow
@pytest.mark.parametrize("kernel", KERNELS)
def test_every_shape_is_that_of_its_own_step(kernel):
    for corners in outlines():
        n, _, mean_squares, shapes, polygons = getattr(shape_fits, kernel)(corners, 0.65, 6, 1.3)
        xy = evenly(corners, 0.65)[0]
        assert n == len(xy)
        circle, ellipse = fit_circle(Points(xy)), fit_ellipse(Points(xy))
        rectangle = fit_rectangle(Points(xy), scale_cm=1.3)
        assert shapes[DISC, :3] == pytest.approx([circle.x_cm, circle.y_cm, circle.radius_cm])
        assert math.sqrt(mean_squares[DISC]) == pytest.approx(circle.rms_cm)
        assert math.sqrt(mean_squares[ELLIPSE]) == pytest.approx(ellipse.rms_cm, rel=1e-5)
        assert sorted(shapes[ELLIPSE, 2:4]) == pytest.approx(
            [ellipse.semi_minor_cm, ellipse.semi_major_cm], rel=1e-3
        )
        off = off_sides(rectangle.outline_cm(), xy)
        assert mean_squares[RECTANGLE] == pytest.approx((off * off).mean(), rel=1e-3)
        for count in range(3, 7):
            polygon = SimplifyPolygon(corners=count)(Polygon(corners)).xy_cm
            assert polygons[count, :count] == pytest.approx(polygon)
            assert mean_squares[count] == pytest.approx((off_sides(polygon, xy) ** 2).mean())


def test_a_hull_of_few_corners_has_no_polygon_of_more():
    triangle = Polygon(np.array([[0.0, 0.0], [4.0, 8.0], [10.0, 0.0]])).xy_cm
    mean_squares = shape_fits(triangle, 0.5, 6, 1.3)[2]
    assert mean_squares[3] == pytest.approx(0.0, abs=1e-20)
    assert np.isinf(mean_squares[4:]).all()
