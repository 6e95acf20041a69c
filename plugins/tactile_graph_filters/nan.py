"""Find NaN and infinity in an image, and refuse it naming the cell."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from tactile_graph.compiled import compiled_twin_of
from tactile_graph.errors import DataError
from tactile_graph.wires import Image


def _all_finite_plain(values: NDArray[Any]) -> bool:
    """Return whether no value is NaN or infinite."""
    return bool(np.isfinite(values).all())


@compiled_twin_of(_all_finite_plain)
def all_finite(values):  # type: ignore[no-untyped-def]
    """Return whether no value is NaN or infinite."""
    bad = 0
    for i in range(values.shape[0]):
        row = values[i]
        for j in range(values.shape[1]):
            bad += row[j] - row[j] != 0  # NaN for NaN and infinity
    return bad == 0


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
