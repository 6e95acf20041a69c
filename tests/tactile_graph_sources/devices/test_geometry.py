"""Order, transposition, flips and maps, each against the plain numpy of what it says."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from tactile_graph_sources.devices.geometry import Placement
from tactile_graph_sources.devices.preset import Geometry

WIRE = np.arange(6)[None, :]
BY_ROWS = WIRE[0].reshape(2, 3)


@pytest.mark.parametrize(
    ("settings", "expected"),
    [
        ({}, BY_ROWS),
        ({"order": "columns"}, [[0, 2, 4], [1, 3, 5]]),
        ({"transpose": True}, BY_ROWS.T),
        ({"flip": "rows"}, BY_ROWS[::-1]),
        ({"flip": "columns"}, BY_ROWS[:, ::-1]),
        ({"flip": "both"}, BY_ROWS[::-1, ::-1]),
        ({"row_map": [1, 0]}, [[3, 4, 5], [0, 1, 2]]),
        ({"column_map": [2, 0, 1]}, [[1, 2, 0], [4, 5, 3]]),
        ({"invert_from": 10}, 10 - BY_ROWS),
    ],
)
def test_a_geometry_places_the_cells(settings: dict[str, Any], expected: Any) -> None:
    placement = Placement(Geometry(rows=2, columns=3, **settings))
    np.testing.assert_array_equal(placement.images(WIRE)[0], expected)


def test_floats_that_are_no_numbers_are_out_of_range() -> None:
    placement = Placement(Geometry(rows=1, columns=2))
    cells = np.array([[1.0, 2.0], [np.nan, 1.0], [1.0, np.inf]], dtype=np.float32)
    assert placement.in_range(cells).tolist() == [True, False, False]
