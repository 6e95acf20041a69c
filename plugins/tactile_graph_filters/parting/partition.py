"""``Partition``: the cells of a footprint and the group each belongs to, as the kernels take it."""

from __future__ import annotations

from typing import NamedTuple, TypeAlias

import numpy as np
from numpy.typing import NDArray

from tactile_graph.compiled import compiled_later

Reals: TypeAlias = NDArray[np.float64]
Whole: TypeAlias = NDArray[np.int64]
Owners: TypeAlias = NDArray[np.int32]
Flags: TypeAlias = NDArray[np.bool_]


class Partition(NamedTuple):
    """The cells of a footprint, parted into groups.

    Parameters
    ----------
    owner : ndarray of int32, shape (rows, columns)
        Group of each cell from 1, 0 where the cell is off; changed in place as groups are joined
        and cut.
    values : ndarray of float64, shape (rows, columns)
        Readings, 0 where the cell is off.
    known : ndarray of bool, shape (rows, columns)
        False in cells that cannot be told to be off.
    """

    owner: Owners
    values: Reals
    known: Flags


@compiled_later
def cut_out(cells: Partition, top: int, bottom: int, left: int, right: int) -> Partition:
    """Return a copy of the box from the first to the last row and column named."""
    return Partition(
        cells.owner[top : bottom + 1, left : right + 1].copy(),
        cells.values[top : bottom + 1, left : right + 1].copy(),
        cells.known[top : bottom + 1, left : right + 1].copy(),
    )
