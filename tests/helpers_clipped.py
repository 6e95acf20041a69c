"""Loads on pads that cut off below zero, and what kernels ask of such frames."""

from __future__ import annotations

import numpy as np

EVERY = np.zeros((0, 0), np.bool_)
"""Stands for cells all of which are known."""


def given(values: np.ndarray, known: np.ndarray = EVERY, rest: float = 0.0) -> tuple:
    sample = np.sort(values[known] if known.size else values, axis=None)
    steps = np.diff(sample)
    return values, known, sample, rest, float(steps[steps > 0.0].min(initial=np.inf))


def disc(radius: float, shape: tuple[int, int] = (16, 16)) -> np.ndarray:
    """Return the share of each cell that a disc covers, in the middle of a pad."""
    y, x = ((np.arange(5 * n) + 0.5) / 5.0 - n / 2.0 for n in shape)
    inside = x**2 + y[:, None] ** 2 < radius**2
    return inside.reshape(shape[0], 5, shape[1], 5).mean(axis=(1, 3))


def legs(n_twos: int) -> np.ndarray:
    """Return four feet of 2 x 2 cells that read one step, and in so many corners two."""
    found = np.zeros((24, 10))
    for k, (row, column) in enumerate([(6, 2), (6, 6), (13, 2), (13, 6)]):
        found[row : row + 2, column : column + 2] = 1.0
        found[row, column] += k < n_twos
    return found


def soles() -> np.ndarray:
    """Return low loads that reach over all of a narrow pad, in two places."""
    found = np.zeros((8, 64))
    for first, last in ((13, 30), (37, 44)):
        found[:, first:last] = np.random.default_rng(13).integers(0, 3, (8, last - first))
    return found
