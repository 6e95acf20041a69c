"""Step ``bridge_lines``: dead rows and columns no longer part what lies across them."""

from __future__ import annotations

from typing import Annotated

import numpy as np
from annotated_types import Ge
from numpy.typing import NDArray

from tactile_graph.steps.rules import Grid
from tactile_graph.wires import Image, Mask
from tactile_graph_filters.readings.dead_lines import dead_lines

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
        Dead is a row or column of it without a valid cell; and, where few others are constant too,
        one of which nearly all cells read the same.
    mask : Mask
    most : int
        So many dead lines side by side are bridged, no more.

    Returns
    -------
    Mask
        The mask itself where no line is dead. Cells of dead lines are on only by what lies beside.
    """
    rows, columns = dead_lines(image)
    if not (rows.any() or columns.any()):
        return mask
    on: Flags = mask.values & ~rows[:, None] & ~columns
    on = _bridged(on, rows, most)
    return mask.with_values(np.ascontiguousarray(_bridged(on.T, columns, most).T))


def _bridged(on: Flags, dead: Flags, most: int) -> Flags:
    """Return the cells of dead lines on where the live lines on both sides are."""
    out = on.copy()
    live = np.flatnonzero(~dead)
    for before, after in zip(live[:-1].tolist(), live[1:].tolist(), strict=True):
        if 0 < after - before - 1 <= most:
            out[before + 1 : after] |= on[before] & on[after]
    return out
