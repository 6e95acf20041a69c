"""Conclusions on figures 4.1 to 4.36 hold where they should, and fail on what refutes them."""

from __future__ import annotations

import numpy as np
import pytest

from tactile_graph import Frame, Mask, Points
from tactile_graph.wires import Image
from tactile_graph_thesis.item import Finding
from tactile_graph_thesis.items.chapter_4.figures_4_1_to_4_3_threshold import by_threshold
from tactile_graph_thesis.items.chapter_4.figures_4_4_and_4_5_variance import (
    hardly_changes,
    hardly_changes_anywhere,
    running_variances,
)
from tactile_graph_thesis.items.chapter_4.figures_4_6_to_4_17_discs import (
    more_is_left,
    quite_small,
)
from tactile_graph_thesis.items.chapter_4.figures_4_18_to_4_21_hull import betters_bad_boundaries
from tactile_graph_thesis.items.chapter_4.figures_4_22_to_4_28_rectangles import (
    keeps_size_and_cleans,
    much_bigger,
)
from tactile_graph_thesis.items.chapter_4.figures_4_29_to_4_36_rounding import (
    Rounding,
    fills_voids,
    leaves_voids,
    lone_voids,
    not_as_drastic,
)
from tactile_graph_thesis.items.chapter_4.section_4_1_thresholds import (
    moves_the_best,
    no_compelling_need,
    with_residuals,
)
from tactile_graph_thesis.items.chapter_4.section_4_2_2_to_4_5_erosion import (
    disappears,
    dramatic_on_noisy,
    erases_some,
)
from tactile_graph_thesis.items.chapter_4.section_4_3_5_order_of_rotation import interchangeable
from tactile_graph_thesis.items.chapter_4.tables_4_3_to_4_8_errors import (
    alike,
    only_large_error,
    smaller,
    within_an_element,
)


def square(side: int, of: int = 16, pitch_cm: float = 1.0) -> Mask:
    on = np.zeros((of, of), np.bool_)
    start = (of - side) // 2
    on[start : start + side, start : start + side] = True
    return Mask(on, (pitch_cm, pitch_cm))


def with_cells(mask: Mask, *cells: tuple[int, int], on: bool = True) -> Mask:
    values = mask.values.copy()
    for cell in cells:
        values[cell] = on
    return mask.with_values(values)


# -- figures 4.1, 4.4 and 4.5 ----------------------------------------------------------------


@pytest.mark.parametrize(
    ("low", "high", "expected"),
    [
        ((100.0, 2.0), (80.0, 6.0), [True, True]),
        ((83.0, 2.0), (80.0, 6.0), [False, True]),
        ((100.0, 6.0), (80.0, 6.2), [True, False]),
        ((100.0, 0.0), (80.0, 6.0), [True, False]),
    ],
    ids=["as told", "little larger", "no more voids", "none at the lower one"],
)
def test_a_footprint_a_little_larger_is_not_very_big(
    low: tuple[float, float], high: tuple[float, float], expected: list[bool]
) -> None:
    found = by_threshold(np.array([[low, high]] * 3), [0.002, 0.02])
    assert [f.holds for f in found] == expected


def runs(grows: float) -> np.ndarray:
    """Running variances of errors whose scatter grows from the first reading to the last."""
    errors = np.random.default_rng(3).standard_normal((2, 400, 20))
    errors *= np.exp(grows * np.linspace(0.0, 1.0, 20))
    return running_variances(errors.reshape(2, -1), 20)


def test_errors_that_grow_as_readings_go_on_have_no_settled_variance() -> None:
    assert hardly_changes(runs(0.0), (14, 20)).holds
    assert not hardly_changes(runs(2.0), (14, 20)).holds


