"""What pictures say beside their values: which side is up, how many dots lie on an inch."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from tactile_graph_sources.readers.reading import Reading

ORIENTATION = 274
"""The number of the tag, in TIFF and in the EXIF of other pictures."""
CM_OF_INCH = 2.54
PUT_BY_PROGRAMS = (1.0, 72.0, 96.0)
"""Dots an inch that stand in pictures of which nobody measured it."""


def upright(reading: Reading, picture: NDArray[Any], orientation: object) -> NDArray[Any]:
    """Return a picture, rows and columns first, as its orientation says it is to be seen; told."""
    if orientation not in range(2, 9):
        return picture
    reading.assume("pictures turned upright, as they say of themselves")
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
