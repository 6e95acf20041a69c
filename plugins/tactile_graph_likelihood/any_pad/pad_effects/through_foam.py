"""Readings as a pad without foam would give them.

Foam, a skin or a pad's cover passes each load on to the neighbours, too, so that no reading is far
below those around it. Undone with too wide a foam, loads come out below zero, most where nothing
was pressed at all: the widest foam that leaves them positive is the one there is, and a bare pad,
on which neighbours read what they like, bears next to none. Undone with that, readings are a bare
pad's, with its gains, voids and rim.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from tactile_graph.compiled import compiled_as_is
from tactile_graph_likelihood.any_pad.pad_effects.foam_undone import FIRST, MOST, undone, widest
from tactile_graph_likelihood.geometry.outlines import Values
from tactile_graph_likelihood.single.density.element_terms import (
    ON,
    OVER,
    UNDER,
    UNKNOWN,
    States,
)
from tactile_graph_likelihood.single.readings import Readings

LEAST_TOLD, MOST_TOLD = 0.2, 0.9
"""Widths, in cells, of foam that is told: less changes nothing, through more loads that lie side by
side are not told apart."""

NARROWEST = 0.3
"""Width of foam, in cells, that there is none where not even that is possible."""

LEAKED, LEAKS = 0.1, 0.05
"""Of a neighbour's reading, what reads less may be carried there; share of such readings from which
on loads are carried, if by less than foam."""

ON_EDGE = 0.15
"""Share of what shows that may lie at the pad's edge."""

MARGIN = 2
"""Cells around what shows that may bear a load."""

UNEXPLAINED, NARROWER = 0.01, 0.96
"""Root mean square of what the loads leave of the readings, over theirs, below which they are
believed; by how much less wide foam is tried otherwise."""

DISTINCT, CONTRADICTED, STEEPER = 1.06, 0.003, 1.5
"""Times the width, and what that must leave of the readings at least, also over what the width
itself leaves, for it to be too wide."""

BARED, WORSE = 0.18, 9.6
"""Share of what shows that bears nothing, and times that wider foam leaves more of the readings,
that each would tell foam alone: where neighbours are alike anyway, foam is possible, too, but bares
nothing and can be of many widths."""

EXACT = 1e-9
"""What is left of readings at least, for more to be times that."""

FAINT = 0.15
"""Of the median load, below which one counts as none."""

NOTHING, LITTLE, FEW, BARE = 0.05, 0.5, 6, 0.25
"""Of the median load, what counts as nothing at the rim and as little; elements that bear little
for their share of nothing to be asked; that below which loads are carried farther than by foam, or
the law is told wrongly."""


class Part(NamedTuple):
    """What shows of a pad, with some cells around it.

    ``loads``, shape (rows, columns), are readings, of elements that show none the least that would;
    ``states`` as in `element_terms`, of elements at the pad's edge unknown: nobody knows how foam
    ends.
    """

    box: tuple[slice, slice]
    loads: Values
    states: States

    @property
    def seen(self) -> NDArray[np.bool_]:
        """Which elements read a load."""
        found: NDArray[np.bool_] = (self.states == ON) | (self.states == OVER)
        return found


def without_foam(readings: Readings, told_cm: float = 0.0) -> Readings | None:
    """Return readings as if no foam lay on the pad, None where none is to be seen.

    Parameters
    ----------
    readings : Readings
    told_cm : float
        Width of foam that is told, 0 for none: that is undone if it explains the readings.

    Notes
    -----
    Elements at the pad's edge say nothing then. What reads less than would show bears no more than
    its neighbours' loads leave room for.
    """
    part = _shown(readings)
    if part is None:
        return None
    loads, limits = np.empty(part.loads.shape), np.empty(part.loads.shape)
    told = told_cm / float(readings.grid[2])
    as_told = LEAST_TOLD <= told <= MOST_TOLD and (
        undone.call(part.loads, part.states, told, 0.0, loads, limits) < UNEXPLAINED
    )
    if not as_told and not _is_foam(part, loads, limits):
        return None
    return _laid_open(readings, part, loads, limits, FAINT * _usual(part, loads))


def _usual(part: Part, loads: Values) -> float:
    return float(np.median(loads[part.seen & (loads > 0.0)]))


def _is_foam(part: Part, loads: Values, limits: Values) -> bool:
    """Write loads and limits as `undone` does; return whether it is foam that was undone."""
    worse = _undone(part, loads, limits)
    if worse == 0.0:
        return False
    usual = _usual(part, loads)
    bared = float((loads[part.seen] < NOTHING * usual).mean())
    tells = bared / BARED + worse / WORSE >= 1.0
    return tells and bool(bare_rim.call(loads, part.states, usual) >= BARE)