def test_one_threshold_at_which_it_is_not_settled_refutes_all() -> None:
    steady, growing = runs(0.0), runs(2.0)
    levels = np.array([0.01, 0.02])
    assert hardly_changes_anywhere(np.stack([steady, steady]), levels, (14, 20)).holds
    found = hardly_changes_anywhere(np.stack([steady, growing]), levels, (14, 20))
    assert not found.holds
    assert "at 0.02 V" in found.found
    assert found.thesis != hardly_changes(steady, (14, 20)).thesis


# -- figures 4.10 to 4.20 --------------------------------------------------------------------


def test_an_image_of_which_half_is_left_is_not_quite_small() -> None:
    assert quite_small(square(10), square(6)).holds
    assert not quite_small(square(10), square(8)).holds


def test_more_cells_of_a_quarter_the_size_are_not_more_area() -> None:
    one, fewer, more = square(8), square(15, 32, 0.5), square(17, 32, 0.5)
    assert fewer.count > one.count
    assert not more_is_left(one, fewer).holds
    assert more_is_left(one, more).holds


def test_a_hull_that_halves_only_some_bad_errors_does_not_better_them() -> None:
    without = np.array([0.3, 1.2, 1.5, 2.0])
    assert betters_bad_boundaries(without, 0.4 * without).holds
    assert not betters_bad_boundaries(without, 0.6 * without).holds
    assert not betters_bad_boundaries(without, np.array([0.0, 0.1, 0.1, 1.9])).holds
    assert not betters_bad_boundaries(0.2 * without, 0.0 * without).holds


# -- figures 4.25 and 4.26 -------------------------------------------------------------------


def test_a_footprint_so_large_that_a_rim_is_little_is_not_much_bigger() -> None:
    small, large = square(6), square(60, 64)
    grown = Image(square(8).values.astype(float), quantity="level")
    assert much_bigger(grown, small).holds
    grown = Image(square(62, 64).values.astype(float), quantity="level")
    assert not much_bigger(grown, large).holds


def test_a_comparison_that_eats_the_rim_or_leaves_lone_cells_is_refuted() -> None:
    clean = square(8)
    noisy = with_cells(clean, (0, 0), (0, 8), (15, 3), (15, 12))
    assert keeps_size_and_cleans(noisy, clean).holds
    assert not keeps_size_and_cleans(noisy, noisy).holds
    assert not keeps_size_and_cleans(noisy, square(6)).holds
    assert not keeps_size_and_cleans(clean, clean).holds


# -- figures 4.30 to 4.33 --------------------------------------------------------------------


def turned(mask: Mask, rounded: Mask, stretch: float = 1.0) -> Rounding:
    rows, columns = np.nonzero(mask.values)
    xy = np.column_stack([mask.x_cm[columns], mask.y_cm[rows]])
    return Rounding(mask, Points(xy), Points(stretch * xy), rounded)


def test_a_footprint_that_lies_straight_has_no_voids_from_turning() -> None:
    whole = square(10)
    holes = with_cells(whole, *((r, r) for r in range(4, 11)), on=False)
    assert leaves_voids([turned(whole, holes)]).holds
    assert not leaves_voids([turned(whole, whole)]).holds
    assert not leaves_voids([turned(whole, holes), *[turned(whole, whole)] * 2]).holds


def test_fine_cells_that_move_the_sides_as_whole_ones_do_are_as_drastic() -> None:
    mask, holes = square(10), with_cells(square(10), (8, 8), on=False)
    far, near, unmoved = (turned(mask, m, s) for m, s in ((holes, 1.2), (holes, 1.02), (mask, 1.0)))
    assert not_as_drastic([far], [near]).holds
    assert not not_as_drastic([far], [far]).holds
    assert not not_as_drastic([far], [unmoved]).holds


def test_voids_that_stay_are_not_filled() -> None:
    whole = square(10)
    holes = with_cells(whole, (5, 5), (7, 9), on=False)
    assert lone_voids(holes) == 2
    assert fills_voids(holes, whole).holds
    assert not fills_voids(holes, with_cells(whole, (5, 5), on=False)).holds
    assert not fills_voids(whole, square(12)).holds


