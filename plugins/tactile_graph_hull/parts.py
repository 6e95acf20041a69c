"""Into how many separate parts a footprint falls, for steps that take it as one object's."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from tactile_graph.wires import Mask


def n_parts(on: NDArray[np.bool_]) -> int:
    """Return how many parts touch neither by a side nor by a corner.

    Parameters
    ----------
    on : ndarray of bool, shape (rows, columns)

    Notes
    -----
    Floods one part after the other, all cells at once: the mask is one long number, a bit a cell,
    and moving by a row or column is a shift of it.
    """
    rows, columns = on.shape
    step = columns + 1  # a column of cells that are off parts the end of a row from the next
    cells = np.zeros((rows, step), np.bool_)
    cells[:, :columns] = on
    left = int.from_bytes(np.packbits(cells).tobytes(), "big")
    n = 0
    while left:
        part, grown = 0, left & -left
        while grown != part:
            part = grown
            wide = part | part << 1 | part >> 1
            grown = (wide | wide << step | wide >> step) & left
        left ^= part
        n += 1
    return n


def several_parts(mask: Mask) -> str:
    """Return what to say of a footprint that is taken as one object's; empty for one part."""
    n = n_parts(mask.values)
    if n < 2:
        return ""
    return (
        f"{n} separate parts are taken together as one object; if they are several objects, "
        "'contacts' parts them and 'pick_contact' takes one"
    )
