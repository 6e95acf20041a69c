"""Loads that bring about readings through foam of a width, none below zero; the widest that can."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from tactile_graph.compiled import compiled_as_is
from tactile_graph_likelihood.any_pad.pad_effects.spread_loads import shares_of, spread, unspread
from tactile_graph_likelihood.geometry.outlines import Values
from tactile_graph_likelihood.single.density.element_terms import ON, OVER, UNDER, States

FIRST, MOST = 0.4, 0.7
"""Widths of foam, in cells, that are looked for; of less a bare pad's readings may be, too."""

WIDER, HALVINGS = 1.2, 4
"""Factor from one width that is tried to the next, and halvings of what lies between the last."""

BELOW_ZERO = 0.01
"""Loads below zero, root mean square over the mean reading, that are put down to noise."""

FILLED = 2
"""Times that what does not show is filled in."""

ENCLOSED, FEWEST = 6, 3
"""Neighbours that show around an element, for it to lie within what is touched; elements that must
lie there for a width to be told."""

ROUNDS, ENOUGH = 100, 1e-3
"""Steps towards the loads, and the change, over the largest reading, below which they end."""


@compiled_as_is
def widest(loads: Values, states: States, first: float) -> float:
    """Return the width of foam, in cells, that leaves loads within what is touched positive.

    0 where that is less than ``first``, infinite where nothing lies within.
    """
    rows, cols = loads.shape
    counted, n, mean = np.zeros((rows, cols), np.bool_), 0, 0.0
    for i in range(1, rows - 1):
        for j in range(1, cols - 1):
            its, around = states[i, j], 0
            if its not in (ON, UNDER):
                continue
            for r in range(i - 1, i + 2):
                for c in range(j - 1, j + 2):
                    around += states[r, c] in (ON, OVER) and (r != i or c != j)
            if around >= ENCLOSED:
                counted[i, j] = True
                n += 1
                mean += loads[i, j]
    if n < FEWEST:
        return math.inf
    allowed = n * (BELOW_ZERO * mean / n) ** 2
    least, most = 0.0, first
    while below_zero(loads, states, counted, most) <= allowed:
        least = most
        if least >= MOST:
            return least
        most = min(WIDER * most, MOST)
    for _ in range(HALVINGS if least > 0.0 else 0):
        middle = 0.5 * (least + most)
        if below_zero(loads, states, counted, middle) <= allowed:
            least = middle
        else:
            most = middle
    return least


@compiled_as_is
def below_zero(
    loads: Values, states: States, counted: NDArray[np.bool_], width: float
) -> float:  # fmt: skip
    """Return the sum of squares of those loads, without foam of a width, that are below zero."""
    found, total = pressed_by(loads, states, shares_of(width)), 0.0
    for i in range(loads.shape[0]):
        for j in range(loads.shape[1]):
            if counted[i, j] and found[i, j] < 0.0:
                total += found[i, j] * found[i, j]
    return total


@compiled_as_is
def pressed_by(loads: Values, states: States, shares: Values) -> Values:
    """Return loads that bring about what is read, some of them below zero.

    What does not show is filled in with what its neighbours would bring, as far as it may.
    """
    found = np.where((states == ON) | (states == OVER), loads, 0.0)
    for _ in range(FILLED):
        found = filled(loads, states, np.maximum(found, 0.0), shares)
        unspread(found, shares)
    return found


@compiled_as_is
def filled(loads: Values, states: States, pressed: Values, shares: Values) -> Values:
    """Return readings that hold what is seen, elsewhere what pressed loads bring, where allowed."""
    found = spread(pressed, shares)
    for i in range(loads.shape[0]):
        for j in range(loads.shape[1]):
            if states[i, j] == ON:
                found[i, j] = loads[i, j]
            elif states[i, j] == UNDER:
                found[i, j] = min(found[i, j], loads[i, j])
            elif states[i, j] == OVER:
                found[i, j] = max(found[i, j], loads[i, j])
    return found


@compiled_as_is
def undone(
    loads: Values, states: States, width: float, enough: float, found: Values, limits: Values
) -> float:
    """Write the loads that explain readings best through foam of a width, none below zero.

    By accelerated projected gradients (A. Beck and M. Teboulle 2009, 10.1137/080716542), begun anew
    where they turn back (B. O'Donoghue and E. Candes 2015, 10.1007/s10208-013-9150-3).

    Parameters
    ----------
    loads, states : ndarray, shape (rows, columns)
        As of `Part`.
    width : float
        In cells.
    enough : float
        What may be left of the readings for that to be enough.
    found, limits : ndarray, shape (rows, columns)
        Written: the loads, and what elements may bear at most of which nothing shows.

    Returns
    -------
    float
        Root mean square of what is left of the readings, over theirs.
    """
    shares = shares_of(width)
    begin = pressed_by(loads, states, shares)
    (rows, cols), largest, total, left = loads.shape, 0.0, 0.0, math.inf
    for i in range(rows):
        for j in range(cols):
            found[i, j] = max(begin[i, j], 0.0)
            if states[i, j] == ON:
                largest = max(largest, loads[i, j])
                total += loads[i, j] * loads[i, j]
    ahead, pace = found.copy(), 1.0
    for _ in range(ROUNDS):
        off = left_over(loads, states, spread(ahead, shares))
        left = math.sqrt((off * off).sum() / total)
        if left < enough:
            break
        slope = spread(off, shares)
        turned = moved = 0.0
        faster = 0.5 * (1.0 + math.sqrt(1.0 + 4.0 * pace * pace))
        for i in range(rows):
            for j in range(cols):
                new = max(ahead[i, j] - slope[i, j], 0.0)
                step = new - found[i, j]
                turned += (ahead[i, j] - new) * step
                moved = max(moved, abs(step))
                found[i, j] = new
                ahead[i, j] = new + (pace - 1.0) / faster * step
        pace = faster
        if turned > 0.0:
            ahead[:, :], pace = found, 1.0
        if moved < ENOUGH * largest:
            break
    brought, own = spread(found, shares), shares[0] * shares[0]
    for i in range(rows):
        for j in range(cols):
            limits[i, j] = max(found[i, j] + (loads[i, j] - brought[i, j]) / own, 0.0)
    return left


@compiled_as_is
def left_over(loads: Values, states: States, brought: Values) -> Values:
    """Return by how much what is brought to each element is more than was read."""
    off = np.zeros(loads.shape)
    for i in range(loads.shape[0]):
        for j in range(loads.shape[1]):
            more = brought[i, j] - loads[i, j]
            if states[i, j] == ON:
                off[i, j] = more
            elif states[i, j] == UNDER:
                off[i, j] = max(more, 0.0)
            elif states[i, j] == OVER:
                off[i, j] = min(more, 0.0)
    return off
