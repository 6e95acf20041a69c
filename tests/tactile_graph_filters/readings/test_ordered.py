"""Readings in ascending order: all of a small pad, an even part of a large one."""

from __future__ import annotations

import numpy as np
import pytest

from tactile_graph_filters.readings.ordered import MOST, in_order


@pytest.mark.parametrize("n", [0, 1, 256, MOST, 2 * MOST - 1])
def test_of_few_readings_all_are_taken(n: int) -> None:
    values = np.random.default_rng(n).normal(size=n)
    before = values.copy()
    assert np.array_equal(in_order(values), np.sort(before))
    assert np.array_equal(values, before)


@pytest.mark.parametrize(("rows", "columns"), [(64, 128), (128, 96), (256, 256), (300, 512)])
@pytest.mark.parametrize("every", [2, 3, 7, 8, 16, 32])
def test_dead_columns_are_in_the_part_as_often_as_on_the_pad(
    rows: int, columns: int, every: int
) -> None:
    for first in (0, 1, every - 1):
        values = np.ones((rows, columns))
        values[:, first::every] = 0.0
        found = in_order(values.ravel())
        assert MOST <= len(found) < 2 * MOST
        assert 1.0 - found.mean() == pytest.approx(1.0 - values.mean(), abs=0.02)
