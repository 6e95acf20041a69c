"""Footprints of many cells told apart on coarser ones: torn in detail, whole from afar."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any, NamedTuple, TypeAlias

import numpy as np
from numpy.typing import NDArray

Reals: TypeAlias = NDArray[np.float64]
Flags: TypeAlias = NDArray[np.bool_]
Labels: TypeAlias = NDArray[np.int32]
Part: TypeAlias = tuple[NDArray[np.intp], NDArray[np.intp]]
"""Rows and columns of some cells."""

BRIDGE_CELLS = 1
"""Gaps of up to twice as many cells lie within a part."""
LEAST_CELLS = 12
"""Blocks are too coarse if the objects found on them have fewer on average."""


class Cells(NamedTuple):
    """Readings (0 where off), which cells are on, and which can be told to be on or off."""

    values: Reals
    on: Flags
    known: Flags

    def cut_out(self, part: Part) -> Cells:
        """Return the box around a part with nothing else on; cells of others are unknown."""
        (rows, columns), corner = part, corner_of(part)
        box = np.s_[corner[0] : rows.max() + 1, corner[1] : columns.max() + 1]
        on = np.zeros(self.on[box].shape, np.bool_)
        on[rows - corner[0], columns - corner[1]] = True
        known = self.known[box] & (on | ~self.on[box])
        return Cells(np.where(on, self.values[box], 0.0), on, known)

    def coarser(self, factor: int) -> Cells:
        """Return blocks of ``factor`` by ``factor`` cells: their mean; on if at least half is."""
        values, on, known = (shares(grid, factor) for grid in self)
        return Cells(np.where(on >= 0.5, values, 0.0), on >= 0.5, np.maximum(on, known) >= 0.5)


def corner_of(part: Part) -> tuple[int, int]:
    """Return first row and first column of a part."""
    return int(part[0].min()), int(part[1].min())


def shares(grid: Reals | Flags, factor: int) -> Reals:
    """Return the mean of each block; beyond the end of the grid is 0."""
    rows, columns = (-(-n // factor) for n in grid.shape)
    whole = np.zeros((rows * factor, columns * factor))
    whole[: grid.shape[0], : grid.shape[1]] = grid
    return np.asarray(whole.reshape(rows, factor, columns, factor).mean(axis=(1, 3)))


def split_by_scale(cells: Cells, split: Callable[[Cells], Labels], working_cells: int) -> Labels:
    """Return the number of each cell's object, 0 where it is off.

    Parts that lie apart are looked at each for itself, on blocks of so many cells that at most
    about ``working_cells`` of them are on; on smaller ones if objects are small among them. What
    is found there to be several objects is looked at again, each of them at its own scale.

    Parameters
    ----------
    cells : Cells
    split : callable
        Returns the number of each cell's object, from 1.
    working_cells : int

    Returns
    -------
    ndarray of int32, shape (rows, columns)
    """

    def factor_of(part: Part) -> int:
        return math.ceil(math.sqrt(part[0].size / working_cells))

    labels = np.zeros(cells.on.shape, np.int32)
    todo = [(part, factor_of(part)) for part in parts(cells.on)]
    count = 0
    while todo:
        part, factor = todo.pop()
        found = pieces(cells, part, split, factor)
        while factor > 1 and len(found) > max(1.0, part[0].size / (LEAST_CELLS * factor**2)):
            fitting = math.isqrt(part[0].size // (LEAST_CELLS * len(found)))
            factor = max(min(fitting, factor - 1), 1)
            found = pieces(cells, part, split, factor)
        for piece in found:
            if len(found) > 1 and factor_of(piece) < factor:
                todo.append((piece, factor_of(piece)))
            else:
                count += 1
                labels[piece] = count
    return labels


def parts(on: Flags) -> list[Part]:
    """Return the cells of each part that wider gaps than `BRIDGE_CELLS` spans set apart."""
    from scipy import ndimage

    square = np.ones((2 * BRIDGE_CELLS + 1,) * 2, np.bool_)
    number, _ = ndimage.label(ndimage.binary_dilation(on, square), np.ones((3, 3)))
    rows, columns = np.nonzero(on)
    return grouped((rows, columns), number[rows, columns])


def grouped(part: Part, number: NDArray[np.integer[Any]]) -> list[Part]:
    """Return the cells of each number, smallest number first."""
    order = np.argsort(number, kind="stable")
    ends = np.flatnonzero(np.diff(number[order])) + 1
    rows, columns = (np.split(axis[order], ends) for axis in part)
    return list(zip(rows, columns, strict=True))


def pieces(cells: Cells, part: Part, split: Callable[[Cells], Labels], factor: int) -> list[Part]:
    """Return the cells of each object found in a part on blocks of ``factor`` by ``factor`` cells.

    Cells whose block is off go with the nearest one that is on.
    """
    from scipy import ndimage

    held = cells.cut_out(part)
    labels = split(held.coarser(factor) if factor > 1 else held)
    if not labels.any():
        return [part]
    if factor > 1:
        labels = labels.repeat(factor, 0).repeat(factor, 1)
        nearest = ndimage.distance_transform_edt(
            labels == 0, return_distances=False, return_indices=True
        )
        labels = labels[tuple(nearest)]
    top, left = corner_of(part)
    return grouped(part, labels[part[0] - top, part[1] - left])
