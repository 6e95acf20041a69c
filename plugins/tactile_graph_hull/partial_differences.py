"""``partial_differences``: the change of an image from cell to cell, along x and along y."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from tactile_graph.errors import DataError, Degenerate
from tactile_graph.wires import Image, Mask


class Differences(NamedTuple):
    """Change along x (right) and along y (down), per cell, in units of the image."""

    dx: Image
    dy: Image


def partial_differences(image: Image | Mask) -> Differences:
    """Return each cell's difference from its left and from its upper neighbour.

    Parameters
    ----------
    image : Image or Mask
        The cells of a mask count as 0 and 1, its differences as quantity ``binary``.

    Returns
    -------
    Differences
        ``dx`` and ``dy``, per cell (not per cm). 0 where the cell or the neighbour does not exist
        or is invalid.

    Raises
    ------
    DataError
        If a cell holds NaN or infinity.
    Degenerate
        If a difference is too large for a number.

    Notes
    -----
    Source: thesis equations 3.1 and 3.2, after Dougherty and Giardina 1987.
    """
    dx, dy = differences(image)
    return Differences(gradient_image(image, dx), gradient_image(image, dy))


def differences(image: Image | Mask) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Return [DX(f)] and [DY(f)] of equations 3.1 and 3.2, shape (rows, columns) each."""
    values = np.asarray(image.values, dtype=np.float64)
    dx, dy = np.zeros_like(values), np.zeros_like(values)
    with np.errstate(over="ignore", invalid="ignore"):  # `gradient_image` finds them out
        np.subtract(values[:, 1:], values[:, :-1], out=dx[:, 1:])
        np.subtract(values[1:], values[:-1], out=dy[1:])
    valid = getattr(image, "valid", None)
    if valid is not None:
        dx[:, 1:] *= valid[:, 1:] & valid[:, :-1]
        dy[1:] *= valid[1:] & valid[:-1]
    return dx, dy


def gradient_image(image: Image | Mask, values: NDArray[np.float64]) -> Image:
    """Return values on the image's grid, with its quantity and its missing cells.

    Raises
    ------
    DataError
        If the values are not finite because a cell of the image is not.
    Degenerate
        If they are not because differences are too large for a number.
    """
    if isinstance(image, Image):
        if image.valid is not None:
            values[~image.valid] = 0.0
        if not np.isfinite(values).all():
            _refuse(image)
        return image.with_values(values)
    return Image(values, image.pitch_cm, image.origin_cm, "binary")


def _refuse(image: Image) -> None:
    bad = ~np.isfinite(image.values)
    if not bad.any():
        raise Degenerate("the image's values differ by more than a number can hold")
    row, column = np.argwhere(bad)[0].tolist()
    raise DataError(
        f"image, row {row}, column {column}",
        f"must be a number, got {image.values[row, column]}; a missing or broken cell must be"
        " marked invalid, with the value 0",
    )
