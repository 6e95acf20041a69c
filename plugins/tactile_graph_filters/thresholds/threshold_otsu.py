"""Step ``threshold_otsu``: the level that parts the grey levels into two classes best."""

from __future__ import annotations

import numpy as np

from tactile_graph.wires import Image
from tactile_graph_filters.thresholds.threshold import footprint
from tactile_graph_filters.thresholds.thresholded import Thresholded, grey_values


def threshold_otsu(image: Image) -> Thresholded:
    """Return the footprint above the level with the largest variance between the classes.

    Parameters
    ----------
    image : Image

    Returns
    -------
    Thresholded
        ``level`` is the smallest value of the upper class.

    Raises
    ------
    Degenerate
        If no cell is valid, or all valid cells hold the same value.
    DataError
        If a valid cell holds NaN or infinity.

    Notes
    -----
    Maximises n0 n1 (mean1 - mean0)^2 over every split of the sorted values, without bins (Otsu
    1979, 10.1109/TSMC.1979.4310076). Of two equally good splits it takes the lower.
    """
    values = np.sort(grey_values(image)).astype(np.float64)
    # Scaled to 0..1, so that squares of huge or tiny readings neither overflow nor vanish.
    low, high = float(values[0]), float(values[-1])
    scaled = values / 2.0 - low / 2.0
    scaled /= high / 2.0 - low / 2.0
    n_below = np.arange(1, values.size)
    sum_below = np.cumsum(scaled)[:-1]
    n_above = values.size - n_below
    means_apart = (float(scaled.sum()) - sum_below) / n_above - sum_below / n_below
    between = np.where(values[1:] > values[:-1], n_below * n_above * means_apart**2, -1.0)
    level = float(values[int(np.argmax(between)) + 1])
    return Thresholded(footprint(image, level), level)
