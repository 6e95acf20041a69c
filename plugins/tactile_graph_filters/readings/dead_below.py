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
FREE_SHARE = 0.25
"""Of the cells, which are taken to be untouched at least: so many are dead only beside readings
that rise above the others by more than these lie above them."""
LARGEST = 1e100
"""Reading, either way; what is beyond is none of a dead cell, but to be refused."""
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
    above. From a quarter on something must rise above these, or they are what is pressed.
    What bears a load beside cells that rest at that value has edges that are partly covered, and
    reads unevenly: its lower half is as wide as it is high.
    """
    values = image.values if image.valid is None else image.values[image.valid]
    if values.size < 2 * FEWEST:
        return None
    least = values.item(values.argmin())  # in a third of the time of `min`
    alike = values == least
    n = int(np.count_nonzero(alike))
    if n < FEWEST or n >= MOST_SHARE * values.size or not abs(float(least)) <= LARGEST:
        return None
    others = values[~alike].astype(np.float64)
    half = len(others) // 2
    others.partition((0, half))
    low, middle = float(others[0]), float(others[half])
    apart = low - float(least)
    if not 0.0 < APART * (middle - low) < apart:
        return None
    if n >= int(FREE_SHARE * values.size) and others.max() - middle <= apart:
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
