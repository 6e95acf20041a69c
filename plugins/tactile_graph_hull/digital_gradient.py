"""``digital_gradient``: the size of an image's change from cell to cell, whatever its direction."""

from __future__ import annotations

from typing import Annotated, Literal

import numpy as np

from tactile_graph.steps import Grid, Quantity
from tactile_graph.wires import Image, Mask
from tactile_graph_hull.partial_differences import differences, gradient_image


def digital_gradient(
    image: Image | Mask, *, norm: Literal["euclid", "sum", "max"] = "euclid"
) -> Annotated[Image, Quantity.like("image"), Grid.like("image")]:
    """Return the size of the gradient made of the two partial differences.

    Parameters
    ----------
    image : Image or Mask
        The cells of a mask count as 0 and 1, the result's quantity is then ``binary``.
    norm : {'euclid', 'sum', 'max'}
        How the two differences become one number: root of the sum of squares (the only one that
        favours no direction), sum of sizes, or the larger size.

    Returns
    -------
    Image
        0 or greater, per cell (not per cm). A difference to a cell that does not exist or is
        invalid counts as 0.

    Raises
    ------
    DataError, Degenerate
        As `partial_differences`.

    Notes
    -----
    Backward differences see an edge half a cell too far right and down; `sobel` is centred.
    Source: thesis 3.1.2, after Dougherty and Giardina 1987.
    """
    dx, dy = differences(image)
    with np.errstate(over="ignore", invalid="ignore"):  # `gradient_image` finds them out
        if norm == "euclid":
            size = np.hypot(dx, dy)
        elif norm == "sum":
            size = np.abs(dx) + np.abs(dy)
        else:
            size = np.maximum(np.abs(dx), np.abs(dy))
    return gradient_image(image, size)
