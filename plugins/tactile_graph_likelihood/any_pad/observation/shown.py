"""Loops from loads to what shows of them: what `observed` does once a frame's noise is known."""

from __future__ import annotations

import math
from typing import TypeAlias

import numpy as np
from numpy.typing import NDArray

from tactile_graph.compiled import compiled_later
from tactile_graph_likelihood.geometry.outlines import Values
from tactile_graph_likelihood.single.density.element_terms import ON, OVER, UNDER, UNKNOWN, States
from tactile_graph_pads.law import load_kernel

Cells: TypeAlias = NDArray[np.bool_]

SPACED = 4
"""Least readings by whose spacing the least load that shows is extrapolated."""

GAPS = 2.0
"""Mean spacings of the least readings by which what shows may lie below all of them."""

ALIKE, FEWEST_ALIKE, SHARE_ALIKE = 0.04, 5, 0.15
"""Span of the logarithm, and number, of readings that are so alike that they all read the most."""

BEYOND, SHARE_BEYOND = 3, 0.03
"""Readings beyond them that may be strays."""

LEAST = 1e-300
"""Load, in whatever unit, whose logarithm is taken for that of all below."""


@compiled_later
def loads_behind(
    above: Values, siemens: Values, valid: Cells, least: Values, law: Values
) -> tuple[bool, Values, Values, Cells]:
    """Return the loads behind volts whose conductances are found.

    Parameters
    ----------
    above : ndarray, shape (rows, columns)
        Volts, 0 where no more than noise.
    siemens : ndarray, shape (rows, columns)
    valid : ndarray of bool, shape (rows, columns)
        Where conductances could have given these volts.
    least : ndarray, shape (1, 1) or (rows, columns)
        Volts that a reading must exceed.
    law : ndarray
        As `ForceLaw.packed`.

    Returns
    -------
    believed : bool
        Whether most of the volts are those of the circuit.
    loads : ndarray, shape (rows, columns)
        In grams; infinite beyond what the law can reach.
    least_loads : ndarray, shape (1, columns) or (rows, columns)
        What each element would have shown as ``least``: a column's volts stand for as much as the
        most that shows in it, those of a bare column for as little as those of any.
    possible : ndarray of bool, shape (rows, columns)
    """
    rows, columns = above.shape
    trusted, ratio = np.zeros((rows, columns)), np.zeros(columns)
    n_shown = n_valid = 0
    for i in range(rows):
        for j in range(columns):
            volt = above[i, j]
            if valid[i, j]:
                trusted[i, j] = siemens[i, j]
            if volt > 0.0:
                n_shown += 1
                n_valid += valid[i, j]
                ratio[j] = max(ratio[j], trusted[i, j] / volt)
    lowest = np.inf
    for j in range(columns):
        if 0.0 < ratio[j] < lowest:
            lowest = ratio[j]
    from_s = np.empty((least.shape[0], columns))
    for i in range(least.shape[0]):
        for j in range(columns):
            per_volt = lowest if ratio[j] <= 0.0 < lowest < np.inf else ratio[j]
            from_s[i, j] = least[i, min(j, least.shape[1] - 1)] * per_volt
    loads, least_loads = load_kernel(trusted, law), load_kernel(from_s, law)
    possible = np.empty((rows, columns), np.bool_)
    for i in range(rows):
        for j in range(columns):
            possible[i, j] = valid[i, j] and loads[i, j] < np.inf
    return 2 * n_valid >= n_shown, loads, least_loads, possible


