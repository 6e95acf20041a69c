"""Heavier and smaller: conclusions fail on what refutes them."""

from __future__ import annotations

import numpy as np
import pytest

from tactile_graph_thesis.items.chapter_6.section_6_1_2_heavier_smaller import (
    WEIGHTS_G,
    area_counts_more,
    smaller_is_better,
)

LOST = np.array([[1.0, 2.0, 3.0], [9.0, 9.5, 10.0], [20.0, 21.0, 22.0]])
"""Radii by weights, in percent."""


def test_weights_are_the_same_on_each_area() -> None:
    assert WEIGHTS_G == (1000.0, 2000.0, 3000.0)


@pytest.mark.parametrize(
    ("at", "holds"), [(0.0, True), (20.9, True), (21.0, False), (-22.0, False)]
)
def test_one_weight_of_which_the_smallest_loses_as_much_refutes(at: float, holds: bool) -> None:
    lost = LOST.copy()
    lost[0, 1] = at
    assert smaller_is_better(lost).holds == holds


def test_a_weight_that_makes_half_the_difference_refutes_that_area_decides() -> None:
    assert area_counts_more(LOST).holds
    assert "19 points of the weight, from 1 to 3 kg 2" in area_counts_more(LOST).found
    assert not area_counts_more(LOST + np.array([0.0, 0.0, 8.0])).holds
