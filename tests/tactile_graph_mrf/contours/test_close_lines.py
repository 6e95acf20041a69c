"""Gaps in line contours: closed where short, at the steepest place, and nothing else changed."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from tactile_graph.wires import Image
from tactile_graph_mrf.contours.close_lines import _Field, close_lines
from tactile_graph_mrf.contours.line_regions import line_regions
from tactile_graph_mrf.energy.line_field import LineField


def block() -> tuple[Image, np.ndarray, np.ndarray]:
    values = np.zeros((8, 8))
    values[2:6, 2:6] = 5.0
    return Image(values), np.diff(values, axis=0) != 0, np.diff(values, axis=1) != 0


def without(*gaps: tuple[bool, int, int]) -> tuple[Image, LineField, LineField]:
    """A block's image, its lines with gaps, and without."""
    image, across, down = block()
    whole = LineField.of(image, across.copy(), down.copy())
    for vertical, i, j in gaps:
        lines = down if vertical else across
        assert lines[i, j]
        lines[i, j] = False
    return image, LineField.of(image, across, down), whole


def same(a: LineField, b: LineField) -> bool:
    return np.array_equal(a.horizontal, b.horizontal) and np.array_equal(a.vertical, b.vertical)


@pytest.mark.parametrize(
    "gaps",
    [
        [(False, 1, 3)],
        [(False, 1, 3), (False, 1, 4)],
        [(False, 1, 2), (True, 2, 1)],  # around a corner
        [(False, 1, 3), (True, 4, 5)],
    ],
)
def test_a_short_gap_is_closed_and_the_object_found_again(gaps: list) -> None:
    image, lines, whole = without(*gaps)
    assert line_regions(image, lines).count == 0
    closed = close_lines(image, lines, longest=2)
    assert same(closed, whole)
    assert line_regions(image, closed).count == 16


def test_a_longer_gap_and_one_that_may_not_be_closed_stay() -> None:
    image, lines, _ = without((False, 1, 2), (False, 1, 3), (False, 1, 4))
    assert same(close_lines(image, lines, longest=2), lines)
    image, lines, _ = without((False, 1, 3))
    assert same(close_lines(image, lines, longest=0), lines)


def test_a_gap_at_the_rim_is_closed_by_the_rim() -> None:
    image = Image(np.repeat([[0.0, 0.0, 5.0, 5.0]], 5, axis=0))
    down = np.zeros((5, 3), bool)
    down[1:4, 1] = True
    lines = LineField.of(image, np.zeros((4, 4), bool), down)
    closed = close_lines(image, lines, longest=1)
    assert closed.vertical[:, 1].all()
    assert closed.count == 5


def test_of_two_ways_the_one_along_the_step_is_taken() -> None:
    values = np.zeros((6, 6))
    values[:3] = 5.0
    values[3, 3] = 5.0  # the step runs around this cell
    across, down = np.diff(values, axis=0) != 0, np.diff(values, axis=1) != 0
    whole = LineField.of(Image(values), across.copy(), down.copy())
    across[3, 3] = down[3, 2] = down[3, 3] = False
    closed = close_lines(Image(values), LineField.of(Image(values), across, down), longest=3)
    assert same(closed, whole)


def test_an_end_does_not_turn_back_to_its_own_line() -> None:
    image = Image(np.random.default_rng(0).random((13, 13)))
    across = np.zeros((12, 13), bool)
    across[5, 5:8] = True
    lines = LineField.of(image, across, np.zeros((13, 12), bool))
    assert same(close_lines(image, lines, longest=3), lines)


@pytest.mark.slow
@given(st.integers(0, 9999))
def test_lines_are_only_added_and_twice_is_as_once(seed: int) -> None:
    rng = np.random.default_rng(seed)
    image = Image(rng.random((6, 7)))
    lines = LineField.of(image, rng.random((5, 7)) < 0.3, rng.random((6, 6)) < 0.3)
    once = close_lines(image, lines, longest=2)
    assert (once.horizontal >= lines.horizontal).all()
    assert (once.vertical >= lines.vertical).all()
    assert same(close_lines(image, lines, longest=2), once)


@pytest.mark.parametrize("shape", [(1, 1), (1, 5), (4, 1)])
def test_narrow_images(shape: tuple[int, int]) -> None:
    image = Image(np.arange(float(np.prod(shape))).reshape(shape))
    assert close_lines(image, LineField.none(image)).count == 0


def test_the_rim_joins_its_corners_all_around() -> None:
    image = Image(np.zeros((2, 3)))
    field = _Field(image, LineField.of(image, np.zeros((1, 3), bool), np.zeros((2, 2), bool)), 0.0)
    around = [(0, 0), (0, 1), (0, 2), (0, 3), (1, 3), (2, 3), (2, 2), (2, 1), (2, 0), (1, 0)]
    for k, corner in enumerate(around):
        assert set(field.on(corner)) == {around[k - 1], around[(k + 1) % 10]}, corner
    assert field.on((1, 1)) == []


def test_corners_are_known_up_to_the_farthest_asked_for() -> None:
    image = Image(np.zeros((4, 6)))
    across = np.zeros((3, 6), bool)
    across[1, :5] = True
    field = _Field(image, LineField.of(image, across, np.zeros((4, 5), bool)), 0.0)
    for farthest in range(5):
        far = field._along_lines((2, 5), farthest)
        assert far == {(2, 5 - k): k for k in range(farthest + 1)}
