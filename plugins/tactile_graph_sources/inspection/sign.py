"""Whether readings look like signed numbers that were written without their sign."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

ONE_ROUND = 65536
FEWEST_LEVELS = 3
"""Different readings near the upper end; one or two are where a converter ends."""


def sign_is_lost(values: NDArray[np.float64], step: float | None, highest: float) -> bool:
    """Return whether readings lie at both ends of 16 bits and none between, as -1 is 65535.

    Parameters
    ----------
    values : ndarray
    step : float or None
        The smallest difference of two readings, where all are whole multiples of it.
    highest : float
    """
    quarter = ONE_ROUND / 4
    if step is None or step % 1.0 or not ONE_ROUND - quarter / 4 < highest < ONE_ROUND:
        return False
    above = values >= ONE_ROUND - quarter
    if above.all() or values.min() < 0.0 or ((values >= quarter) & ~above).any():
        return False
    return len(np.unique(values[above])) >= FEWEST_LEVELS
