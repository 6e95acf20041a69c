"""``mask_points``: where the on-cells of a mask are."""

from __future__ import annotations

import numpy as np

from tactile_graph.wires import Mask, Points


def mask_points(mask: Mask) -> Points:
    """Return the centres of all cells that are on.

    Parameters
    ----------
    mask : Mask
        For instance a thresholded gradient, whose edge cells a fit can then take.

    Returns
    -------
    Points
        By rising x and, where x is the same, by rising y; none for an empty mask.
    """
    columns, rows = np.nonzero(mask.values.T)
    return Points(np.column_stack([mask.x_cm[columns], mask.y_cm[rows]]))
