"""Cells that read the same far below all others: dead ones, on a pad that rests above their end."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from tactile_graph.wires import Image

FEWEST = 2
"""One such cell changes nothing that is told by many."""
MOST_SHARE = 0.3
"""Of the cells; where so many read the same, they are those that nothing touches, beside something
large that presses evenly: one frame cannot tell the two apart."""
APART = 2.0
"""Widths of the lower half of all other readings, by which all lie above."""


def dead_below(image: Image) -> NDArray[np.bool_] | None:
    """Return which valid cells are dead far below the others, shape (rows, columns).

    Parameters
    ----------
    image : Image

    Returns
    -------
    ndarray of bool or None
        None where there are none.

    Notes
    -----
    Some cells, fewer than three in ten, read exactly the same least value; of the others the lower
    half, taken to be untouched, lies closely together but not all at one value, and all of it far
    above.
    What bears a load beside cells that rest at that value has edges that are partly covered, and
    reads unevenly: its lower half is as wide as it is high.
    """
    values = image.values if image.valid is None else image.values[image.valid]
    if values.size < 2 * FEWEST:
        return None
    least = np.minimum.reduce(values, axis=None)  # as `min` does, without its detour
    alike = values == least
    n = int(np.count_nonzero(alike))
    if n < FEWEST or n >= MOST_SHARE * values.size:
        return None
    others = values[~alike].astype(np.float64)
    half = len(others) // 2
    others.partition((0, half))
    low, middle = float(others[0]), float(others[half])
    if not 0.0 < APART * (middle - low) < low - float(least):
        return None
    found = np.asarray(image.values == least)
    return found if image.valid is None else found & image.valid


def without_dead(image: Image) -> Image:
    """Return an image in which the cells of `dead_below` are invalid; the same where none is."""
    dead = dead_below(image)
    if dead is None:
        return image
    valid = ~dead if image.valid is None else image.valid & ~dead
    return image.with_values(np.where(valid, image.values, 0), valid=valid)
