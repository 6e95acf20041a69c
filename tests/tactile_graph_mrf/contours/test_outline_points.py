"""Outline points: on the lines without readings, on the true outline with them."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from tactile_graph.errors import RuleError
from tactile_graph.wires import Image, Mask
from tactile_graph_mrf.contours.outline_points import covered, outline_points

PITCH, ORIGIN = (1.3, 0.7), (-0.15, 2.0)


def slab(left: float, right: float, top: float, bottom: float) -> np.ndarray:
    """Coverage of each cell of a 9 by 9 grid by a rectangle, in cells."""
    edges = np.arange(9.0)
    across = np.clip(np.minimum(right, edges + 1) - np.maximum(left, edges), 0.0, 1.0)
    down = np.clip(np.minimum(bottom, edges + 1) - np.maximum(top, edges), 0.0, 1.0)
    return np.outer(down, across)


def test_without_readings_they_are_the_middles_of_the_lines_around_the_mask() -> None:
    on = np.zeros((3, 4), bool)
    on[1, 1:3] = True
    points = outline_points(Mask(on, PITCH, ORIGIN)).xy_cm
    cells = (points - ORIGIN) / PITCH
    wanted = [(1.5, 1), (2.5, 1), (1.5, 2), (2.5, 2), (1, 1.5), (3, 1.5)]
    np.testing.assert_allclose(cells, wanted, atol=1e-12)


@pytest.mark.parametrize("power", [1.0, 1.5])
def test_on_an_even_pad_they_lie_on_the_true_sides(power: float) -> None:
    left, right, top, bottom = 1.4, 6.75, 2.1, 7.5
    values = 0.8 * slab(left, right, top, bottom) ** power
    image = Image(values, PITCH, ORIGIN)
    mask = image.mask(values > 0)
    found = (outline_points(mask, image, unevenness=0.0, load_power=power).xy_cm - ORIGIN) / PITCH
    n = 6  # sides of a cell in each row and column that the slab touches
    upper, lower, at_left, at_right = found[:n], found[n : 2 * n], found[2 * n : -n], found[-n:]
    for side, k, at in (
        (upper, 1, top),
        (lower, 1, bottom),
        (at_left, 0, left),
        (at_right, 0, right),
    ):
        # Cells in the corners are covered from two sides; their points lie further in.
        np.testing.assert_allclose(side[1:-1, k], at, atol=1e-9)


def test_a_cell_that_reads_nothing_is_taken_as_half_covered() -> None:
    values = np.ones((3, 3))
    values[0, 1] = 0.0
    image = Image(values)
    points = outline_points(image.mask(np.ones((3, 3), bool)), image, unevenness=0.0).xy_cm
    np.testing.assert_allclose(points[:3], [(0.5, 0.0), (1.5, 0.5), (2.5, 0.0)])
    assert outline_points(image.mask(np.zeros((3, 3), bool)), image).count == 0
    blank = image.with_values(np.zeros((3, 3)))
    assert (outline_points(image.mask(np.ones((3, 3), bool)), blank).xy_cm[:3, 1] == 0.5).all()


def test_a_mask_of_another_shape_is_refused() -> None:
    with pytest.raises(RuleError, match="shape"):
        outline_points(Mask(np.ones((2, 2), bool)), Image(np.ones((3, 3))))


@pytest.mark.parametrize("spread", [0.05, 0.5, 1.5])
@pytest.mark.parametrize("log_share", [-3.0, -0.7, 0.0, 0.4])
def test_covered_is_the_mean_of_an_even_share_given_its_logarithm(
    log_share: float, spread: float
) -> None:
    c = (np.arange(400_000) + 0.5) / 400_000
    weight = np.exp(-0.5 * ((log_share - np.log(c)) / spread) ** 2)
    weight /= max(weight.max(), 1e-300)
    assert covered(log_share, spread) == pytest.approx(float(weight @ c / weight.sum()), rel=1e-3)


@pytest.mark.slow
@given(st.floats(-700, 700), st.floats(0, 4))
def test_covered_is_a_share_and_rises_with_the_reading(log_share: float, spread: float) -> None:
    share = covered(log_share, spread)
    assert 0.0 <= share <= 1.0
    assert math.isfinite(share)
    assert covered(log_share - 0.1, spread) <= share + 1e-12


def test_where_nothing_lies_within_the_rims_own_median_is_a_full_reading() -> None:
    values = np.zeros((5, 7))
    values[2, 1:6] = 1.0, 2.0, 4.0, 8.0, 4.0
    image = Image(values)
    points = outline_points(image.mask(values > 0.0), image, unevenness=0.0, load_power=1.0).xy_cm
    share = np.array([0.25, 0.5, 1.0, 1.0, 1.0])
    np.testing.assert_allclose(points[:5, 1], 3.0 - share)
    np.testing.assert_allclose(points[5:10, 1], 2.0 + share)
