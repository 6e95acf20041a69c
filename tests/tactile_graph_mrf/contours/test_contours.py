"""Closed contours around cells, and points near a hull."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from tactile_graph.wires import Mask, Points, Polygon
from tactile_graph_mrf.contours.contours import contours
from tactile_graph_mrf.contours.near_hull import near_hull


def signed_area(polygon: Polygon) -> float:
    """Area, positive if the corners run counter-clockwise as seen (y down)."""
    x, y = polygon.xy_cm.T
    return float((np.roll(x, -1) * y - x * np.roll(y, -1)).sum() / 2)


def test_a_block_has_four_corners_counter_clockwise_in_cm() -> None:
    on = np.zeros((4, 5), bool)
    on[1:3, 1:4] = True
    (found,) = contours(Mask(on, (2.0, 1.0), (10.0, 20.0)))
    assert {(float(x), float(y)) for x, y in found.xy_cm} == {
        (12.0, 21.0),
        (18.0, 21.0),
        (18.0, 23.0),
        (12.0, 23.0),
    }
    assert signed_area(found) == 12.0


def test_a_hole_runs_the_other_way() -> None:
    on = np.ones((3, 3), bool)
    on[1, 1] = False
    outer, hole = contours(Mask(on))
    assert (signed_area(outer), signed_area(hole)) == (9.0, -1.0)


def test_cells_that_touch_at_a_corner_have_contours_of_their_own() -> None:
    for on in (np.eye(3, dtype=bool), np.eye(3, dtype=bool)[::-1].copy()):
        assert [signed_area(c) for c in contours(Mask(on))] == [1.0, 1.0, 1.0]
    assert contours(Mask(np.zeros((2, 2), bool))) == ()


@pytest.mark.slow
@given(st.integers(1, 7), st.integers(1, 7), st.floats(0, 1), st.integers(0, 999))
def test_contours_hold_all_cells_and_nothing_else(r: int, c: int, share: float, seed: int) -> None:
    on = np.random.default_rng(seed).random((r, c)) < share
    found = contours(Mask(on.copy()))
    assert sum(map(signed_area, found)) == on.sum()
    sides = sum(np.hypot(*(p.xy_cm - np.roll(p.xy_cm, 1, axis=0)).T).sum() for p in found)
    padded = np.pad(on, 1)
    assert sides == np.diff(padded, axis=0).sum() + np.diff(padded, axis=1).sum()


def test_only_points_near_the_hull_stay() -> None:
    square = Polygon(np.array([[0.0, 0.0], [0.0, 4.0], [4.0, 4.0], [4.0, 0.0]]))
    points = Points(
        np.array([[0.0, 0.0], [2.0, 0.3], [2.0, 2.0], [3.4, 2.0], [3.6, 2.0], [9.0, 0.2]])
    )
    kept = near_hull(points, square, within_cm=0.5).xy_cm
    np.testing.assert_array_equal(kept, [[0.0, 0.0], [2.0, 0.3], [3.6, 2.0]])
    single = Polygon(np.array([[1.0, 1.0]]))
    assert near_hull(Points(np.array([[1.0, 1.2], [3.0, 1.0]])), single).count == 1


def test_contours_come_by_their_first_corner_in_reading_order() -> None:
    on = np.random.default_rng(7).random((12, 15)) < 0.4
    found = [min((y, x) for x, y in polygon.xy_cm.tolist()) for polygon in contours(Mask(on))]
    assert found == sorted(found)
    assert len(found) > 15
