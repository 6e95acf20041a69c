"""Annealing schedules: the temperature of each sweep."""

from __future__ import annotations

from typing import Literal

import numpy as np
from numpy.typing import NDArray

Schedule = Literal["geometric", "logarithmic", "linear"]


def temperatures(
    kind: Schedule, first: float, cooling: float, n_sweeps: int
) -> NDArray[np.float64]:
    """Return the temperature of each sweep, falling from ``first``, shape (n_sweeps,).

    Parameters
    ----------
    kind : str
        ``geometric``: T <- cooling T, as in section 5.2.3; ``logarithmic``: first log 2 /
        log(1 + k), for which Geman and Geman (1984, theorem B) prove convergence if ``first``
        is high enough; ``linear``: even steps to 0, which the last sweep is the first not to reach.
    first : float
    cooling : float
        For ``geometric`` only.
    n_sweeps : int

    Returns
    -------
    ndarray of float64
    """
    k = np.arange(n_sweeps, dtype=np.float64)
    if kind == "geometric":
        # Below this the sweeps are at temperature 0 to the last bit, and 1 / T stays finite.
        return np.maximum(first * cooling**k, 1e-200)
    if kind == "logarithmic":
        return np.asarray(first * np.log(2.0) / np.log(2.0 + k))
    return np.asarray(first * (1.0 - k / n_sweeps))
