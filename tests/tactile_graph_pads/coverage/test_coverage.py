"""Coverage is exact, whatever the shape and wherever it lies."""

import math

import numpy as np
import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st

from helpers_coverage import ellipse_on_rectangle, on_grid, polygon_area, polygon_on_rectangle
from tactile_graph.wires import Circle, Ellipse, Polygon, Rectangle
from tactile_graph_pads.coverage.coverage import coverage_cm2
from tactile_graph_pads.coverage.ellipse import ellipse_areas
from tactile_graph_pads.coverage.polygon import polygon_areas
from tactile_graph_pads.geometry import Geometry

PAD = Geometry()
GRID = (1.3, 1.0, 16, 16)
WHOLE = Geometry(24, 24, 1.0, 0.0)
# the check's own formula loses a corner that is 1e-50 from the centre
place = st.floats(-3.0, 24.0).map(lambda v: v if abs(v) > 1e-9 else 0.0)
angle = st.floats(-4.0, 4.0)
half_axis = st.floats(0.01, 12.0)


@st.composite
def convex_polygons(draw):
    n = draw(st.integers(3, 12))
    turns = sorted(draw(st.lists(st.floats(0, 6.28), min_size=n, max_size=n, unique=True)))
    x, y, radius = draw(place), draw(place), draw(st.floats(0.1, 9.0))
    return np.array([[x + radius * math.cos(t), y + radius * math.sin(t)] for t in turns])


@pytest.fixture(params=["reference", "compiled"])
def ellipse(request):
    return getattr(ellipse_areas, request.param)


@pytest.fixture(params=["reference", "compiled"])
def polygon(request):
    return getattr(polygon_areas, request.param)


@pytest.mark.slow  # much is compiled
@example(0.0, 0.0, 3.0, 5.5, 0.0)  # touches an element's edge
@given(place, place, half_axis, half_axis, angle)
@settings(max_examples=40, deadline=None)
def test_an_ellipse_covers_what_triangles_and_sectors_add_up_to(x, y, a, b, angle_rad):
    # The sum can lose a sliver where an outline just passes an edge (see the test of slivers).
    expected = on_grid(lambda *cell: ellipse_on_rectangle(x, y, a, b, angle_rad, *cell))
    for areas in (ellipse_areas.reference, ellipse_areas.compiled):
        got = areas(x, y, a, b, angle_rad, *GRID)
        np.testing.assert_allclose(got, expected, rtol=0, atol=1e-9)


@pytest.mark.slow
@given(convex_polygons())
@settings(max_examples=40, deadline=None)
def test_a_convex_polygon_covers_what_cutting_it_leaves(corners):
    expected = on_grid(lambda *cell: polygon_on_rectangle(corners, *cell))
    for areas in (polygon_areas.reference, polygon_areas.compiled):
        np.testing.assert_allclose(areas(corners, *GRID), expected, rtol=0, atol=1e-12)


@pytest.mark.slow
def test_a_disc_covers_what_fine_sampling_counts(ellipse):
    x, y, r, n = 9.3, 10.1, 5.1, 200
    inside = on_grid(
        lambda left, top, w, h: (
            np.hypot(
                left + w * (np.arange(n) + 0.5)[None] / n - x,
                top + h * (np.arange(n) + 0.5)[:, None] / n - y,
            )
            < r
        ).mean()
    )
    np.testing.assert_allclose(ellipse(x, y, r, r, 0.0, *GRID), inside, rtol=0, atol=2e-3)


def test_a_polygon_that_is_not_convex_covers_the_sum_of_its_parts(polygon):
    outer = np.array([[2.0, 2.0], [12.0, 2.0], [12.0, 9.0], [2.0, 9.0]])
    notch = np.array([[5.0, 2.0], [8.0, 2.0], [6.5, 7.0]])
    notched = np.array(
        [[2.0, 2.0], [5.0, 2.0], [6.5, 7.0], [8.0, 2.0], [12.0, 2.0], [12.0, 9.0], [2.0, 9.0]]
    )
    expected = polygon(outer, *GRID) - polygon(notch, *GRID)
    np.testing.assert_allclose(polygon(notched, *GRID), expected, rtol=0, atol=1e-13)


@pytest.mark.slow
@given(st.floats(6, 18), st.floats(6, 18), st.floats(0.01, 5.9), st.floats(0.01, 5.9), angle)
@settings(max_examples=40, deadline=None)
def test_without_gaps_the_elements_add_up_to_the_area(x, y, a, b, angle_rad):
    ellipse = Ellipse(x, y, a, b, angle_rad)
    assert coverage_cm2(ellipse, WHOLE).sum() == pytest.approx(ellipse.area_cm2, abs=1e-11)
    slab = Rectangle(x, y, 1.4 * max(a, b), 1.4 * min(a, b), angle_rad)
    assert coverage_cm2(slab, WHOLE).sum() == pytest.approx(slab.area_cm2, abs=1e-11)


@given(place, place, half_axis, half_axis, angle, st.integers(-4, 4), st.integers(-4, 4))
@settings(max_examples=30, deadline=None)
def test_a_shift_by_whole_pitches_shifts_the_coverage(x, y, a, b, angle_rad, right, down):
    big = (1.3, 1.0, 40, 40)
    one = ellipse_areas(x + 15.6, y + 15.6, a, b, angle_rad, *big)
    other = ellipse_areas(x + 15.6 + 1.3 * right, y + 15.6 + 1.3 * down, a, b, angle_rad, *big)
    moved = np.roll(one, (down, right), axis=(0, 1))
    np.testing.assert_allclose(other[5:-5, 5:-5], moved[5:-5, 5:-5], rtol=0, atol=1e-11)


