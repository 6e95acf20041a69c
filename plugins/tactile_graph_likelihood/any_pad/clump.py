"""What hangs together among a few touched elements, and what lies apart from it."""

from __future__ import annotations

import numpy as np

from tactile_graph_likelihood.geometry.pieces import components
from tactile_graph_likelihood.single.element_terms import UNKNOWN
from tactile_graph_likelihood.single.readings import Readings

NEAR = 2
"""Rows and columns that touched elements of one clump may lie apart: a void may be between them."""


def clump_of(readings: Readings) -> Readings | None:
    """Return the readings with all that is touched apart from the largest clump unknown.

    Parameters
    ----------
    readings : Readings

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
    labels = components.call(readings.shows, NEAR)
    counts = np.bincount(labels.ravel())[1:]
    if len(counts) < 2:
        return None
    apart = (labels > 0) & (labels != counts.argmax() + 1)
    return readings.with_states(np.where(apart, np.uint8(UNKNOWN), readings.states))
