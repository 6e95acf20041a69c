"""What pictures say beside their values: how large they are, which side is up, dots an inch."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

import numpy as np
from numpy.typing import NDArray

from tactile_graph.errors import DataError
from tactile_graph_sources.readers.reading import Reading

ORIENTATION = 274
"""The number of the tag, in TIFF and in the EXIF of other pictures."""
CM_OF_INCH = 2.54
PUT_BY_PROGRAMS = (1.0, 72.0, 96.0)
"""Dots an inch that stand in pictures of which nobody measured it."""

MOST_PIXELS = 4_000_000
MOST_TIMES = 200
"""Pixels for each byte of a file of many pages."""


def refuse_large(
    where: str, sides: Iterable[tuple[int, int]], n_values: int = 0, n_bytes: int = 1
) -> None:
    """Refuse a picture by what it says of its size, before it is unpacked.

    Parameters
    ----------
    where : str
    sides : iterable of (int, int)
        Rows and columns of its pages.
    n_values, n_bytes : int
        Those of all pages, and of the file that holds them.

    Raises
    ------
    DataError
        If a page is too large, or the file unpacks to far more than it holds.
    """
    for rows, columns in sides:
        if rows * columns > MOST_PIXELS:
            raise DataError(where, f"the picture has {rows} x {columns} pixels")
    if n_values > max(MOST_PIXELS, MOST_TIMES * n_bytes):
        raise DataError(
            where,
            f"its pages hold {n_values} pixels, {n_values // n_bytes} for each byte; allowed "
            f"are {MOST_TIMES} beyond {MOST_PIXELS}",
        )


def upright(reading: Reading, picture: NDArray[Any], orientation: object) -> NDArray[Any]:
    """Return a picture, rows and columns first, as its orientation says it is to be seen; told."""
    if orientation not in range(2, 9):
        return picture
    reading.heed("pictures turned upright, as they say of themselves")
    if orientation in (5, 6, 7, 8):
        picture = np.swapaxes(picture, 0, 1)
    if orientation in (3, 4, 7, 8):
        picture = picture[::-1]
    return picture[:, ::-1] if orientation in (2, 3, 6, 7) else picture


def tell_resolution(reading: Reading, dots: tuple[float, float], inches: float) -> None:
    """Tell the pitch that a picture's resolution would be, which is a scanner's or means nothing.

    Parameters
    ----------
    reading : Reading
    dots : tuple of float
        Those on each unit of length, along x and y.
    inches : float
        How long the unit is.
    """
    x, y = (float(n) / inches for n in dots)
    if reading.told.pitch_cm is not None or reading.told.pads or not (0 < x < 1e6 and 0 < y < 1e6):
        return
    if all(min(abs(n - usual) for usual in PUT_BY_PROGRAMS) < 0.5 for n in (x, y)):
        return
    pitch = f"{CM_OF_INCH / x:.4g}" if x == y else f"[{CM_OF_INCH / x:.4g},{CM_OF_INCH / y:.4g}]"
    reading.assume(
        f"{x:.4g} x {y:.4g} dots an inch, as the picture says: give pitch_cm={pitch} if it was "
        "scanned so"
    )
