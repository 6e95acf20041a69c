"""Conclusions on the law, the current and stacks fail on what refutes them."""

from __future__ import annotations

import numpy as np
import pytest

from tactile_graph_pads.law import ForceLaw
from tactile_graph_thesis.items.chapter_2.figure_2_2_force_law import as_told, falls_throughout
from tactile_graph_thesis.items.chapter_2.section_2_2_current import below_the_limit
from tactile_graph_thesis.items.chapter_2.section_2_4_3_stack_order import changes


def test_a_law_of_another_exponent_misses_the_second_point() -> None:
    assert as_told(ForceLaw()).holds
    assert not as_told(ForceLaw(exponent=2.0)).holds
    assert not as_told(ForceLaw(resistance_ohm=90e3)).holds


def test_a_resistance_that_stays_refutes_that_it_falls() -> None:
    assert falls_throughout(np.array([3.0, 2.0, 1.0])).holds
    assert not falls_throughout(np.array([3.0, 2.0, 2.0])).holds


def test_a_milliampere_is_too_much() -> None:
    assert below_the_limit(0.99).holds
    assert not below_the_limit(1.0).holds


@pytest.mark.parametrize(
    ("changed", "holds"),
    [((0.1, 0.2, 0.0, 0.0), True), ((0.1, 0.04, 0.0, 0.0), False), ((0.0, 0.0), False)],
)
def test_a_few_pairs_that_change_are_not_many(changed: tuple[float, ...], holds: bool) -> None:
    assert changes({str(k): c for k, c in enumerate(changed)}).holds == holds
