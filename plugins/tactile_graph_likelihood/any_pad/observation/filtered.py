"""Whether an image was smoothed, median-filtered or enlarged before: neighbours share readings."""

from __future__ import annotations

import math

import numpy as np

from tactile_graph.compiled import compiled_later
from tactile_graph_likelihood.any_pad.observation.shown import Cells
from tactile_graph_likelihood.geometry.outlines import Values
from tactile_graph_likelihood.single.density.element_terms import ON, OVER, UNDER, States

FEWEST = 8
"""Places at which noise is compared, and pairs of touched elements, that tell anything."""

ALONG = 0.85
"""Share of the variance of differences far apart that neighbours' must be below, along both
axes: noise of a row or of a column that hangs together is no filter's."""

SURE = 7.0
"""Logarithm of the variance of differences over that of neighbours', times the root of the number
of places, from which on a filter made the noise; independent noise came to 6 in 10,000 frames."""

COPIES = 1.0
"""Pairs of neighbours that read the same, beyond those by chance and by a converter's steps, over
the root of the pairs, from which on they are copies; of elements of their own at most 0.7."""

APART = 3
"""Elements between which no filter of three elements copies."""


@compiled_later
def untouched(states: States) -> Cells:
    """Return which elements are, and all beside them are no touched ones."""
    rows, columns = states.shape
    free: Cells = states == UNDER
    for i in range(rows):
        for j in range(columns):
            if states[i, j] == ON or states[i, j] == OVER:
                free[max(i - 1, 0) : i + 2, max(j - 1, 0) : j + 2] = False
    return free


@compiled_later
def differing(off: Values, free: Cells, down: int, right: int) -> tuple[float, int]:
    """Return the mean square of differences of differences, and at how many places they are.

    Those are of two rows and two columns so far apart, where all four elements are ``free``.
    """
    rows, columns = off.shape
    total, count, places = 0.0, 0, 0
    for i in range(rows - down):
        for j in range(columns - right):
            k, m = i + down, j + right
            if free[i, j] and free[k, j] and free[i, m] and free[k, m]:
                between = off[k, m] - off[k, j] - off[i, m] + off[i, j]
                total += between * between
                count += 1
                places += between != 0.0
    return total / max(count, 1), places


@compiled_later
def has_shared_noise(values: Values, states: States, zero: float, least: float) -> bool:
    """Return whether noise of untouched neighbours is alike along both axes.

    Parameters
    ----------
    values : ndarray, shape (rows, columns)
        As they were read.
    states : ndarray of uint8, the same shape
    zero, least : float
        What untouched elements read, and what a reading must rise above that.

    Notes
    -----
    Compared are differences of differences, between two rows and two columns that lie side by side
    or one apart: zeros that drift along the rows, along the columns, or both, cancel in them.
    """
    rows, columns = states.shape
    off, free = np.zeros((rows, columns)), untouched(states)
    for i in range(rows):
        for j in range(columns):
            if free[i, j]:
                off[i, j] = min(max(values[i, j] - zero, -least), least)
    apart, places = differing(off, free, 2, 2)
    if places < FEWEST:
        return False
    beside = differing(off, free, 1, 1)[0]
    if beside > 0.0 and math.log(apart / beside) * math.sqrt(places) <= SURE:
        return False
    for down, right in ((1, 2), (2, 1)):
        if differing(off, free, down, right)[0] >= ALONG * apart:
            return False
    return True


@compiled_later
def counted(ranks: Values, apart: int) -> tuple[int, int, int]:
    """Return how many pairs of elements there are so far apart, alike, and one rank apart.

    ``ranks``, shape (rows, columns), are -1 where an element is not touched.
    """
    rows, columns = ranks.shape
    n = same = nearly = 0
    for i in range(rows):
        for j in range(columns):
            if ranks[i, j] < 0.0:
                continue
            for k, m in ((i + apart, j), (i, j + apart)):
                if k < rows and m < columns and ranks[k, m] >= 0.0:
                    far = abs(ranks[k, m] - ranks[i, j])
                    n += 1
                    same += far == 0.0
                    nearly += far == 1.0
    return n, same, nearly


@compiled_later
def has_copies(values: Values, states: States) -> bool:
    """Return whether touched neighbours read exactly the same, more than steps make them.

    Parameters
    ----------
    values, states : ndarray, shape (rows, columns)
        As of `has_shared_noise`.

    Notes
    -----
    Of a converter's steps as many pairs are one step apart, and elements far apart as often alike.
    """
    rows, columns = states.shape
    ranks, seen, count = np.full((rows, columns), -1.0), np.empty(states.size), 0
    for i in range(rows):
        for j in range(columns):
            if states[i, j] == ON:
                seen[count] = values[i, j]
                count += 1
    ordered = np.sort(seen[:count])
    kinds = 0
    for k in range(count):
        if k == 0 or ordered[k] != ordered[kinds - 1]:
            ordered[kinds] = ordered[k]
            kinds += 1
    if kinds == count:
        return False
    for i in range(rows):
        for j in range(columns):
            if states[i, j] == ON:
                ranks[i, j] = np.searchsorted(ordered[:kinds], values[i, j])
    n, same, nearly = counted(ranks, 1)
    if n < FEWEST:
        return False
    far, alike, _ = counted(ranks, APART)
    by_chance = alike / far if far > 0 else 0.0
    return bool(same - 0.5 * nearly - n * by_chance > COPIES * math.sqrt(n))


@compiled_later
def is_filtered(values: Values, states: States, zero: float, least: float) -> bool:
    """Return whether readings are not each their own; arguments as of `has_shared_noise`."""
    return has_copies(values, states) or has_shared_noise(values, states, zero, least)