@pytest.mark.slow
@given(place, place, half_axis, half_axis, angle, convex_polygons())
@settings(max_examples=30, deadline=None)
def test_a_mirrored_shape_has_the_mirrored_coverage(x, y, a, b, angle_rad, corners):
    one = ellipse_areas(x, y, a, b, angle_rad, *GRID)
    other = ellipse_areas(20.5 - x, y, a, b, -angle_rad, *GRID)
    np.testing.assert_allclose(other, one[:, ::-1], rtol=0, atol=1e-12)
    one = polygon_areas(corners, *GRID)
    other = polygon_areas(np.array([20.5, 0.0]) + corners * [-1.0, 1.0], *GRID)
    np.testing.assert_allclose(other, one[:, ::-1], rtol=0, atol=1e-12)


@given(convex_polygons(), st.integers(0, 11))
@settings(max_examples=20, deadline=None)
def test_the_first_corner_and_the_sense_do_not_matter(corners, start):
    turned = np.ascontiguousarray(np.roll(corners, start, axis=0)[::-1])
    expected = polygon_areas(corners, *GRID)
    np.testing.assert_allclose(polygon_areas(turned, *GRID), expected, rtol=0, atol=1e-12)


def test_the_angle_is_counter_clockwise_as_seen():
    rising = coverage_cm2(Ellipse(10.25, 10.25, 8.0, 1.0, math.pi / 4), PAD)
    assert rising[5, 10] > 0.5  # up on the right: small row, large column
    assert rising[5, 5] == 0.0
    slab = coverage_cm2(Rectangle(10.25, 10.25, 16.0, 2.0, math.pi / 4), PAD)
    assert slab[5, 10] > 0.5
    assert slab[5, 5] == 0.0


def test_elements_clear_of_the_shape_hold_exactly_nothing_and_inner_ones_their_area(
    ellipse, polygon
):
    x, y = np.meshgrid(PAD.x_cm, PAD.y_cm)
    distance = np.hypot(x - 9.7, y - 10.3)
    disc = ellipse(9.7, 10.3, 6.8, 6.8, 0.0, *GRID)
    assert (disc[distance > 6.8 + 0.71] == 0.0).all()
    np.testing.assert_allclose(disc[distance < 6.8 - 0.71], 1.0, rtol=0, atol=1e-13)
    corners = Rectangle(9.7, 10.3, 12.0, 5.0, 0.3).outline_cm().copy()
    slab = polygon(corners, *GRID)
    touched = on_grid(lambda *cell: polygon_on_rectangle(corners, *cell)) > 0.0
    assert (slab[~touched] == 0.0).all()


@pytest.mark.parametrize(
    ("shape", "total"),
    [
        (Circle(5.0, 5.0, 0.0), 0.0),
        (Circle(0.5, 0.5, 0.2), math.pi * 0.04),
        (Circle(-5.0, 40.0, 3.0), 0.0),
        (Circle(10.0, 10.0, 1000.0), 256.0),
        (Circle(1.15, 1.15, 0.1), 0.0),  # in a gap
        (Rectangle(10.25, 10.25, 20.5, 20.5, 0.0), 256.0),
        (Rectangle(10.25, 10.25, 20.5, 20.5, math.pi / 2), 256.0),
        (Rectangle(0.5, 0.5, 1.0, 1.0, 0.0), 1.0),
        (Polygon(np.array([[1.0, 1.0], [5.0, 5.0], [3.0, 3.0]])), 0.0),
        (Polygon(np.array([[1.0, 1.0], [5.0, 5.0]])), 0.0),
    ],
)
def test_the_extremes_come_out_whole(shape, total):
    areas = coverage_cm2(shape, PAD)
    assert areas.shape == (16, 16)
    assert areas.sum() == pytest.approx(total, abs=1e-11)
    assert (areas >= 0.0).all()


def test_a_polygon_with_many_corners_comes_near_its_circle():
    t = np.linspace(0, 2 * np.pi, 720, endpoint=False)
    corners = np.column_stack([9.0 + 6.0 * np.cos(t), 11.0 + 6.0 * np.sin(t)])
    disc = coverage_cm2(Circle(9.0, 11.0, 6.0), PAD)
    np.testing.assert_allclose(coverage_cm2(Polygon(corners), PAD), disc, rtol=0, atol=2e-4)
    assert polygon_area(corners) < math.pi * 36.0


def test_a_sliver_beyond_an_elements_edge_is_not_lost():
    """A unit disc, its centre e inside the corner: a quarter and two strips less two slivers."""
    e = 1e-6
    quarter = np.pi / 4 + 2 * e + e * e
    sliver = (2 / 3) * np.sqrt(2.0) * e**1.5 + e * e  # beyond one edge, to the first orders in e
    got = ellipse_areas.reference(e, e, 1.0, 1.0, 0.0, *GRID)[0, 0]
    assert got == pytest.approx(quarter - 2 * sliver, abs=1e-14)
