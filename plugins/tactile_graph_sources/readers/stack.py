"""An array as a stack of matrices, by its axes and what the settings say."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from tactile_graph.errors import DataError
from tactile_graph_sources.readers.reading import Reading


def stack_of(reading: Reading, array: NDArray[Any], name: str) -> NDArray[Any]:
    """Return the array as matrices along its first axis, shape (N, rows, columns); a view.

    Parameters
    ----------
    reading : Reading
        Its settings ``rows`` and ``columns`` decide where the axes could be read two ways: an
        (N, rows x columns) array is N frames and a (rows, columns, N) one is turned.
    array : ndarray
        Numbers on 2 or 3 axes.
    name : str
        What messages call it.

    Raises
    ------
    DataError
        If it holds no numbers, no frame, or has other axes.
    """
    where = str(reading.path)
    if array.dtype.kind not in "buif":
        raise DataError(where, f"{name} holds {array.dtype}, not real numbers")
    rows, columns = reading.told.rows, reading.told.columns
    if rows is not None and columns is not None:
        if array.ndim == 2 and array.shape != (rows, columns) and array.shape[1] == rows * columns:
            array = array.reshape(-1, rows, columns)
        elif array.ndim == 3 and array.shape[:2] == (rows, columns) != array.shape[1:]:
            array = np.moveaxis(array, -1, 0)
    if array.ndim in (2, 3) and 0 in array.shape:
        raise DataError(where, f"{name} has shape {array.shape}: it holds no cell")
    if array.ndim not in (2, 3):
        raise DataError(
            where,
            f"{name} has shape {array.shape}; a matrix or matrices along the first axis are read",
        )
    array = array[None] if array.ndim == 2 else array
    reading.told.agree(where, array.shape[1], array.shape[2])
    return array
