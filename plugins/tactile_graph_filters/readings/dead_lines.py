"""Rows and columns of an image that read nothing: no valid cell, or the same in nearly all."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from tactile_graph.wires import Image

LEAST_CELLS = 4
"""A line of fewer is never called dead: its cells may well be equal by chance."""
EQUAL_SHARE = 0.75
"""Of a dead line's cells so many read the same; others may lie on a dead line across it."""
MOST_SHARE = 0.25
"""Where so many lines are constant, as on a pad without noise, that says nothing of one."""

Flags = NDArray[np.bool_]


def dead_lines(image: Image) -> tuple[Flags, Flags]:
    """Return which rows, shape (rows,), and which columns, shape (columns,), are dead.

    Parameters
    ----------
    image : Image
    """
    valid = np.ones(image.shape, np.bool_) if image.valid is None else image.valid
    return _dead(image.values, valid), _dead(image.values.T, valid.T)


def _dead(lines: NDArray[np.float64], valid: Flags) -> Flags:
    without: Flags = np.logical_not(valid.any(axis=1))
    if lines.shape[1] < LEAST_CELLS:
        return without
    middle = np.sort(lines, axis=1)[:, lines.shape[1] // 2]
    constant: Flags = (lines == middle[:, None]).mean(axis=1) >= EQUAL_SHARE
    return np.logical_or(without, constant) if constant.mean() < MOST_SHARE else without
