"""Step ``mask``: the listed broken elements made invalid."""

from __future__ import annotations

from typing import Annotated

import numpy as np
from annotated_types import Ge

from tactile_graph.errors import DataError
from tactile_graph.steps.rules import Grid, Quantity
from tactile_graph.wires import Image
from tactile_graph_filters.nan import require_finite

Index = Annotated[int, Ge(0)]


def mask(
    image: Image,
    *,
    cells: tuple[tuple[Index, Index], ...] = (),
    rows: tuple[Index, ...] = (),
    columns: tuple[Index, ...] = (),
) -> Annotated[Image, Quantity.like("image"), Grid.like("image")]:
    """Return the image with the listed elements invalid; `inpaint` can fill them.

    Parameters
    ----------
    image : Image
    cells : tuple of (int, int)
        Broken elements as (row, column), from 0.
    rows, columns : tuple of int
        Broken lines, from 0.

    Returns
    -------
    Image

    Raises
    ------
    DataError
        If a listed element is not on the image, or one that stays valid holds NaN or infinity.
    """
    valid = np.ones(image.shape, np.bool_) if image.valid is None else image.valid.copy()
    n_rows, n_columns = image.shape
    for row, column in [*cells, *((row, 0) for row in rows), *((0, column) for column in columns)]:
        if row >= n_rows or column >= n_columns:
            raise DataError(
                "mask",
                f"row {row}, column {column} is not on an image of {n_rows} x {n_columns},"
                " counted from 0",
            )
    for row, column in cells:
        valid[row, column] = False
    valid[list(rows), :] = False
    valid[:, list(columns)] = False
    masked = image.with_values(np.where(valid, image.values, 0.0), valid=valid)
    require_finite(masked)
    return masked
