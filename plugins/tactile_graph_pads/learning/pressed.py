"""Elements that are pressed in most frames, on a pad that reads no less than it rests at."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
Flags = NDArray[np.bool_]
AT_REST = 0.1
"""Share of the frames in which such an element reads what the others rest at."""
FAR = 3.0
"""Steps, or spreads of the noise above rest, by which its median lies above it."""
TOGETHER = 0.5
"""Share of the frames in which it is pressed that press a neighbour, too; a loose contact has
none."""


def often_pressed(values: Array, offset: Array, missing: Flags, step: float) -> tuple[Flags, float]:
    """Return which elements' medians are of what presses them, and what they read at rest.

    Parameters
    ----------
    values : ndarray, shape (frames, rows, columns)
    offset : ndarray, shape (rows, columns)
        Medians over the frames.
    missing : ndarray of bool, shape (rows, columns)
    step : float
        Smallest difference of readings, 0 where they are continuous.

    Returns
    -------
    (ndarray of bool, float)

    Notes
    -----
    The median element must read the least of all, exactly, in half of the frames or more; others
    that often read the same rest there. Noise that is cut off is told, in the lower half of the
    frames, by what rises.
    """
    from scipy import ndimage

    rest = float(np.median(offset[~missing]))
    nothing = np.zeros_like(missing)
    if np.nanmin(values[:, ~missing]) < rest:
        return nothing, rest
    empty = np.isnan(values).all(axis=(1, 2))
    values = values[~empty] if empty.any() else values  # or they were the lowest
    total = np.nansum(values, axis=(1, 2))
    lower = values[np.argsort(total, kind="stable")[: (len(total) + 1) // 2]][:, ~missing]
    lower = lower[:, ~np.isnan(lower).all(axis=0)]
    rise = float(np.nanmedian(np.nanquantile(lower, 0.84, axis=0))) - rest
    far = rest + max(FAR * rise, FAR * step)
    found = ~missing & (offset > far) & ((values == rest).mean(axis=0) >= AT_REST)
    if not found.any():
        return nothing, rest
    around = np.ones((1, 3, 3))
    around[0, 1, 1] = 0.0
    high = (values > far) & ~missing
    beside = ndimage.correlate(high.astype(np.float32), around, mode="constant") > 0.0
    together = (high & beside).sum(axis=0) >= TOGETHER * high.sum(axis=0)
    return found & together, rest
