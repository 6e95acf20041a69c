"""Rows and columns that rest above the zero of all others are told from loads."""

from __future__ import annotations

import numpy as np
import pytest

from helpers_modes import plainly
from tactile_graph_filters.readings.hot_lines import row_offsets

EVERY = np.zeros((0, 0), np.bool_)
ROW, COLUMN = np.mgrid[:16, :16]
AWAY = np.hypot(ROW - 8, COLUMN - 8)


def offsets(
    values: np.ndarray, known: np.ndarray = EVERY, sigma: float = 1.0, step: float = 1e-3
) -> np.ndarray:
    args = values, known, 0.0, sigma, step
    found = row_offsets.reference(*args)
    assert np.array_equal(plainly(row_offsets)(*args), found)
    return found


def pressed(seed: int, radius: float = 0.0, load: float = 300.0, gains: float = 0.4) -> np.ndarray:
    """Noise of 1 under a disc on uneven elements."""
    rng = np.random.default_rng(seed)
    its = load * rng.lognormal(0.0, gains, (16, 16)) * (radius > AWAY)
    return its + rng.standard_normal((16, 16))


@pytest.mark.parametrize("radius", [0.0, 3.0, 5.0])
@pytest.mark.parametrize("offset", [10.0, 30.0, 100.0])
@pytest.mark.parametrize("row", [0, 8, 15])
def test_a_row_is_told_by_what_nothing_touches(radius: float, offset: float, row: int) -> None:
    for seed in range(5):
        values = pressed(seed, radius)
        values[row] += offset
        found = offsets(values)
        assert found[row] == pytest.approx(offset, abs=1.5)
        assert np.count_nonzero(found) == 1
        assert not offsets(values.T).any()


def test_so_are_several_and_one_of_which_a_cell_is_dead() -> None:
    values = pressed(3, 3.0)
    values[[2, 8, 14]] += 20.0
    values[:, 1] = 0.0
    assert np.array_equal(np.flatnonzero(offsets(values)), [2, 8, 14])


def test_so_is_one_of_a_device_that_clips_and_rounds_by_more_than_noise() -> None:
    for seed in range(20):
        values = np.maximum(np.round(0.4 * pressed(seed, 3.0) + np.where(ROW == 5, 9.5, 0.0)), 0.0)
        found = offsets(values, sigma=0.4, step=1.0)
        assert found[5] == pytest.approx(9.5, abs=0.5)
        assert np.count_nonzero(found) == 1


def test_cells_that_do_not_count_say_nothing() -> None:
    values, known = pressed(4), np.ones((16, 16), np.bool_)
    values[5] += 20.0
    known[:, 3] = False
    other = values.copy()
    other[:, 3] = np.nan
    assert np.array_equal(offsets(other, known), offsets(values, known))
    assert offsets(values, known)[5] == pytest.approx(20.0, abs=1.5)


@pytest.mark.parametrize(
    "values",
    [
        pressed(0, 7.9),
        pressed(1, 20.0),  # all over
        pressed(2, 20.0, load=10.0, gains=0.15),
        np.where(ROW == 4, pressed(5, 20.0), pressed(6)),  # a bar from edge to edge
        np.where(ROW == 0, pressed(5, 20.0, load=20.0), pressed(6)),
        np.where((ROW == 4) & (COLUMN > 1), 50.0, 0.0) + pressed(6),  # an even one
        np.where((ROW == 4) | (ROW == 5), 50.0, 0.0) + pressed(6),
        np.where(ROW == 4, 1000.0, 0.0) + pressed(6),
        np.where(ROW == 4, 0.0, pressed(6)),  # dead
        np.where(ROW == 4, 4.0, 0.0) + pressed(6),  # no more than noise
        np.where(ROW == 4, 50.0, pressed(6))[:7],
        np.where(ROW == 4, 50.0, pressed(6))[:, :7],
        np.where(ROW == 4, 50.0, pressed(6))[4:5],
        np.zeros((0, 5)),
    ],
    ids=range(14),
)
def test_loads_and_what_is_dead_rest_where_they_are(values: np.ndarray) -> None:
    assert not offsets(values).any()
    assert not offsets(values.T).any()


def test_without_noise_nothing_is_told() -> None:
    assert not offsets(np.where(ROW == 4, 20.0, 0.0), sigma=0.0).any()