@compiled_later
def shown_loads(
    loads: Values, least_loads: Values, shows: Cells, known: Cells
) -> tuple[Values, Values]:
    """Return the loads that show, shape (N,), and the least ones, none of them below `LEAST`.

    Parameters
    ----------
    loads : ndarray, shape (rows, columns)
    least_loads : ndarray, shape (1, 1), (1, columns) or (rows, columns)
    shows : ndarray of bool, shape (rows, columns)
    known : ndarray of bool, shape (rows, columns)
        Elements that count; of shape (0, 0) if all do.
    """
    every, count = known.size == 0, 0
    (rows, columns), seen, floor = loads.shape, np.empty(loads.size), np.empty(least_loads.shape)
    for i in range(rows):
        for j in range(columns):
            if shows[i, j] and (every or known[i, j]):
                seen[count] = max(loads[i, j], LEAST)
                count += 1
    for i in range(least_loads.shape[0]):
        for j in range(least_loads.shape[1]):
            floor[i, j] = max(least_loads[i, j], LEAST)
    return seen[:count], floor


@compiled_later
def least_that_shows(ordered: Values, told: float) -> float:
    """Return the logarithm of the least load that shows, by the least readings and what is told.

    Parameters
    ----------
    ordered : ndarray, shape (N,)
        Logarithms of the readings, the least first.
    told : float
        Logarithm of the turn-on load, -inf where nothing is known of one.

    Notes
    -----
    A threshold lies below the least reading by about the mean spacing of the least few (D. S.
    Robson and J. H. Whitlock 1964, 10.1093/biomet/51.1-2.33). What is told is taken as far as it
    lies within twice that.
    """
    m = min(SPACED, ordered.shape[0] - 1)
    bottom = ordered[0]
    spacing = (ordered[m] - bottom) / m if m > 0 else 1.0
    if told == -np.inf:
        return float(bottom - spacing)
    return float(min(max(told, bottom - GAPS * spacing), bottom))


@compiled_later
def ceiling_of(ordered: Values) -> float:
    """Return the logarithm of the load at which readings end, infinite where they do not.

    They do where many are alike and hardly any are larger. ``ordered``, shape (N,), are logarithms
    of the readings, the least first.
    """
    n = ordered.shape[0]
    many = max(FEWEST_ALIKE, math.ceil(SHARE_ALIKE * n))
    if n < many:
        return math.inf
    at, width = 0, ordered[many - 1] - ordered[0]
    for i in range(1, n - many + 1):
        its = ordered[i + many - 1] - ordered[i]
        if its < width:
            at, width = i, its
    if width > ALIKE:
        return math.inf
    beyond, top = 0, ordered[at] + 2.0 * ALIKE
    while beyond < n and ordered[n - 1 - beyond] > top:
        beyond += 1
    ends = beyond <= BEYOND + SHARE_BEYOND * n
    return float(ordered[at]) - 0.5 * ALIKE if ends else math.inf


@compiled_later
def told_of_elements(
    seen: Values, ordered: Values, floor: Values, shows: Cells, known: Cells, told: float
) -> tuple[tuple[float, float], Values, States]:
    """Return where loads begin to show and end, and logarithms and states as `Readings` has them.

    Parameters
    ----------
    seen, ordered : ndarray, shape (N,)
        Logarithms of the loads that show: in order of the elements, and the least first.
    floor : ndarray, shape (1, 1), (1, columns) or (rows, columns)
        Logarithms of the least loads that would have shown.
    shows, known : ndarray of bool
        As of `shown_loads`.
    told : float
        As of `least_that_shows`.
    """
    edge, ceiling = least_that_shows(ordered, told), ceiling_of(ordered)
    (rows, columns), every, k = shows.shape, known.size == 0, 0
    logs, states = np.empty((rows, columns)), np.empty((rows, columns), np.uint8)
    last_row, last_column = floor.shape[0] - 1, floor.shape[1] - 1
    for i in range(rows):
        for j in range(columns):
            here = every or known[i, j]
            if here and shows[i, j]:
                log = seen[k]
                k += 1
                states[i, j] = OVER if log >= ceiling else ON
                logs[i, j] = min(log, ceiling)
            else:
                states[i, j] = UNDER if here else UNKNOWN
                logs[i, j] = max(floor[min(i, last_row), min(j, last_column)], edge)
    return (edge, ceiling), logs, states