def has_no_foam(readings: Readings) -> bool:
    """Return whether readings lie so far below their neighbours that there is no foam.

    Nor anything else that carries a little of each load to the neighbours. Where foam was undone
    there was some.
    """
    part = None if readings.through_foam is not None else _shown(readings)
    if part is None or widest.call(part.loads, part.states, NARROWEST) > 0.0:
        return False
    return leaked.call(part.loads, part.states) < LEAKS


def _undone(part: Part, loads: Values, limits: Values) -> float:
    """Write loads and limits as `undone` does; return how many times more wider foam leaves.

    0 where it does not explain readings clearly worse: there is no foam of a width that is told.
    """
    width = widest.call(part.loads, part.states, FIRST)
    if width >= MOST:
        return 0.0
    while width >= FIRST:
        left = undone.call(part.loads, part.states, width, 0.0, loads, limits)
        if left < UNEXPLAINED:
            least, other = max(CONTRADICTED, STEEPER * left), np.empty(loads.shape)
            wider = DISTINCT * width
            more = undone.call(part.loads, part.states, wider, least, other, other)
            return more / max(left, EXACT) if more >= least else 0.0
        width *= NARROWER
    return 0.0


def _shown(readings: Readings) -> Part | None:
    """Return the part of a pad that shows, None where too little of it lies within the pad."""
    first, left, loads, states = shown_part.call(readings.logs, readings.states, readings.touched)
    if not loads.size:
        return None
    box = slice(first, first + loads.shape[0]), slice(left, left + loads.shape[1])
    return Part(box, loads, states)


@compiled_as_is
def shown_part(logs: Values, states: States, touched: int) -> tuple[int, int, Values, States]:
    """Return a `Part`'s first row and column, loads and states; none of them if there is no part.

    ``touched`` is the number of elements that show.
    """
    rows, cols = states.shape
    first, last, left, right, inner = rows, -1, cols, -1, 0
    for i in range(rows):
        for j in range(cols):
            if states[i, j] not in (ON, OVER):
                continue
            first, last = min(first, i), i
            left, right = min(left, j), max(right, j)
            inner += 0 < i < rows - 1 and 0 < j < cols - 1
    if min(rows, cols) < 3 or last < 0 or inner < (1.0 - ON_EDGE) * touched:
        return 0, 0, np.empty((0, 0)), np.empty((0, 0), np.uint8)
    first, last = max(first - MARGIN, 0), min(last + MARGIN + 1, rows)
    left, right = max(left - MARGIN, 0), min(right + MARGIN + 1, cols)
    loads = np.exp(logs[first:last, left:right])
    its = states[first:last, left:right].copy()
    for i in range(first, last):
        for j in range(left, right):
            if i in (0, rows - 1) or j in (0, cols - 1):
                its[i - first, j - left] = UNKNOWN
    return first, left, loads, its


def _laid_open(
    readings: Readings, part: Part, loads: Values, limits: Values, least: float
) -> Readings:
    """Return readings with these loads, from the least on, in the place of a part of them."""
    seen = part.seen
    shows = seen & (loads >= least)
    logs, states = readings.logs.copy(), readings.states.copy()
    logs[part.box] = np.log(np.where(shows, loads, np.maximum(np.where(seen, 0.0, limits), least)))
    states[part.box] = np.where(shows, ON, np.where(part.states == UNKNOWN, UNKNOWN, UNDER))
    states[[0, -1]] = states[:, [0, -1]] = UNKNOWN
    found = readings._replace(logs=logs, least_log=math.log(least), through_foam=readings)
    return found.with_states(states)


@compiled_as_is
def bare_rim(loads: Values, states: States, usual: float) -> float:
    """Return the share of elements that bear nothing among those at the rim that bear little.

    Those that read a load beside others that read none: foam carries it there, but past its own
    reach nothing. ``usual`` is the median load.
    """
    nothing = little = 0
    for i in range(1, loads.shape[0] - 1):
        for j in range(1, loads.shape[1] - 1):
            if states[i, j] != ON or loads[i, j] >= LITTLE * usual:
                continue
            beside = False
            for r in range(i - 1, i + 2):
                for c in range(j - 1, j + 2):
                    beside = beside or states[r, c] == UNDER
            little += beside
            nothing += beside and loads[i, j] < NOTHING * usual
    return nothing / little if little >= FEW else 1.0


@compiled_as_is
def leaked(loads: Values, states: States) -> float:
    """Return the share of what shows that reads little beside one of its neighbours."""
    rows, cols = loads.shape
    little = seen = 0
    for i in range(rows):
        for j in range(cols):
            if states[i, j] not in (ON, OVER):
                continue
            largest = 0.0
            for r in range(max(i - 1, 0), min(i + 2, rows)):
                for c in range(max(j - 1, 0), min(j + 2, cols)):
                    if states[r, c] in (ON, OVER):
                        largest = max(largest, loads[r, c])
            seen += 1
            little += loads[i, j] < LEAKED * largest
    return little / max(seen, 1)
