"""Conclusions on the techniques of chapter 3 fail on what refutes them."""

from __future__ import annotations

import numpy as np

from tactile_graph import Mask, Points
from tactile_graph_hull.boundary_scan import seen_cells
from tactile_graph_thesis.items.chapter_3.figures_3_2_to_3_6_techniques import (
    encloses,
    outermost,
    removes_noise,
)
from tactile_graph_thesis.items.chapter_3.section_3_1_2_operators import OPERATORS, little_between


def mask(*rows: str) -> Mask:
    return Mask(np.array([[c == "#" for c in row] for row in rows]), (1.0, 1.0))


SIDES = ("left", "right", "top", "bottom")
SQUARE = mask(".....", ".###.", ".###.", ".###.", ".....")
HOLE = mask(".......", ".#####.", ".#####.", ".##.##.", ".#####.", ".#####.", ".......")


def seen(image: Mask, *sides: str) -> Mask:
    return image.with_values(seen_cells(image.values, sides))  # type: ignore[arg-type]


def test_a_side_that_is_not_scanned_and_a_hole_inside_refute_the_boundary() -> None:
    assert outermost(SQUARE, seen(SQUARE, *SIDES)).holds
    assert not outermost(SQUARE, seen(SQUARE, "left", "top")).holds
    assert not outermost(HOLE, seen(HOLE, *SIDES)).holds


def test_noise_that_stays_or_an_object_that_is_not_given_back_refutes_noise_removal() -> None:
    noisy = mask("#....", ".###.", ".###.", ".###.", ".....")
    eroded = mask(".....", ".....", "..#..", ".....", ".....")
    nearly = mask(".....", "..##.", ".###.", ".###.", ".....")
    assert removes_noise(SQUARE, noisy, eroded, nearly).holds
    assert not removes_noise(SQUARE, noisy, eroded, noisy).holds
    assert not removes_noise(SQUARE, noisy, SQUARE, SQUARE).holds
    assert not removes_noise(SQUARE, noisy, eroded, eroded).holds


def test_a_hull_that_leaves_a_point_out_or_turns_back_is_none() -> None:
    corners = np.array([[0.0, 0.0], [4.0, 0.0], [4.0, 4.0], [0.0, 4.0]])
    inside = np.array([[1.0, 2.0]])
    points = Points(np.concatenate([corners, inside]))
    assert encloses(points, corners).holds
    assert encloses(points, corners[::-1]).holds
    assert not encloses(points, corners[:3]).holds
    assert not encloses(points, np.concatenate([corners, inside])).holds
    assert not encloses(points, 2.0 * corners - 2.0).holds


def test_an_operator_that_errs_a_quarter_more_is_no_little_difference() -> None:
    assert little_between({"a": 1.0, "b": 1.2}).holds
    assert not little_between({"a": 1.0, "b": 1.3}).holds


def test_gradients_are_seen_on_both_sides_of_an_edge_and_the_scan_inside() -> None:
    image = mask(*["." * 9] * 2, *["..#####.."] * 5, *["." * 9] * 2)
    spans = {name: np.ptp(of(image).xy_cm, axis=0).tolist() for name, of in OPERATORS.items()}
    assert spans["boundary scan"] == [4.0, 4.0]
    assert spans["partial differences"] == spans["digital gradient"] == [5.0, 5.0]
    assert spans["Sobel"] == [6.0, 6.0]
