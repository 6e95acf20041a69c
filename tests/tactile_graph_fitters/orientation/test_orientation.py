"""The major axis by the scatter matrix: truth, equivariance, squares, and words for nothing."""

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import references_fitters as references
from helpers_rectangles import covered, off_rad, points, rectangle_xy, seeds, some_rectangle, turned
from tactile_graph.engine.tables.rows import scalars
from tactile_graph.errors import Degenerate
from tactile_graph.wires import Mask, Points, Rectangle
from tactile_graph_fitters.orientation.orientation import (
    ANY_ANGLE_STD_RAD,
    mask_scatter,
    orientation,
    points_scatter,
)


@settings(max_examples=40, deadline=None)
@given(seed=seeds)
def test_points_of_an_outline_give_its_centre_and_direction(seed):
    truth = some_rectangle(np.random.default_rng(seed))
    found = orientation(points(rectangle_xy(truth, 400)))
    assert (found.x_cm, found.y_cm) == pytest.approx((truth.x_cm, truth.y_cm), abs=0.05)
    assert off_rad(found.angle_rad, truth.angle_rad) < 0.02
    assert found.angle_deg == pytest.approx(math.degrees(found.angle_rad))


def test_tables_show_angles_in_degrees():
    found = orientation(points(rectangle_xy(Rectangle(5.0, 5.0, 8.0, 3.0, 0.5), 400)))
    row = scalars("axis", found)
    assert row["axis.angle_deg"] == pytest.approx(math.degrees(found.angle_rad))
    assert row["axis.angle_std_deg"] == pytest.approx(math.degrees(found.angle_std_rad))
    assert not [name for name in row if name.endswith("_rad")]


@pytest.mark.parametrize("degrees", [-75, -30, 0, 30, 45, 90])
def test_a_mask_gives_the_angle_as_seen_counter_clockwise(degrees):
    truth = Rectangle(10.0, 9.0, 14.0, 4.0, math.radians(degrees))
    found = orientation(covered(truth))
    assert off_rad(found.angle_rad, truth.angle_rad) < 0.02
    assert (found.x_cm, found.y_cm) == pytest.approx((10.0, 9.0), abs=0.1)
    assert found.elongation == pytest.approx(1 - 4 / 14, abs=0.03)
    assert not found.ambiguous


@settings(max_examples=40, deadline=None)
@given(seed=seeds, angle=st.floats(-3.0, 3.0), shift=st.floats(-1e3, 1e3), power=st.floats(-6, 6))
def test_moving_turning_and_scaling_points_does_the_same_to_the_axis(seed, angle, shift, power):
    rng = np.random.default_rng(seed)
    xy = rng.normal(0, 1, (30, 2)) * (5.0, 1.0)
    scale = 10.0**power
    here, there = orientation(Points(xy)), orientation(Points(scale * (turned(xy, angle) + shift)))
    centre = scale * (turned(np.array([[here.x_cm, here.y_cm]]), angle)[0] + shift)
    assert (there.x_cm, there.y_cm) == pytest.approx(tuple(centre), abs=1e-9 * scale * 1e3)
    assert off_rad(there.angle_rad, here.angle_rad + angle) < 1e-8
    assert there.elongation == pytest.approx(here.elongation, abs=1e-8)


def test_order_of_the_points_does_not_matter():
    rng = np.random.default_rng(3)
    xy = rng.normal(0, 1, (50, 2)) * (3.0, 1.0)
    assert orientation(Points(rng.permutation(xy))) == pytest.approx(orientation(Points(xy.copy())))


@pytest.mark.parametrize("degrees", [0, 20, 45])
def test_a_square_is_declared_ambiguous_instead_of_given_a_random_angle(degrees):
    found = orientation(covered(Rectangle(10, 10, 9, 9, math.radians(degrees))), cell_cm=1.3)
    assert found.ambiguous
    assert found.angle_std_rad > 0.35


def test_a_mask_of_equal_rows_and_columns_knows_nothing_of_its_angle():
    found = orientation(Mask(np.ones((6, 6), bool)))
    assert found.ambiguous
    assert found.angle_std_rad == pytest.approx(ANY_ANGLE_STD_RAD)
    assert found.elongation == pytest.approx(0.0, abs=1e-12)


def test_a_line_of_cells_has_its_direction_for_certain():
    found = orientation(points([[1, 1], [2, 2], [3, 3]]))
    assert found.angle_deg == pytest.approx(-45.0)
    assert found.elongation == 1.0
    assert found.angle_std_rad == 0.0
    assert not found.ambiguous


def test_the_error_estimated_is_that_of_footprints_with_voids():
    """Estimated and true spread of the angle agree within a factor of two."""
    rng = np.random.default_rng(0)
    errors, estimates = [], []
    for _ in range(300):
        truth = Rectangle(*rng.uniform(9.5, 10.8, 2), 12.0, 6.0, rng.uniform(-1.5, 1.5))
        whole = covered(truth, (16, 16), 1.3)
        found = orientation(whole.with_values(whole.values & (rng.random((16, 16)) > 0.15)))
        errors.append(off_rad(found.angle_rad, truth.angle_rad))
        estimates.append(found.angle_std_rad)
    true = math.sqrt(np.mean(np.square(errors)))
    assert 0.5 < np.mean(estimates) / true < 2.0


@pytest.mark.parametrize(
    ("xy", "words"),
    [
        (np.empty((0, 2)), "0 points: no direction"),
        ([[1, 2], [1, 2]], "2 points, all at one place: no direction"),
        ([[1, 2], [np.nan, 2]], "2 points, some not finite or too large: no direction"),
    ],
)
def test_says_why_there_is_no_direction(xy, words):
    with pytest.raises(Degenerate, match=words):
        orientation(points(xy))


def test_an_empty_mask_has_no_direction():
    with pytest.raises(Degenerate, match="0 points: no direction"):
        orientation(Mask(np.zeros((4, 4), bool)))


@pytest.mark.slow  # much is compiled
@settings(max_examples=20, deadline=None)
@given(seed=seeds)
def test_scatters_are_those_of_the_references(seed):
    rng = np.random.default_rng(seed)
    values = Mask(rng.random((7, 9)) < 0.5).values
    xy = Points(rng.normal(5, 2, (20, 2))).xy_cm
    for which in (mask_scatter.loops, mask_scatter.compiled):
        assert which(values) == pytest.approx(references.mask_scatter(values))
    for which in (points_scatter.loops, points_scatter.compiled):
        assert which(xy) == pytest.approx(references.points_scatter(xy))


def test_points_whose_spread_overflows_have_no_direction():
    far = Points(np.array([[0.0, 0.0], [1e160, 2e160], [2e160, 1e160]]))
    with pytest.raises(Degenerate, match="not finite or too large"):
        orientation(far)
