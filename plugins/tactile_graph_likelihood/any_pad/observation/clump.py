"""What hangs together among touched elements, and what lies apart from it."""

from __future__ import annotations

import numpy as np

from tactile_graph.compiled import compiled_later
from tactile_graph_likelihood.geometry.pieces import components
from tactile_graph_likelihood.single.density.element_terms import ON, OVER, UNKNOWN, States
from tactile_graph_likelihood.single.readings import Readings

NEAR = 2
"""Rows and columns that touched elements of one clump may lie apart: a void may be between them."""

ALONE = 0.26
"""As `LONE`, of an element with at most one touched neighbour of eight, none in a corner."""

LEFT = 1.5
"""Touched elements over those that do not stand alone, up to which the others may be strays."""

PIECE, PIECE_SHARE = 6, 0.2
"""Touched elements of a second clump, at least, and their share of all, for it to be a part or an
object of its own: of 9120 discs and as many rectangles on 95 kinds of pads a ring was in two."""

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


def is_in_parts(readings: Readings) -> bool:
    """Return whether what is touched lies in parts, farther apart than a void explains."""
    if readings.touched < 2 * PIECE:
        return False
    most = max(PIECE, PIECE_SHARE * readings.touched)
    return beside_largest.call(readings.states) >= most


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
    return _without(readings, LONE)


def without_alone(readings: Readings) -> Readings | None:
    """Return the readings with touched elements unknown of which at most one neighbour is touched.

    Parameters
    ----------
    readings : Readings

    Returns
    -------
    Readings or None
        None where none of them lies away from the others, or they are too many for strays.
    """
    some = _without(readings, ALONE)
    if some is None or LEFT * some.touched < readings.touched:
        return None
    return some if away.call(readings.states, some.states) else None


def _without(readings: Readings, share: float) -> Readings | None:
    states = readings.states.copy()
    lone = unknown_if_lone.call(readings.states, share, states)
    return readings._replace(states=states, touched=readings.touched - lone) if lone else None


@compiled_later
def beside_largest(states: States) -> int:
    """Return how many elements the second largest clump of touched ones has."""
    shows = np.zeros(states.shape, np.bool_)
    for i in range(states.shape[0]):
        for j in range(states.shape[1]):
            shows[i, j] = states[i, j] in (ON, OVER)
    labels = components(shows, NEAR)
    counts = np.zeros(labels.max() + 1, np.int64)
    for i in range(states.shape[0]):
        for j in range(states.shape[1]):
            counts[labels[i, j]] += shows[i, j]
    largest = second = 0
    for k in range(1, counts.shape[0]):
        if counts[k] > largest:
            largest, second = counts[k], largest
        elif counts[k] > second:
            second = counts[k]
    return second


@compiled_later
def away(states: States, without: States) -> bool:
    """Return whether a touched element that is left out lies away from the box of the others.

    Between the two there is a row or column at least.
    """
    rows, columns = states.shape
    top, left, bottom, right = rows, columns, -1, -1
    for i in range(rows):
        for j in range(columns):
            if without[i, j] == ON or without[i, j] == OVER:
                top, bottom = min(top, i), max(bottom, i)
                left, right = min(left, j), max(right, j)
    for i in range(rows):
        for j in range(columns):
            if without[i, j] != UNKNOWN or (states[i, j] != ON and states[i, j] != OVER):
                continue
            if i < top - 1 or i > bottom + 1 or j < left - 1 or j > right + 1:
                return True
    return False


@compiled_later
def unknown_if_lone(states: States, share: float, without: States) -> int:
    """Write in another array that touched elements are unknown which stand alone.

    Parameters
    ----------
    states : ndarray, shape (R, C)
    share : float
        As `LONE`.
    without : ndarray, shape (R, C)
        As ``states`` before.

    Returns
    -------
    int
        How many stand alone.
    """
    rows, columns = states.shape
    count = 0
    for i in range(rows):
        for j in range(columns):
            if states[i, j] != ON and states[i, j] != OVER:
                continue
            shows = known = 0
            for k in range(max(i - 1, 0), min(i + 2, rows)):
                for m in range(max(j - 1, 0), min(j + 2, columns)):
                    its = states[k, m]
                    known += its != UNKNOWN
                    shows += its in (ON, OVER)
            if shows < share * known:
                without[i, j] = UNKNOWN
                count += 1
    return count
