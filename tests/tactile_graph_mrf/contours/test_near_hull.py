"""Points near a hull, whatever their size."""

from __future__ import annotations

import numpy as np
import pytest

from tactile_graph.errors import RuleError
from tactile_graph.wires import Image, Points, Polygon
from tactile_graph_mrf.contours.near_hull import near_hull

SQUARE = np.array([[0.0, 0.0], [4.0, 0.0], [4.0, 4.0], [0.0, 4.0]])
POINTS = np.array([[2.0, 0.0], [2.0, 0.5], [2.0, 0.6], [2.0, 2.0], [3.6, 3.6], [0.4, 2.0]])


@pytest.mark.parametrize("scale", [1e-200, 1.0, 1e200])
def test_those_within_a_distance_of_a_side_stay_in_their_order(scale: float) -> None:
    found = near_hull(Points(scale * POINTS), Polygon(scale * SQUARE), within_cm=0.5 * scale)
    np.testing.assert_array_equal(found.xy_cm, scale * POINTS[[0, 1, 4, 5]])


def test_points_in_one_place_at_the_origin_are_on_their_hull() -> None:
    points = Points(np.zeros((3, 2)))
    assert near_hull(points, Polygon(np.zeros((1, 2))), within_cm=0.1).count == 3


def test_how_near_can_be_told_in_pitches_of_the_elements() -> None:
    points, hull = Points(POINTS.copy()), Polygon(SQUARE.copy())
    elements = Image(np.zeros((2, 2)), (0.25, 0.25))
    by_cells = near_hull(points, hull, elements, within_cells=2.0)
    np.testing.assert_array_equal(by_cells.xy_cm, near_hull(points, hull).xy_cm)
    told = near_hull(points, hull, elements, within_cm=0.1, within_cells=20.0)  # cm go before
    assert told.count == near_hull(points, hull, within_cm=0.1).count
    with pytest.raises(RuleError, match="needs the port 'elements'"):
        near_hull(points, hull, within_cells=2.0)
