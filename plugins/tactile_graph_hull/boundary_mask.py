"""``boundary_mask``: the outermost cells of a footprint as a mask, of one scan or of several."""

from __future__ import annotations

from typing import Annotated, Literal

from annotated_types import MinLen

from tactile_graph.steps import Grid
from tactile_graph.wires import Mask
from tactile_graph_hull.boundary_scan import seen_cells

Scan = Literal["left", "right", "top", "bottom"]


def boundary_mask(
    mask: Mask,
    *,
    scans: Annotated[tuple[Scan, ...], MinLen(1)] = ("left", "right", "top", "bottom"),
) -> Annotated[Mask, Grid.like("mask")]:
    """Return a mask of the first on-cells met from the given sides.

    Parameters
    ----------
    mask : Mask
        The footprint.
    scans : sequence of 'left', 'right', 'top' or 'bottom'
        The sides to look from; all four give the boundary, one alone a part of figure 4.12.

    Returns
    -------
    Mask
        True where any of the scans meets its first on-cell of a row or column.

    Notes
    -----
    The same cells as `boundary_scan` gives as points. Source: thesis 3.1.2, figures 3.2 and 4.12.
    """
    return mask.with_values(seen_cells(mask.values, scans))
