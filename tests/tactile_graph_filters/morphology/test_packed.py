"""Masks whose rows are machine words come to the same cells as those that are not packed."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from helpers_filters import ELEMENTS, elements, mask_of, masks, random_mask, same_grid
from helpers_modes import compiled, held, plainly
from tactile_graph.wires import Mask
from tactile_graph_filters.morphology.dilate import Dilate
from tactile_graph_filters.morphology.elements import parse_element
from tactile_graph_filters.morphology.erode import Erode
from tactile_graph_filters.morphology.erosion import make_plan, sweep
from tactile_graph_filters.morphology.packed import (
    around,
    combined_cells,
    combined_rows,
    doubled_cells,
)
from tactile_graph_filters.morphology.subdivide import subdivide


def by_sweeps(mask: Mask, element: Any, dilate: bool) -> tuple[np.ndarray, int]:
    out = np.empty(mask.shape, np.bool_)
    plan = make_plan(parse_element(element), dilate=dilate)
    return out, sweep.reference(mask.values, plan, out)


@pytest.mark.slow  # much is compiled
@settings(max_examples=80, deadline=None)
@given(masks(), elements(), st.booleans())
def test_steps_equal_the_sweeps_over_cells_whatever_the_element(
    mask: Mask, element: list[list[int]], dilate: bool
) -> None:
    expected, count = by_sweeps(mask, element, dilate)
    step = (Dilate if dilate else Erode)(element=element)
    once = step(mask)
    assert once.words is not None
    assert once.count == count
    assert same_grid(once, mask)
    np.testing.assert_array_equal(once.values, expected)
    again, count = by_sweeps(mask_of(expected), element, dilate)
    twice = step(once)  # of packed rows now
    assert twice.count == count
    np.testing.assert_array_equal(twice.values, again)


@pytest.mark.parametrize("columns", [1, 31, 63, 64, 65])
@pytest.mark.parametrize("element", ELEMENTS, ids=str)
def test_wide_masks_equal_the_sweeps_and_wider_ones_are_swept(element: Any, columns: int) -> None:
    mask = random_mask(columns, (9, columns))
    for dilate, step in ((False, Erode), (True, Dilate)):
        made = step(element=element)(mask)
        expected, count = by_sweeps(mask, element, dilate)
        assert (made.words is None) == (columns > Mask.WIDEST)
        assert made.count == count
        np.testing.assert_array_equal(made.values, expected)


@pytest.mark.slow  # much is compiled
def test_machine_code_equals_plain_loops_and_the_reference() -> None:
    for seed, columns in enumerate((5, 16, 64)):
        values = held(random_mask(seed, (11, columns)).values)
        for dilate in (False, True):
            element = around(parse_element([[1, 0, 1], [0, 0, 1], [0, 0, 0]]), dilate=dilate)
            assert element is not None
            outs = [np.empty(11, np.uint64) for _ in range(3)]
            ways = (combined_cells.reference, plainly(combined_cells), compiled(combined_cells))
            counts = [way(values, element, out) for way, out in zip(ways, outs, strict=True)]
            assert counts[0] == counts[1] == counts[2]
            assert outs[0].tolist() == outs[1].tolist() == outs[2].tolist()
            words, again = held(outs[0]), np.empty(11, np.uint64)
            rows = combined_rows.reference(words, columns, element, again)
            out = np.empty(11, np.uint64)
            assert compiled(combined_rows)(words, columns, element, out) == rows
            assert out.tolist() == again.tolist()


@pytest.mark.slow
@pytest.mark.parametrize("columns", [1, 13, 32, 33])
def test_each_cell_becomes_four(columns: int) -> None:
    mask = random_mask(columns, (6, columns))
    fine = subdivide(mask, factor=2)
    assert (fine.words is None) == (2 * columns > Mask.WIDEST)
    assert fine.count == 4 * mask.count
    assert fine.pitch_cm == (mask.pitch_cm[0] / 2, mask.pitch_cm[1] / 2)
    np.testing.assert_array_equal(fine.values, np.kron(mask.values, np.ones((2, 2), bool)))
    if fine.words is not None:
        out = np.empty(12, np.uint64)
        assert compiled(doubled_cells)(held(mask.values), out) == fine.count
        assert out.tolist() == fine.words.tolist()


def test_cells_out_of_the_order_of_memory_are_taken_too() -> None:
    mask = Mask(np.asfortranarray(random_mask(1, (7, 12)).values))
    usual = Mask(np.ascontiguousarray(mask.values))
    for step in (Erode(), Dilate(), lambda m: subdivide(m, factor=2)):
        np.testing.assert_array_equal(step(mask).values, step(usual).values)
