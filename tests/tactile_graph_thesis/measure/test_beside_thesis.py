"""Maximum and average of errors, and how they stand beside the thesis' tables."""

from __future__ import annotations

import numpy as np
import pytest

from tactile_graph_thesis.measure.beside_thesis import beside_thesis, spread
from tactile_graph_thesis.measure.rectangles import OBJECTS


def test_maximum_is_the_mean_over_groups_of_each_group_s() -> None:
    found = spread(np.array([1.0, 5, 2, 2, 9, 1, 100]), 3)
    assert found.largest == (5 + 9) / 2  # the seventh is left over
    assert found.average == pytest.approx(120 / 7)


def test_a_spread_leaves_out_readings_without_an_answer_and_counts_them() -> None:
    errors = np.array([1.0, 3.0, np.nan, 2.0, 4.0, 0.0, 9.0])
    found = spread(errors, 2)
    assert found.missing == 1
    assert found.average == pytest.approx(19 / 6)
    assert found.largest == pytest.approx((3 + 4 + 9) / 3)
    assert found.average_range[0] == pytest.approx(2.1)
    assert found.average_range[1] == pytest.approx(4.35)


def test_a_spread_of_nothing_is_no_number() -> None:
    found = spread(np.full(4, np.nan), 2)
    assert found.missing == 4
    assert np.isnan(found.average)


def test_signed_errors_stand_beside_the_table_by_their_size_in_groups_of_twenty() -> None:
    errors = {name: np.zeros((40, 4)) for name in OBJECTS}
    errors["RECTANGLE II"][3, 1], errors["RECTANGLE II"][30, 1] = -4.0, 2.0
    table = beside_thesis("table-4.8", errors)
    rows = {row.what: row for row in table.compared}
    largest, average = (rows[f"RECTANGLE II, length {s}"] for s in ("max", "avg"))
    assert (largest.ours, largest.thesis, largest.unit) == (pytest.approx(3.0), 3.3, "cm")
    assert average.ours == pytest.approx(6.0 / 40)
    assert largest.ratio == pytest.approx(3.0 / 3.3)
    assert rows["RECTANGLE I, length max"].ours == 0.0
    assert [r.thesis for r in table.rows["RECTANGLE II"]] == [9.0, 4.8, 3.3, 1.6, 1.6, 1.3]
    assert len(table.compared) == 12


def test_readings_without_an_answer_are_left_out_and_counted_by_object() -> None:
    errors = {name: np.zeros((3, 3)) for name in OBJECTS}
    errors["RECTANGLE I"][1] = np.nan
    table = beside_thesis("table-4.7", errors)
    assert table.missing == {"RECTANGLE I": 1, "RECTANGLE II": 0}
    assert [row.ours for row in table.compared] == [0.0] * 12
