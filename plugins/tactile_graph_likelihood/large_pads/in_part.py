"""A wide outline's readings, without most of what it covers whole: that tells of no rim."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from tactile_graph_likelihood.geometry.outlines import DISC, RECTANGLE, Values
from tactile_graph_likelihood.single.readings import MANY, Readings

BAND = 3.0
"""Pitches within an outline's edge of which all elements are kept: it moves by less."""

PATCH = 4
"""Elements a side of what is kept farther in: most have neighbours there."""

LEAST = 1024
"""Touched elements farther in that tell load, gains and voids, at least."""


def in_part(kind: int, readings: Readings, p: Values) -> Readings:
    """Return readings of which elements well within an outline say nothing, but for some patches.

    Parameters
    ----------
    kind : int
        Of a disc, ellipse or rectangle.
    readings : Readings
    p : ndarray, shape (K,)
        The outline, in its own numbers.

    Returns
    -------
    Readings
        Of about 4096 touched elements; of more on a rim that has as many itself.
    """
    inner = well_within(kind, readings, p)
    farther = int(np.count_nonzero(inner & readings.shows))
    wanted = max(MANY - (readings.touched - farther), LEAST)
    every = math.ceil(math.sqrt(farther / wanted))
    row, column = (np.arange(n) // PATCH % max(every, 1) != 0 for n in inner.shape)
    return readings.without(inner & (row[:, None] | column))._replace(part_of=readings)


def well_within(kind: int, readings: Readings, p: Values) -> NDArray[np.bool_]:
    """Return which elements' middles are so far within an outline that its rim does not reach."""
    left, top, pitch, side = readings.grid[:4].tolist()
    rows, columns = readings.states.shape
    x = left + 0.5 * side + pitch * np.arange(columns) - p[0]
    y = (top + 0.5 * side + pitch * np.arange(rows) - p[1])[:, None]
    a, b, turn = (p[2], p[2], 0.0) if kind == DISC else p[2:5]
    a, b = max(a - BAND * pitch, 0.0), max(b - BAND * pitch, 0.0)
    cos, sin = math.cos(turn), math.sin(turn)
    along, across = cos * x - sin * y, sin * x + cos * y
    inside: NDArray[np.bool_] = (b * along) ** 2 + (a * across) ** 2 < (a * b) ** 2
    if kind == RECTANGLE:
        inside = (np.abs(along) < a) & (np.abs(across) < b)
    return inside
