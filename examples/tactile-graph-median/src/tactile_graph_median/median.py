"""Step ``median``: each cell replaced by the median of its window."""

from typing import Annotated

import numpy as np
from annotated_types import Ge
from numpy.lib.stride_tricks import sliding_window_view

from tactile_graph import Degenerate, Image
from tactile_graph.steps import Grid, Quantity


def median(
    image: Image, *, reach: Annotated[int, Ge(0)] = 1
) -> Annotated[Image, Quantity.like("image"), Grid.like("image")]:
    """Return the image with each valid cell replaced by the median of its window.

    Parameters
    ----------
    image : Image
        Readings; invalid cells count for nothing and stay invalid.
    reach : int
        Cells the window reaches to each side: it is ``2 * reach + 1`` wide. At the border the
        window ends with the pad.

    Returns
    -------
    Image
        On the same grid, in the same quantity.

    Raises
    ------
    Degenerate
        If a valid cell holds no number.
    """
    valid = np.ones(image.shape, dtype=bool) if image.valid is None else image.valid
    if not np.isfinite(image.values[valid]).all():
        raise Degenerate("a valid cell holds no finite number")
    # NaN stands for "no reading here" and sorts behind all readings.
    known = np.where(valid, image.values, np.nan)
    size = 2 * reach + 1
    windows = sliding_window_view(np.pad(known, reach, constant_values=np.nan), (size, size))
    ordered = np.sort(windows[valid].reshape(-1, size * size), axis=1)
    n = np.isfinite(ordered).sum(axis=1)  # at least 1: a window holds its own centre
    rows = np.arange(len(n))
    values = np.zeros(image.shape)
    # Halves are added: a sum of two huge readings would overflow.
    values[valid] = ordered[rows, (n - 1) // 2] / 2 + ordered[rows, n // 2] / 2
    return image.with_values(values)
