"""Chains find the hull that Qhull finds."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

from helpers_modes import compiled, plainly
from tactile_graph_classifiers.measuring.hull import hull_corners

SHAPES = st.tuples(st.integers(1, 9), st.integers(1, 9))


def area(corners: np.ndarray) -> float:
    """Return the area within corners in order, below 0 where they run the other way."""
    x, y = corners.T
    return 0.5 * float((x * np.roll(y, -1) - np.roll(x, -1) * y).sum())


def test_a_lone_cell_has_four_corners() -> None:
    on = np.zeros((4, 5), bool)
    on[1, 3] = True
    found = plainly(hull_corners)(on).tolist()
    assert sorted(map(tuple, found)) == [(2.5, 0.5), (2.5, 1.5), (3.5, 0.5), (3.5, 1.5)]


def test_corners_on_a_straight_line_are_left_out() -> None:
    stairs = np.tri(6, dtype=bool)
    found = plainly(hull_corners)(stairs)
    assert sorted(map(tuple, found.tolist())) == [
        (-0.5, -0.5), (-0.5, 5.5), (0.5, -0.5), (5.5, 4.5), (5.5, 5.5)
    ]  # fmt: skip
    assert area(found) == pytest.approx(36.0 - 12.5)


@pytest.mark.slow  # much is compiled
@settings(max_examples=100, deadline=None)
@given(arrays(np.bool_, SHAPES).filter(lambda on: bool(on.any())))
def test_chains_find_what_qhull_finds(on: np.ndarray) -> None:
    wanted, loops = hull_corners.reference(on), plainly(hull_corners)(on)
    assert set(map(tuple, loops.tolist())) == set(map(tuple, wanted.tolist()))
    assert abs(area(loops)) == pytest.approx(abs(area(wanted)))
    assert (compiled(hull_corners)(on) == loops).all()
