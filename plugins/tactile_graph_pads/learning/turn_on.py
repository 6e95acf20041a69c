"""The least reading that shows: where the distribution of readings under objects begins."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from tactile_graph_pads.learned import Reading, TurnOn

Array = NDArray[np.float64]
WIDTH = 1.2
"""Readings are counted within this factor above and below a candidate."""
LEAST_READINGS = 60
LEAST_CONTRAST = 6.0
"""Standard deviations by which the two counts must differ."""
LEAST_RATIO = 5.0
LEAST_ROOM = 0.5
"""Of that factor's logarithm, between a candidate and the noise; what is missing is made up for."""


def turn_on_of(readings: Array, shows_from: float, of: Reading) -> TurnOn | None:
    """Return where readings under objects begin; None where they begin in the noise, or slowly.

    Parameters
    ----------
    readings : ndarray, shape (n,)
        Of elements under objects, without offset.
    shows_from : float
        Readings below are noise, and tell nothing.
    of : str
        Their quantity.

    Notes
    -----
    With a the number of readings from x up to 1.2 x and b that from x / 1.2 up to x, chosen is
    the x of the largest (a - b) / sqrt(a + b) with a > 5 b. An element that turns on suddenly
    leaves a gap below; one that comes on slowly leaves none, and then nothing is said.
    """
    logs = np.sort(np.log(readings[readings > shows_from]))
    if len(logs) < LEAST_READINGS:
        return None
    width = np.log(WIDTH)
    lower = logs[logs > np.log(shows_from) + LEAST_ROOM * width]
    above = np.searchsorted(logs, lower + width) - np.searchsorted(logs, lower)
    room = np.minimum(width, lower - np.log(shows_from))
    below = (np.searchsorted(logs, lower) - np.searchsorted(logs, lower - room)) * width / room
    contrast = np.where(
        above > LEAST_RATIO * below, (above - below) / np.sqrt(np.maximum(above + below, 1)), 0.0
    )
    if not len(contrast) or contrast.max() < LEAST_CONTRAST:
        return None
    k = int(contrast.argmax())
    return TurnOn(float(np.exp(lower[k])), of, float(contrast[k]))