# -- tables 4.3 to 4.8 -----------------------------------------------------------------------


@pytest.mark.parametrize(
    ("finding", "holds"),
    [
        (smaller("", 1.1, 1.2), True),
        (smaller("", 1.2, 1.1), False),
        (smaller("", 0.5, 1.2, 0.5), True),
        (smaller("", 0.7, 1.2, 0.5), False),
        (alike("", 0.42, 0.45), True),
        (alike("", 0.40, 0.45), False),
        (alike("", 0.50, 0.45), False),
        (within_an_element(0.99), True),
        (within_an_element(1.01), False),
        (only_large_error(3.9, 1.9), True),
        (only_large_error(0.8, 1.5), False),
    ],
)
def test_an_error_that_grows_or_changes_refutes_what_the_tables_say(
    finding: Finding, holds: bool
) -> None:
    assert finding.holds == holds


# -- sections 4.1 to 4.5 ---------------------------------------------------------------------


def test_a_variable_threshold_that_takes_a_quarter_of_the_error_away_is_compelling() -> None:
    one = np.array([0.4, 0.6])
    assert no_compelling_need(one, np.array([0.4, 0.5])).holds
    assert not no_compelling_need(one, 0.7 * one).holds


@pytest.mark.parametrize(
    ("without", "with_them", "holds"),
    [(0.005, 0.01, True), (0.01, 0.01, False), (0.005, 0.0075, False), (0.005, 0.02, False)],
)
def test_residuals_that_leave_the_best_threshold_elsewhere_are_no_reason(
    without: float, with_them: float, holds: bool
) -> None:
    assert moves_the_best({0.0: without, 0.0125: with_them}).holds == holds


def test_residuals_are_the_same_in_every_reading_and_below_the_most() -> None:
    frames = [Frame.of(value * np.ones((4, 4)), 1.0, (0.0, 0.0), "volt") for value in (0.0, 1.0)]
    one, other = with_residuals(frames, 0.01, 3)
    np.testing.assert_allclose(other.image.values - one.image.values, 1.0)
    assert 0.0 <= one.image.values.min() < one.image.values.max() < 0.01


def test_without_a_blank_picture_nothing_is_erased() -> None:
    assert erases_some({"a": 0.0, "b": 0.02}).holds
    assert not erases_some({"a": 0.0, "b": 0.0}).holds
    assert disappears({"3 × 3": 0.1, "21 × 21": 0.9}).holds
    assert not disappears({"3 × 3": 0.0, "21 × 21": 0.9}).holds


def test_a_length_that_changes_by_more_than_a_millimetre_is_affected() -> None:
    same, moved = np.full((5, 2), 0.05), np.full((5, 2), 0.2)
    assert interchangeable({"a": same, "b": -same}).holds
    assert not interchangeable({"a": same, "b": moved}).holds
    assert not interchangeable({"a": same, "b": moved * (0.0, 1.0)}).holds


@pytest.mark.parametrize(
    ("after", "holds"),
    [
        ([1.0, 1.0, 1.0, 1.0], True),
        ([1.0, 1.0, 3.0, 3.0], False),
        ([1.6, 1.6, 1.0, 1.0], False),
        ([0.2, 0.2, 1.0, 1.0], False),
    ],
    ids=["as told", "still bad", "others worse", "others better"],
)
def test_morphology_must_halve_what_is_bad_and_leave_the_rest(
    after: list[float], holds: bool
) -> None:
    before = np.array([1.0, 1.0, 4.0, 4.0])
    assert dramatic_on_noisy(before, np.array(after)).holds == holds


def test_without_a_severe_case_there_is_no_improvement_of_one() -> None:
    few = np.array([1.0, np.nan, 2.0])
    assert not dramatic_on_noisy(few, few).holds
