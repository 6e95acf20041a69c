"""``sobel``: the size of an image's gradient by Sobel's two 3x3 windows."""

from __future__ import annotations

from typing import Annotated

import numpy as np
from numpy.typing import NDArray

from tactile_graph.steps import Grid, Quantity
from tactile_graph.wires import Image, Mask
from tactile_graph_hull.partial_differences import gradient_image


def sobel(
    image: Image | Mask,
) -> Annotated[Image, Quantity.like("image"), Grid.like("image")]:
    """Return the size of the gradient at each cell, smoothed across its direction.

    Parameters
    ----------
    image : Image or Mask
        The cells of a mask count as 0 and 1, the result's quantity is then ``binary``.

    Returns
    -------
    Image
        0 or greater, per cell (not per cm): the windows are divided by 8, so that a ramp of one
        unit a cell gives 1. 0 where the 3x3 window leaves the image or holds an invalid cell.

    Raises
    ------
    DataError, Degenerate
        As `partial_differences`.

    Notes
    -----
    Edges come out two cells wide. Source: thesis 3.1.2, after Dougherty and Giardina 1987; the
    operator is due to Sobel and Feldman 1968.
    """
    values = np.asarray(image.values, dtype=np.float64)
    size = np.zeros_like(values)
    if min(values.shape) >= 3:
        with np.errstate(over="ignore", invalid="ignore"):  # `gradient_image` finds them out
            across = _smoothed(values)  # weights 1 2 1 over three rows
            along = _smoothed(values.T).T
            dx, dy = across[:, 2:] - across[:, :-2], along[2:] - along[:-2]
            size[1:-1, 1:-1] = np.hypot(dx, dy) / 8.0
        valid = getattr(image, "valid", None)
        if valid is not None:
            size[1:-1, 1:-1] *= _all_of_nine(valid)
    return gradient_image(image, size)


def _smoothed(values: NDArray[np.float64]) -> NDArray[np.float64]:
    return np.asarray(values[:-2] + 2.0 * values[1:-1] + values[2:])


def _all_of_nine(valid: NDArray[np.bool_]) -> NDArray[np.bool_]:
    three = valid[:-2] & valid[1:-1] & valid[2:]
    return np.asarray(three[:, :-2] & three[:, 1:-1] & three[:, 2:])
