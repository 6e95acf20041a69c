"""Which touched elements belong to something solid, and which are a large pad's scattered readings.

On a large pad strays are many, and in the loaded columns of a divider the converter's noise
passes for loads on idle elements. Both are scattered: few of their neighbours are touched too.
"""

from __future__ import annotations

import math

import numpy as np

from tactile_graph.compiled import compiled_as_is
from tactile_graph_likelihood.geometry.outlines import Values
from tactile_graph_likelihood.single.density.element_terms import (
    LEAST,
    OFF,
    ON,
    SIGMA,
    STRAYS,
    States,
)
from tactile_graph_likelihood.single.density.problem import LARGE_PAD

DENSE, LOOSE = 5, 3  # touched neighbours, of 8, of an element amid others, and of one at an edge
FEWEST = 8  # such elements, for a typical load
LIGHT = 3.0  # deviations of ln gain below the typical load: no element that is covered
SAMPLE = 1024  # loads for a median
BINS = 128
MANY, MOST_STRAYS = 20.0, 4.0  # idle elements that show: so many, and so many times the strays
QUIET, NARROW = 0.995, 0.9
"""Share of the idle readings below the new least load; and the share that must lie in the lower
half of what is too light, so that a second, lighter object is not taken for noise."""


@compiled_as_is
def neighbours_on(states: States, row: int, column: int) -> int:
    """Return how many of an element's eight neighbours read a load."""
    rows, columns = states.shape
    count = 0
    if 0 < row < rows - 1 and 0 < column < columns - 1:
        for i in range(row - 1, row + 2):
            for j in range(column - 1, column + 2):
                count += 1 if states[i, j] == ON else 0
    else:
        for i in range(max(row - 1, 0), min(row + 2, rows)):
            for j in range(max(column - 1, 0), min(column + 2, columns)):
                count += 1 if states[i, j] == ON else 0
    return count - 1 if states[row, column] == ON else count


@compiled_as_is
def typical_load(logs: Values, states: States) -> float:
    """Return the median log load of touched elements among touched ones; NaN if they are few."""
    rows, columns = states.shape
    touched = 0
    for i in range(rows):
        for j in range(columns):
            if states[i, j] == ON:
                touched += 1
    found = np.empty(min(touched, 2 * SAMPLE))
    every, seen, count = 1 + touched // (2 * SAMPLE), 0, 0
    for i in range(rows):
        for j in range(columns):
            if states[i, j] != ON:
                continue
            seen += 1
            if seen % every == 0 and neighbours_on(states, i, j) >= DENSE:
                found[count] = logs[i, j]
                count += 1
    return float(np.median(found[:count])) if count >= FEWEST else math.nan


@compiled_as_is
def solid(logs: Values, states: States, typical: float, sigma: float) -> States:
    """Return states in which what is scattered, or far too light, reads nothing.

    Parameters
    ----------
    logs, states
        The image, as in `element_terms`.
    typical : float
        As `typical_load` gives it.
    sigma : float
        Standard deviation of ln gain.
    """
    rows, columns = states.shape
    light, heavy = typical - LIGHT * sigma, states.copy()
    for i in range(rows):
        for j in range(columns):
            if heavy[i, j] == ON and logs[i, j] < light:
                heavy[i, j] = OFF
    out = heavy.copy()
    for i in range(rows):
        for j in range(columns):
            if heavy[i, j] == ON and neighbours_on(heavy, i, j) < LOOSE:
                out[i, j] = OFF
    return out


@compiled_as_is
def least_shown(logs: Values, states: States, noise: Values) -> float:
    """Return the logarithm of a load that idle elements of a large pad do not show by noise.

    Parameters
    ----------
    logs, states
        The image, as in `element_terms`.
    noise : ndarray, shape (9,)
        As there.

    Returns
    -------
    float
        The noise's own `LEAST` where idle elements show no more than strays would, or other loads
        than noise would.
    """
    least: float = noise[LEAST]
    rows, columns = states.shape
    if rows * columns <= LARGE_PAD:
        return least
    typical = typical_load(logs, states)
    if math.isnan(typical):
        return least
    body = solid(logs, states, typical, noise[SIGMA])
    top, bottom = typical - LIGHT * noise[SIGMA], math.inf
    bins, idle = np.zeros(BINS), 0
    for turn in range(2):
        for i in range(rows):
            for j in range(columns):
                if states[i, j] != ON or logs[i, j] >= top or not _is_idle(body, i, j):
                    continue
                if turn == 0:
                    idle += 1
                    bottom = min(bottom, logs[i, j])
                else:
                    place = (logs[i, j] - bottom) / (top - bottom) * BINS
                    bins[min(int(place), BINS - 1)] += 1.0
        if idle < MANY or idle < MOST_STRAYS * noise[STRAYS] * rows * columns:
            return least
    passed, k = 0.0, 0
    if bins[: BINS // 2].sum() < NARROW * idle:
        return least
    while passed < QUIET * idle:
        passed += bins[k]
        k += 1
    found: float = max(least, bottom + (top - bottom) * k / BINS)
    return found


@compiled_as_is
def _is_idle(body: States, row: int, column: int) -> bool:
    """Return whether nothing solid is within two elements."""
    rows, columns = body.shape
    for i in range(max(row - 2, 0), min(row + 3, rows)):
        for j in range(max(column - 2, 0), min(column + 3, columns)):
            if body[i, j] == ON:
                return False
    return True
