"""Step ``subdivide_image``: each cell of an image cut into N x N cells that inherit its value."""

from __future__ import annotations

from typing import Annotated

import numpy as np
from annotated_types import Ge, Le

from tactile_graph.steps.rules import Grid, Quantity
from tactile_graph.wires import Image
from tactile_graph_filters.morphology.subdivide import expand
from tactile_graph_filters.nan import require_finite


def subdivide_image(
    image: Image, *, factor: Annotated[int, Ge(1), Le(64)] = 2
) -> Annotated[Image, Grid.like("image", finer_by="factor"), Quantity.like("image")]:
    """Return the image with each cell cut into factor x factor cells that inherit its value.

    Parameters
    ----------
    image : Image
    factor : int
        Into how many cells a side each cell is cut.

    Returns
    -------
    Image
        On a grid of a ``factor`` finer pitch with the same origin. What is a sum over cells
        (the load) becomes factor x factor times as large: each part repeats the whole reading.

    Raises
    ------
    DataError
        If a valid cell holds NaN or infinity.

    Notes
    -----
    Thesis section 4.2.5, figure 4.13.
    """
    require_finite(image)
    if factor == 1:
        return image
    rows, columns = image.shape
    shape = (rows * factor, columns * factor)
    out = np.empty(shape, image.values.dtype)
    expand(image.values, factor, out)
    valid = None
    if image.valid is not None:
        valid = np.empty(shape, np.bool_)
        expand(image.valid, factor, valid)
    x, y = image.pitch_cm
    return Image(out, (x / factor, y / factor), image.origin_cm, image.quantity, valid)
