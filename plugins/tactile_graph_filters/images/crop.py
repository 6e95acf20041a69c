"""Step ``crop``: an image and its mask cut down to the contact."""

from __future__ import annotations

from typing import Annotated, NamedTuple

import numpy as np
from annotated_types import Ge

from tactile_graph.errors import Degenerate
from tactile_graph.steps.rules import Grid
from tactile_graph.wires import Image, Mask
from tactile_graph_filters.nan import require_finite

Box = tuple[int, int, int, int]
"""First row, row after the last, first column, column after the last."""


class Cropped(NamedTuple):
    """Image and mask cut down to the contact; ports that take one of them take it as it is."""

    image: Image
    mask: Mask


# Set from outside: within a NamedTuple every name is a field.
Cropped.provides = {Image: "image", Mask: "mask"}  # type: ignore[attr-defined]


def bounding_box(mask: Mask) -> Box | None:
    """Return the smallest box that holds all cells that are on; None where none is.

    Parameters
    ----------
    mask : Mask

    Returns
    -------
    tuple of int, or None
    """
    rows, columns = np.flatnonzero(mask.values.any(axis=1)), np.flatnonzero(mask.values.any(axis=0))
    if not rows.size:
        return None
    return int(rows[0]), int(rows[-1]) + 1, int(columns[0]), int(columns[-1]) + 1


def widened(box: Box, margin: int, shape: tuple[int, int]) -> Box:
    """Return the box with ``margin`` more cells on each side, as far as the image goes.

    Parameters
    ----------
    box : tuple of int
    margin : int
    shape : (int, int)
        Rows and columns of the image.

    Returns
    -------
    tuple of int
    """
    top, bottom, left, right = box
    rows, columns = shape
    return (
        max(0, top - margin),
        min(rows, bottom + margin),
        max(0, left - margin),
        min(columns, right + margin),
    )


def origin_of(box: Box, image: Image | Mask) -> tuple[float, float]:
    """Return the top left corner of the box on the pad, in cm.

    Parameters
    ----------
    box : tuple of int
    image : Image or Mask
        What the box is counted in.

    Returns
    -------
    (float, float)
    """
    (x, y), (pitch_x, pitch_y) = image.origin_cm, image.pitch_cm
    return x + box[2] * pitch_x, y + box[0] * pitch_y


def cut_image(image: Image, box: Box) -> Image:
    """Return the part of the image in the box, where it was on the pad.

    Parameters
    ----------
    image : Image
    box : tuple of int

    Returns
    -------
    Image
    """
    cut = np.s_[box[0] : box[1], box[2] : box[3]]
    valid = None if image.valid is None else image.valid[cut].copy()
    origin = origin_of(box, image)
    return Image(image.values[cut].copy(), image.pitch_cm, origin, image.quantity, valid)


def cut_mask(mask: Mask, box: Box) -> Mask:
    """Return the part of the mask in the box, where it was on the pad.

    Parameters
    ----------
    mask : Mask
    box : tuple of int

    Returns
    -------
    Mask
    """
    values = mask.values[box[0] : box[1], box[2] : box[3]].copy()
    return Mask(values, mask.pitch_cm, origin_of(box, mask))


def crop(
    image: Image,
    mask: Annotated[Mask, Grid.like("image")],
    *,
    margin: Annotated[int, Ge(0)] = 1,
) -> Cropped:
    """Return image and mask cut down to the cells that are on, in their place on the pad.

    Parameters
    ----------
    image : Image
    mask : Mask
        On the same grid.
    margin : int
        How many more cells to keep on each side, as far as the image goes.

    Returns
    -------
    Cropped

    Raises
    ------
    Degenerate
        If no cell is on.
    DataError
        If a valid cell holds NaN or infinity.
    """
    require_finite(image)
    box = bounding_box(mask)
    if box is None:
        raise Degenerate("no cell of the mask is on, so there is no contact to crop to")
    box = widened(box, margin, mask.shape)
    return Cropped(cut_image(image, box), cut_mask(mask, box))
