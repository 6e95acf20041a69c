"""What hangs together among a few touched elements, and what lies apart from it."""

from __future__ import annotations

import numpy as np

from tactile_graph_likelihood.single.element_terms import ON, OVER, UNKNOWN
from tactile_graph_likelihood.single.readings import Readings

NEAR = 2
"""Rows and columns that touched elements of one clump may lie apart: a void may be between them."""


def clump_of(readings: Readings) -> Readings | None:
    """Return the readings with all that is touched apart from the largest clump unknown.

    Parameters
    ----------
    readings : Readings
        Of few touched elements: every pair is looked at.

    Returns
    -------
    Readings or None
        None where all that is touched hangs together.

    Notes
    -----
    The moments of a few elements cannot tell that some are strays: of n none is farther than
    (n - 1) / sqrt(n) deviations from the mean (P. A. Samuelson 1968, How deviant can you be?). The
    largest clump is that of the most elements: a single stray may read more than all of an object.
    """
    touched = np.argwhere((readings.states == ON) | (readings.states == OVER))
    close = (np.abs(touched[:, None] - touched[None]) <= NEAR).all(axis=2)
    names = np.arange(len(touched))
    while not np.array_equal(names, its := np.where(close, names, len(names)).min(axis=1)):
        names = its
    if not names.any():
        return None
    apart = touched[names != np.bincount(names).argmax()]
    states = readings.states.copy()
    states[tuple(apart.T)] = UNKNOWN
    return readings._replace(states=states, touched=len(touched) - len(apart))
