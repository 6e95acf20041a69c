"""Errors are taken against the nearest true object of the same kind."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
import pytest

from tactile_graph import Circle, Ellipse, Points, Polygon, Rectangle
from tactile_graph.engine.tables.truth import error_names, errors_against, nearest
from tactile_graph.wires import TrueObject


@dataclass(frozen=True)
class Fitted(Circle):
    rms_cm: float = 0.0


NEAR, FAR = TrueObject(Circle(1.0, 1.0, 2.0), name="near"), TrueObject(Circle(9.0, 9.0, 2.0))
SLAB = TrueObject(Rectangle(1.0, 1.0, 4.0, 2.0, 0.0))


def test_the_nearest_of_the_kind_is_taken_even_if_another_kind_is_nearer():
    assert nearest(Circle(2.0, 2.0, 1.0), (FAR, SLAB, NEAR)) is NEAR
    assert nearest(Fitted(8.0, 8.0, 1.0), (FAR, SLAB, NEAR)) is FAR
    assert nearest(Ellipse(1.0, 1.0, 2.0, 1.0, 0.0), (FAR, SLAB, NEAR)) is None


@pytest.mark.parametrize("truth", [None, ()])
def test_without_truth_there_is_nothing_to_compare_with(truth):
    assert nearest(Circle(1.0, 1.0, 1.0), truth) is None


def test_what_is_no_shape_has_no_errors():
    assert nearest(Points(np.zeros((1, 2))), (NEAR,)) is None
    assert nearest(3.0, (NEAR,)) is None
    assert error_names(Points) == error_names(float) == ()


def test_errors_are_distance_of_centres_and_found_minus_true():
    assert errors_against(Circle(4.0, 5.0, 1.5), NEAR) == {"centre_cm": 5.0, "radius_cm": -0.5}


@pytest.mark.parametrize(
    ("found_deg", "true_deg", "error"), [(10, 5, 5), (89, -89, -2), (-89, 89, 2), (90, 0, 90)]
)
def test_an_angles_error_is_that_of_an_axis(found_deg, true_deg, error):
    true = TrueObject(Rectangle(0.0, 0.0, 4.0, 2.0, math.radians(true_deg)))
    found = Rectangle(0.0, 0.0, 5.0, 1.0, math.radians(found_deg))
    got = errors_against(found, true)
    assert got["angle_deg"] == pytest.approx(error)
    assert (got["length_cm"], got["breadth_cm"]) == (1.0, -1.0)


def test_polygons_are_compared_by_centroid_and_area():
    square = np.array([[0.0, 0.0], [2.0, 0.0], [2.0, 2.0], [0.0, 2.0]])
    got = errors_against(Polygon(square + 1.0), TrueObject(Polygon(2.0 * square)))
    assert got == {"centre_cm": pytest.approx(0.0), "area_cm2": pytest.approx(-12.0)}


def test_the_errors_of_a_union_are_those_of_all_its_arms():
    assert error_names(Fitted | Ellipse) == (
        "centre_cm", "radius_cm", "semi_major_cm", "semi_minor_cm", "angle_deg",
    )  # fmt: skip
