"""Step ``threshold_variable``: a level that rises with the recorded load per cell."""

from __future__ import annotations

from typing import Annotated

import numpy as np
from annotated_types import Ge, Gt, Lt
from numpy.typing import NDArray
from pydantic import AllowInfNan

from tactile_graph.errors import Degenerate
from tactile_graph.wires import Image
from tactile_graph_filters.nan import refuse_nan
from tactile_graph_filters.thresholds.threshold import footprint
from tactile_graph_filters.thresholds.thresholded import Thresholded

SMALLEST = 5e-324
"""The smallest number above 0."""


def threshold_variable(
    image: Image,
    *,
    fraction: Annotated[float, Gt(0), Lt(1)] = 0.1,
    floor: Annotated[float, Ge(0), AllowInfNan(False)] = 0.0,
) -> Thresholded:
    """Return the footprint above a fraction of the mean reading within that very footprint.

    Parameters
    ----------
    image : Image
    fraction : float
        Share of the mean reading that a cell of the footprint must reach.
    floor : float
        Lowest level allowed, in the image's unit: what an unloaded element may read.

    Returns
    -------
    Thresholded
        ``level`` is ``floor``, and the mask empty, where no reading is above 0 and ``floor``.

    Raises
    ------
    Degenerate
        If no cell is valid.
    DataError
        If a valid cell holds NaN or infinity.

    Notes
    -----
    Thesis section 4.1 asks for a level that varies with weight and area "in some predefined
    manner" and names none (it then finds a fixed 0.01 V good enough). The law here::

        level = max(floor, fraction * S / n)

    with S the sum and n the number of the readings that reach ``level``. S / n is load over
    area, and an element of which the object covers the share c reads about c S / n, so
    ``fraction`` is the least covered share of an element in the footprint: 0.5 would make the
    area of an evenly pressing object right, less keeps the weak cells of an uneven contact.

    The level is the lowest that fulfils the law: started at ``floor`` it can only rise, as it
    leaves out the smallest readings first, and it stops after at most n steps short of the
    largest reading. With 0.5 and an unloaded background at 0 it is the iteration of Ridler and
    Calvard (1978, 10.1109/TSMC.1978.4310039).
    """
    refuse_nan(image, infinite=True)
    values = image.values if image.valid is None else image.values[image.valid]
    if not values.size:
        raise Degenerate("no cell of the image is valid, so it has no load to go by")
    loads = np.sort(values[(values > 0) & (values >= floor)].astype(np.float64))
    if not loads.size:
        out = np.zeros(image.shape, np.bool_)
        return Thresholded(image.mask(out), floor)
    level = _lowest_level(loads, fraction, floor)
    return Thresholded(footprint(image, level), level)


def _lowest_level(loads: NDArray[np.float64], fraction: float, floor: float) -> float:
    """Return the lowest level = max(floor, fraction * mean of the loads that reach it)."""
    # Mean over the k-th load and all above it, for every k; scaled, so that no sum overflows.
    largest = float(loads[-1])
    floor = max(floor, SMALLEST)  # a level that underflows to 0 would turn on unloaded cells
    means = np.cumsum((loads / largest)[::-1])[::-1] / np.arange(loads.size, 0, -1)
    first = 0
    while True:
        level = max(floor, fraction * largest * float(means[first]))
        reached = int(np.searchsorted(loads, level))
        if reached <= first:
            return level
        first = min(reached, loads.size - 1)
