"""Step ``bridge_lines``: dead rows and columns no longer part what lies across them."""

from __future__ import annotations

from typing import Annotated

import numpy as np
from annotated_types import Ge
from numpy.typing import NDArray

from tactile_graph.steps.rules import Grid
from tactile_graph.wires import Image, Mask

LEAST_CELLS = 4
"""A line of fewer is never called dead: its cells may well be equal by chance."""

Flags = NDArray[np.bool_]


def bridge_lines(
    image: Image,
    mask: Annotated[Mask, Grid.like("image")],
    *,
    most: Annotated[int, Ge(0)] = 2,
) -> Annotated[Mask, Grid.like("image")]:
    """Return the mask with cells of dead lines turned on where both sides of the line are on.

    Parameters
    ----------
    image : Image
        Dead is a row or column of it without a valid cell; and, where the others are not all
        constant too, one whose cells all read the same.
    mask : Mask
    most : int
        So many dead lines side by side are bridged, no more.

    Returns
    -------
    Mask
        The mask itself where no line is dead.
    """
    valid = np.ones(image.shape, np.bool_) if image.valid is None else image.valid
    on: Flags = mask.values
    for axis in (0, 1):
        lines, known = (image.values, valid) if axis == 0 else (image.values.T, valid.T)
        dead = _dead(lines, known)
        if dead.any() and not dead.all():
            on = _bridged(on if axis == 0 else on.T, dead, most)
            on = on if axis == 0 else on.T
    return mask if on is mask.values else mask.with_values(np.ascontiguousarray(on))


def _dead(lines: NDArray[np.float64], valid: Flags) -> Flags:
    """Return which lines, shape (lines, cells), are dead."""
    without: Flags = np.logical_not(valid.any(axis=1))
    if lines.shape[1] < LEAST_CELLS:
        return without
    lowest = np.where(valid, lines, np.inf).min(axis=1)
    highest = np.where(valid, lines, -np.inf).max(axis=1)
    constant = lowest == highest
    # Of a pad without noise every unloaded line is constant: that says nothing.
    return np.logical_or(without, constant) if constant.mean() < 0.25 else without


def _bridged(on: Flags, dead: Flags, most: int) -> Flags:
    """Return the cells of dead lines on where the live lines on both sides are."""
    out = on.copy()
    live = np.flatnonzero(~dead)
    for before, after in zip(live[:-1].tolist(), live[1:].tolist(), strict=True):
        if 0 < after - before - 1 <= most:
            out[before + 1 : after] |= on[before] & on[after]
    return out
