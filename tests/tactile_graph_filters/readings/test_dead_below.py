"""Cells that read 0 on a pad that rests above it are dead; unloaded ones beside loads are not."""

from __future__ import annotations

import numpy as np
import pytest

from tactile_graph.wires import Image
from tactile_graph_filters.readings.dead_below import dead_below, without_dead
from tactile_graph_filters.thresholds.noise_level import noise_level

ROW, COLUMN = np.mgrid[:16, :16]
CORNER = (ROW < 8) & (COLUMN < 8)


def pressed(rest: float = 20.0, radius: float = 3.0, seed: int = 0) -> np.ndarray:
    """Whole counts, noise of 1.5 of them, under a disc of uneven load."""
    rng = np.random.default_rng(seed)
    load = 200.0 * rng.lognormal(0.0, 0.3, (16, 16)) * (np.hypot(ROW - 9, COLUMN - 9) < radius)
    return np.rint(rest + load + rng.normal(0.0, 1.5, (16, 16)))


@pytest.mark.parametrize("n", [2, 20, 64, 75])
def test_they_are_found_and_the_level_is_that_of_the_others(n: int) -> None:
    values, dead = pressed(), np.zeros(256, np.bool_)
    dead[np.random.default_rng(n).permutation(256)[:n]] = True
    dead = dead.reshape(16, 16)
    alive = noise_level(Image(values, valid=~dead))
    image = Image(np.where(dead, 0.0, values))
    assert np.array_equal(dead_below(image), dead)
    assert np.array_equal(without_dead(image).valid, ~dead)
    assert noise_level(image) == alive < 60.0


def test_of_those_that_are_invalid_nothing_is_said() -> None:
    image = Image(np.where(CORNER, 0.0, pressed()), valid=~CORNER)
    assert dead_below(image) is None
    assert without_dead(image) is image


@pytest.mark.parametrize(
    "values",
    [
        np.maximum(pressed(0.0), 0.0),  # clipped noise
        np.maximum(pressed(0.0) - 5.0, 0.0),
        np.where(np.hypot(ROW - 8, COLUMN - 8) < 6.8, pressed(200.0) * 0.9, 0.0)
        * np.random.default_rng(1).lognormal(0.0, 0.2, (16, 16)),  # an object on more than half
        np.where(np.hypot(ROW - 7.5, COLUMN - 7.5) < 7.2, 100.0, 0.0)
        * np.random.default_rng(1).normal(1.0, 0.05, (16, 16)),  # evenly, on nearly two thirds
        np.where(CORNER, 0.0, 100.0) * np.random.default_rng(1).normal(1.0, 0.05, (16, 16)),
        np.where(np.arange(25) < 6, 0.0, np.random.default_rng(1).normal(100, 5, 25)).reshape(5, 5),
        np.where((ROW == 0) & (COLUMN < 3), -np.inf, pressed()),  # to be refused
        np.where((ROW == 0) & (COLUMN < 3), -1e200, pressed()),
        np.where(CORNER, 0.0, 5.0),
        np.zeros((16, 16)),
        np.ones((1, 3)),
    ],
    ids=range(11),
)
def test_cells_that_nothing_touches_are_not_dead(values: np.ndarray) -> None:
    assert dead_below(Image(values)) is None
