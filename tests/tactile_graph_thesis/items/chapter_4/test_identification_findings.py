"""Conclusions on identification hold where they should, and fail on what refutes them."""

from __future__ import annotations

import numpy as np
import pytest

from tactile_graph_thesis.items.chapter_4.figures_4_37_to_4_43_identification import (
    decreases,
    falling,
)
from tactile_graph_thesis.items.chapter_4.table_4_9_identification import (
    all_identified,
    betters_the_printed,
)
from tactile_graph_thesis.measure.identification_errors import Confusion, table_4_9


def found(right: int, printed: int) -> dict[str, Confusion]:
    def one(n: int) -> Confusion:
        return Confusion(("a", "b"), {("a", "a"): n, ("a", "b"): 50 - n}, {}, 50)

    return {"minimum_distance": one(printed), "minimum_distance_normalised": one(right)}


def test_one_reading_of_another_object_refutes_that_all_are_identified() -> None:
    assert all_identified(found(50, 40)).holds
    assert not all_identified(found(49, 40)).holds


def test_a_distance_that_is_right_as_often_is_not_bettered() -> None:
    assert betters_the_printed(found(50, 49)).holds
    assert not betters_the_printed(found(50, 50)).holds
    assert not betters_the_printed(found(48, 49)).holds


@pytest.mark.slow
def test_with_weights_by_the_circuit_there_is_nothing_to_better() -> None:
    assert not betters_the_printed(table_4_9(seed=3, kind="footprint")).holds


GRAMS = np.array([0.0, 100.0, 200.0, 500.0, 1000.0, 2000.0])


@pytest.mark.parametrize(
    ("error", "holds"),
    [
        ([50.0, 30.0, 20.0, 5.0, 0.0, 0.0], True),
        ([50.0, 7.0, 2.0, 0.0, 2.0, 3.0], True),
        ([0.0, 1.0, 2.0, 3.0, 5.0, 8.0], False),
        ([10.0, 50.0, 40.0, 30.0, 20.0, 10.0], False),
        ([30.0, 0.0, 40.0, 0.0, 45.0, 29.0], False),
        ([50.0, 5.0, 5.0, 5.0, 30.0, 45.0], False),
        ([8.0, 8.0, 8.0, 8.0, 8.0, 8.0], False),
    ],
)
def test_an_error_that_rises_or_comes_and_goes_does_not_decrease(
    error: list[float], holds: bool
) -> None:
    (finding,) = decreases(GRAMS, np.array(error))
    assert finding.holds == holds


def test_the_nearest_falling_curve_is_that_of_least_squares() -> None:
    values = np.array([3.0, 1.0, 2.0, 2.0, 5.0, 0.0])
    found = falling(values)
    np.testing.assert_allclose(found, [3.0, 2.5, 2.5, 2.5, 2.5, 0.0])
    np.testing.assert_allclose(falling(found), found)


def test_where_too_few_err_to_tell_nothing_is_concluded() -> None:
    assert decreases(GRAMS, np.zeros(6)) == ()
    assert decreases(GRAMS, np.array([1.0, 0.0, 1.3, 0.0, 0.3, 0.0])) == ()
    assert len(decreases(GRAMS, np.array([2.1, 0.0, 0.0, 0.0, 0.0, 0.0]))) == 1
