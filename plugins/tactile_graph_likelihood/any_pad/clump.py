"""What hangs together among touched elements, and what lies apart from it."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from tactile_graph_likelihood.geometry.outlines import Values
from tactile_graph_likelihood.geometry.pieces import components
from tactile_graph_likelihood.single.element_terms import UNKNOWN
from tactile_graph_likelihood.single.readings import Readings

NEAR = 2
"""Rows and columns that touched elements of one clump may lie apart: a void may be between them."""

LONE = 0.4
"""Touched share of an element and its known neighbours below which that is a stray rather than an
object's."""


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
    return readings.without(apart)


def without_lone(readings: Readings) -> Readings | None:
    """Return the readings with touched elements whose neighbours are bare unknown.

    Parameters
    ----------
    readings : Readings

    Returns
    -------
    Readings or None
        None where no touched element is like that.

    Notes
    -----
    Strays are anywhere, and moments count what is far away most. Of an object nearly all neighbours
    are touched, too, even where four in ten of its elements read nothing.
    """
    shows, known = readings.shows, readings.states != UNKNOWN
    lone = shows & (_around(shows) < LONE * _around(known))
    if not lone.any():
        return None
    return readings.without(lone)


def _around(mask: NDArray[np.bool_]) -> Values:
    """Return how many of an element and its eight neighbours are in a mask."""
    wide = np.zeros((mask.shape[0] + 2, mask.shape[1] + 2))
    wide[1:-1, 1:-1] = mask
    rows = wide[:-2] + wide[1:-1] + wide[2:]
    found: Values = rows[:, :-2] + rows[:, 1:-1] + rows[:, 2:]
    return found
