"""Conclusions of chapter 5 hold where they should, and fail on what refutes them."""

from __future__ import annotations

import numpy as np
import pytest

from tactile_graph.wires import Image, Points, Polygon
from tactile_graph_hull.hull import hull
from tactile_graph_mrf.energy.line_field import LineField
from tactile_graph_thesis.items.chapter_5.figures_5_8_to_5_14_restoration import (
    looks_like_the_original,
    matches_the_rectangle,
    not_changed_much,
    seems_bigger,
    very_similar,
)
from tactile_graph_thesis.items.chapter_5.section_5_4_1_schedule import (
    freezes,
    little_difference,
    no_effect,
)
from tactile_graph_thesis.items.chapter_5.table_5_2_radii import as_good
from tactile_graph_thesis.measure.restorations import (
    ENCLOSED,
    HEURISTIC,
    Hulls,
    RadiusRow,
    Restoration,
)
from tactile_graph_thesis.measure.simulated_rectangle import (
    CHOSEN,
    HOT,
    QUICK,
    Annealed,
    StateSpace,
    corrupted,
)

TRUTH, OBSERVED = corrupted(np.random.default_rng(0))


def restored(smooth: Image, lined: Image, observed: Image = OBSERVED) -> Restoration:
    none = LineField.none(TRUTH)
    return Restoration("it", TRUTH, observed, smooth, lined, none, (), None, "by", 0.0, "V")


def blurred(image: Image) -> Image:
    padded = np.pad(image.values, 1, "edge")
    rows, columns = image.shape
    around = [padded[i : i + rows, j : j + columns] for i in range(3) for j in range(3)]
    return image.with_values(np.mean(around, axis=0))


def test_an_image_is_like_the_original_only_where_lines_take_errors_away() -> None:
    near = TRUTH.with_values(0.3 * OBSERVED.values + 0.7 * TRUTH.values)
    assert looks_like_the_original(restored(blurred(OBSERVED), near)).holds
    assert not looks_like_the_original(restored(blurred(OBSERVED), OBSERVED)).holds
    assert not looks_like_the_original(restored(near, near)).holds


def test_one_cell_amiss_by_the_thesis_schedule_refutes_its_exactness() -> None:
    assert matches_the_rectangle({"thesis": 0, "other": 4}).holds
    assert not matches_the_rectangle({"thesis": 1, "other": 0}).holds


def test_an_object_seems_bigger_only_where_it_is_spread() -> None:
    read = TRUTH.with_values(np.where(TRUTH.values > 100.0, TRUTH.values, 0.0))
    assert seems_bigger(restored(blurred(read), read, read)).holds
    assert not seems_bigger(restored(read, read, read)).holds


def test_an_image_that_moves_is_changed() -> None:
    assert not_changed_much(restored(blurred(TRUTH), TRUTH, TRUTH)).holds
    assert not not_changed_much(restored(TRUTH, blurred(TRUTH), TRUTH)).holds


def square(side: float) -> Polygon:
    return hull(Points(np.array([[0.0, 0.0], [side, 0.0], [side, side], [0.0, side]])))


@pytest.mark.parametrize(("side", "alike"), [(1.0, True), (1.04, True), (1.1, False), (0.9, False)])
def test_hulls_a_fifth_apart_in_area_are_not_very_similar(side: float, alike: bool) -> None:
    other = square(3.0)
    one = Hulls("disc", other, LineField.none(TRUTH), other, square(side), other, square(1.0))  # type: ignore[arg-type]
    assert very_similar([one], "enclosed").holds == alike
    assert not very_similar([one], "every_line").holds


def row(ours: list[float], other: list[float]) -> tuple[RadiusRow]:
    return (RadiusRow("disc", 7.0, {ENCLOSED: np.array(ours), HEURISTIC: np.array(other)}),)


def test_a_way_that_errs_a_millimetre_more_does_not_as_well() -> None:
    assert as_good(row([6.6, 7.2], [6.5, 7.2]), ENCLOSED).holds
    assert as_good(row([6.42, 7.0], [6.5, 7.0]), ENCLOSED).holds
    assert not as_good(row([6.5, 7.5], [6.8, 7.1]), ENCLOSED).holds


def test_a_way_right_on_average_and_wrong_each_time_does_not_as_well() -> None:
    assert not as_good(row([6.0, 8.0], [6.6, 6.6]), ENCLOSED).holds


@pytest.mark.parametrize(("off", "none"), [(0.2, True), (-0.9, True), (1.1, False), (-4.2, False)])
def test_a_change_of_more_than_a_level_is_an_effect(off: float, none: bool) -> None:
    chosen = Annealed(CHOSEN, np.array([10.0, 11.0]), 0.0, 1.0)
    other = Annealed(HOT, chosen.rms_levels + off, off, 1.0)
    assert no_effect("start temperature", other, chosen).holds == none


@pytest.mark.parametrize(("energy", "stuck"), [(110.1, True), (109.9, False), (50.0, False)])
def test_quick_cooling_that_ends_as_low_is_not_frozen(energy: float, stuck: bool) -> None:
    slow = Annealed(HOT, np.array([6.0]), 0.0, 100.0)
    assert freezes(Annealed(QUICK, np.array([6.0]), 0.0, energy), slow).holds == stuck


def test_a_level_of_200_is_a_difference_between_state_spaces() -> None:
    finer = StateSpace(250, 0.4, 0.0, 1.0)
    assert little_difference(StateSpace(200, 0.5, 0.4, 1.0), finer).holds
    assert not little_difference(StateSpace(200, 0.5, 1.3, 1.0), finer).holds
