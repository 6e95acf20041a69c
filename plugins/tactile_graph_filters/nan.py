"""Refuse an image whose valid cells hold NaN or infinity, naming the cell."""

from __future__ import annotations

import numpy as np

from tactile_graph.errors import DataError
from tactile_graph.wires import Image


def refuse_nan(image: Image, *, infinite: bool = False) -> None:
    """Raise if a valid cell holds NaN.

    Parameters
    ----------
    image : Image
    infinite : bool
        Whether infinity is refused as well.

    Raises
    ------
    DataError
        Naming row and column (from 0) of the first such cell, and how many there are.
    """
    bad = ~np.isfinite(image.values) if infinite else np.isnan(image.values)
    if image.valid is not None:
        bad &= image.valid
    n_bad = int(np.count_nonzero(bad))
    if n_bad:
        row, column = np.argwhere(bad)[0].tolist()
        others = f" (and {n_bad - 1} more cells)" if n_bad > 1 else ""
        raise DataError(
            f"image, row {row}, column {column}",
            f"must be a number, got {image.values[row, column]}{others};"
            " a missing or broken cell must be marked invalid",
        )
