"""Objects that press with their rim alone: what lies within it says nothing of their outline."""

from __future__ import annotations

import math

import numpy as np

from tactile_graph.compiled import compiled_later
from tactile_graph_likelihood.any_pad.pad_effects.from_frame import lines
from tactile_graph_likelihood.geometry.outlines import DISC, RECTANGLE, Values
from tactile_graph_likelihood.single.density.element_terms import ON, OVER, UNKNOWN, States
from tactile_graph_likelihood.single.readings import Readings

MANY_VOIDS = -1.1
"""Log odds of a void, as fitted, below which nothing can be hollow."""

MIDDLE = 0.25
"""Of the shorter half size: elements so near the middle are looked at first, as they are few."""

INSIDE = 0.6
"""Sides of an element by which its middle lies within the outline, to be counted."""

FEWEST, RIM = 12, 5
"""Elements inside, and those of them that must be the rim's, for anything to be said."""

SOME = 0.2
"""Share of elements within a hollow that may read something."""

SURE = 8.0
"""Nats by which a hollow must explain what reads nothing better than voids all over do; of frames
without one, one in a thousand has more."""

MARGIN = 0.75
"""Sides of an element by which it may lie beyond a hollow and still be partly over it."""

DIM, CENTRAL, SHOWN = 0.3, 4, 0.4
"""Of a rim's mean load, what elements within it read at most where a cover carries it there; the
fewest of them that show, and their share, for that to be said."""


def is_covered_rim(kind: int, readings: Readings, p: Values) -> bool:
    """Return whether what lies within an outline's rim reads, but far less than the rim does.

    So does a rim under a cover: how far that carries the load is not told by such a face.
    Parameters as of `without_hollow`.
    """
    begin = readings.through_foam or readings
    if begin.touched < FEWEST + CENTRAL:
        return False
    return bool(has_dim_middle.call(kind, begin.grid, begin.logs, begin.states, p))


@compiled_later
def has_dim_middle(kind: int, grid: Values, logs: Values, states: States, p: Values) -> bool:
    """Return the same of loads' logarithms and states, shape (rows, columns), on a grid."""
    rows, columns = states.shape
    pitch, middle = grid[2], 0.5 * grid[3]
    shorter, cos, sin, across, down = p[2], 1.0, 0.0, 1.0, 1.0
    if kind != DISC:
        shorter, cos, sin = min(p[2], p[3]), math.cos(p[4]), math.sin(p[4])
        across, down = shorter / p[2], shorter / p[3]
    edge = max(shorter - 2.0 * pitch, pitch)
    n_within = n_dim = n_rim = 0
    dim = rim = 0.0
    for i in range(rows):
        y = grid[1] + middle + pitch * i - p[1]
        for j in range(columns):
            x = grid[0] + middle + pitch * j - p[0]
            u, v = across * (x * cos - y * sin), down * (x * sin + y * cos)
            far = max(abs(u), abs(v)) if kind == RECTANGLE else math.hypot(u, v)
            shows = states[i, j] == ON or states[i, j] == OVER
            if far < edge:
                n_within += 1
                if shows:
                    n_dim += 1
                    dim += logs[i, j]
            elif shows and far < shorter:
                n_rim += 1
                rim += logs[i, j]
    if n_dim < max(float(CENTRAL), SHOWN * n_within) or n_rim < FEWEST:
        return False
    return bool(dim / n_dim < rim / n_rim + math.log(DIM))


def without_hollow(kind: int, readings: Readings, p: Values, voids: float) -> Readings | None:
    """Return readings whose elements over an object's hollow are unknown, None where it has none.

    Parameters
    ----------
    kind : int
    readings : Readings
    p : ndarray, shape (K,)
        The outline of an even face.
    voids : float
        Log odds of a void, as fitted with it.

    Notes
    -----
    Elements partly over a hollow bear less. Taken for elements of poor gain they draw the load of
    covered ones down, and the rim outwards.
    """
    size = float(p[2]) if kind == DISC else min(float(p[2]), float(p[3]))
    if voids < MANY_VOIDS or _bears_in_the_middle(readings, p, MIDDLE * size):
        return None
    inwards = _depth_cm(kind, readings, p)
    side = float(readings.grid[3])
    inside = (inwards < size - INSIDE * side) & (readings.states != UNKNOWN)
    far, its = inwards[inside], readings.shows[inside]
    n = len(far)
    if n < FEWEST:
        return None
    order = far.argsort()
    far, on = far[order], its[order]
    within, shown = np.arange(1, n - RIM + 1), on.cumsum()[: n - RIM]
    total = int(on.sum())
    gain = _explained(shown, within) + _explained(total - shown, n - within)
    gain -= _explained(np.array([total]), np.array([n]))[0]
    gain[shown > SOME * within] = -math.inf
    best = int(gain.argmax())
    if not gain[best] > SURE:
        return None
    rim_cm = 0.5 * float(far[best] + far[best + 1])
    over_it = inwards < rim_cm + MARGIN * side
    rim = readings.without(over_it)
    return rim if rim.touched >= FEWEST else None


def _bears_in_the_middle(readings: Readings, p: Values, reach_cm: float) -> bool:
    """Return whether elements so far around an outline's middle read too often for a hollow."""
    left, top, pitch, side = readings.grid[:4].tolist()
    inner = reach_cm - 0.5 * side
    rows, columns = lines(p[1] - top, inner, pitch, side), lines(p[0] - left, inner, pitch, side)
    near = readings.shows[rows, columns]
    return bool(np.count_nonzero(near) > max(1.0, SOME * near.size))


def _explained(shown: np.ndarray, of: np.ndarray) -> Values:
    """Return the largest log likelihood of so many of some elements that show."""
    share = np.clip(shown / of, 1e-9, 1.0 - 1e-9)
    found: Values = shown * np.log(share) + (of - shown) * np.log1p(-share)
    return found


def _depth_cm(kind: int, readings: Readings, p: Values) -> Values:
    """Return how far elements' middles lie from an outline's, as far as its shorter half size goes.

    Along any direction it grows evenly from 0 to that size at the outline.
    """
    left, top, pitch, side = readings.grid[:4].tolist()
    rows, columns = readings.states.shape
    x = left + 0.5 * side + pitch * np.arange(columns) - p[0]
    y = (top + 0.5 * side + pitch * np.arange(rows) - p[1])[:, None]
    if kind == DISC:
        return np.asarray(np.hypot(x, y))
    cos, sin = math.cos(p[4]), math.sin(p[4])
    shorter = min(float(p[2]), float(p[3]))
    u, v = (x * cos - y * sin) * (shorter / p[2]), (x * sin + y * cos) * (shorter / p[3])
    return np.asarray(np.maximum(np.abs(u), np.abs(v)) if kind == RECTANGLE else np.hypot(u, v))
