"""Numbers that stand for no reading, as ``-999`` and ``1e20`` do in the files of many programs."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

FILLS = (-999.0, -9999.0, -99999.0, -1e20, 1e20)
APART = 0.5
"""Share of a filling's size within which all readings lie: one among its like is a reading."""


def filling(values: NDArray[np.float64]) -> float | None:
    """Return the number that stands for no reading in a matrix; None where there is none.

    Parameters
    ----------
    values : ndarray
        Readings as they stand in the file.
    """
    low, high = float(values.min(initial=0.0)), float(values.max(initial=0.0))
    found = next((f for f in FILLS if f in (low, high)), None)
    if found is None:
        return None
    others: NDArray[Any] = values[values != found]
    apart = others.size > 0 and (
        others.min() > APART * found if found < 0.0 else others.max() < APART * found
    )
    return found if apart else None
