"""What the automatic thresholds give: the footprint and the level that made it."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from tactile_graph.errors import Degenerate
from tactile_graph.wires import Image, Mask
from tactile_graph_filters.nan import refuse_nan


class Thresholded(NamedTuple):
    """A footprint, and the level, in the image's unit, that its cells reach.

    A port that takes a mask takes it as it is.
    """

    mask: Mask
    level: float


# Set from outside: within a NamedTuple every name is a field.
Thresholded.provides = {Mask: "mask"}  # type: ignore[attr-defined]


def grey_values(image: Image) -> NDArray[Any]:
    """Return the values of the valid cells, shape (N,).

    Parameters
    ----------
    image : Image

    Returns
    -------
    ndarray

    Raises
    ------
    Degenerate
        If no cell is valid, or all valid cells hold the same value.
    DataError
        If a valid cell holds NaN or infinity.
    """
    refuse_nan(image, infinite=True)
    values = image.values.ravel() if image.valid is None else image.values[image.valid]
    if not values.size:
        raise Degenerate("no cell of the image is valid, so it has no grey levels to choose from")
    if values.min() == values.max():
        raise Degenerate(
            f"every valid cell holds {float(values[0]):g}:"
            " one grey level cannot be parted into object and background"
        )
    return np.asarray(values)
