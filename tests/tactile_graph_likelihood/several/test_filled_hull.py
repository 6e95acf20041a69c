"""One object of a shape that is not looked for, answered as several side by side."""

import numpy as np
import pytest

from tactile_graph.wires import Image
from tactile_graph_likelihood.several.locate_objects import LocateObjects

ROWS, PITCH_CM, FINER = 32, 0.65, 8
SIDE = (np.arange(ROWS * FINER) + 0.5) * PITCH_CM / FINER
X, Y = np.meshgrid(SIDE, SIDE)


def seen(within, seed):
    """Return an image of what lies within, on elements of 10 % gains."""
    rng = np.random.default_rng(seed)
    covered = within.reshape(ROWS, FINER, ROWS, FINER).mean((1, 3))
    grams = 100.0 * covered * np.exp(rng.normal(0.0, 0.1, covered.shape))
    return Image(grams + rng.normal(0.0, 0.3, covered.shape), (PITCH_CM,) * 2, quantity="gram")


def triangle(x_cm, y_cm, turn):
    within = np.ones(X.shape, bool)
    for angle in turn + np.arange(3) * 2.0 * np.pi / 3.0:
        within &= (X - x_cm) * np.cos(angle) + (Y - y_cm) * np.sin(angle) <= 1.5
    return within


def discs(*places):
    return np.any([np.hypot(X - x, Y - y) <= 2.2 for x, y in places], axis=0)


@pytest.mark.slow  # much is compiled
def test_parts_of_a_triangle_are_flagged_and_two_discs_that_touch_are_not() -> None:
    step, unflagged = LocateObjects(), 0
    for seed in range(10):
        its = step(seen(triangle(9.0 + 0.1 * seed, 10.0, 0.3 * seed), seed))
        unflagged += its.fits and its.count > 1
        two = step(seen(discs((8.0, 9.0 + 0.05 * seed), (12.4, 9.5)), seed))
        assert two.count == 2
        assert two.fits
    assert unflagged <= 1
