"""Step ``valid_share``: how much of an image, or of what is touched, is known at all."""

from __future__ import annotations

from typing import Annotated, NamedTuple

import numpy as np

from tactile_graph.steps.rules import Grid, require_same_shape
from tactile_graph.wires import Image, Mask


class ValidShare(NamedTuple):
    """How many of so many cells are valid; ``share`` is 1 where there are none."""

    share: float
    valid: int
    cells: int


def valid_share(
    image: Image, mask: Annotated[Mask | None, Grid.like("image")] = None
) -> ValidShare:
    """Return the share of an image's cells, or of those in a mask, that are valid.

    For guards: of a frame, whether it is worth a look; of loads within the footprint, whether
    the pad's law knew what they are (beyond it they are invalid).

    Parameters
    ----------
    image : Image
    mask : Mask, optional
        The cells that count; all by default.

    Raises
    ------
    RuleError
        If image and mask differ in shape.
    """
    if mask is not None:
        require_same_shape(image=image, mask=mask)
    n = image.values.size if mask is None else mask.count
    if image.valid is None or n == 0:
        return ValidShare(1.0, n, n)
    counted = image.valid if mask is None else image.valid & mask.values
    valid = int(np.count_nonzero(counted))
    return ValidShare(valid / n, valid, n)
