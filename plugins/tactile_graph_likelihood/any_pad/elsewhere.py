"""Where else the likeliest outline may lie: what a climb from the touched elements' moments misses.

Each is a place from which another climb is worth its time, where a frame says so.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from tactile_graph_likelihood.any_pad.from_frame import half_extents
from tactile_graph_likelihood.geometry.outlines import Values, sizes
from tactile_graph_likelihood.single.element_terms import UNKNOWN
from tactile_graph_likelihood.single.even_points import even_places
from tactile_graph_likelihood.single.readings import Readings

LONE = 0.4
"""Touched share of an element and its known neighbours below which that is a stray rather than an
object's."""

GROWN = 1.3
"""By how much a round outline is larger that goes on beyond the pad's edge."""

FEW, MOSTLY = 20, 0.7
"""Touched elements, and the share of them that have hardly a touched neighbour, of an object most
of which may read nothing."""

DISCS, SMALLER, LARGER, BESIDE = 200, 0.6, 2.5, 1.2
"""Discs that are tried around few elements: how many, their radius over half the elements' extent,
at the least and the most, and how far beside their middle, over that."""

LEAST_VOIDS, MOST_VOIDS = 0.05, 0.97

MANY_VOIDS = 0.25
"""Share of voids from which on an end of an outline may look like a row of them, or these like
it."""

SIDES, ALONG, TURNS = (-2.0, -1.4, -0.8, 0.8, 1.4, 2.0), (0.8, 1.4), (0.1, 0.2, 0.35)
"""Moves of a rectangle: of one side outwards and of both of an axis along it, in pitches, and by
angles in radians."""


def without_lone(readings: Readings) -> Readings | None:
    """Return the readings with touched elements whose neighbours are bare unknown.

    Parameters
    ----------
    readings : Readings

    Returns
    -------
    Readings or None
        None where no touched element is like that.
    """
    lone = lone_of(readings)
    if not lone.any():
        return None
    return readings.with_states(np.where(lone, np.uint8(UNKNOWN), readings.states))


def lone_of(readings: Readings) -> NDArray[np.bool_]:
    """Return which touched elements have hardly a touched neighbour."""
    shows, known = readings.shows, readings.states != UNKNOWN
    found: NDArray[np.bool_] = shows & (_around(shows) < LONE * _around(known))
    return found


def _around(mask: NDArray[np.bool_]) -> Values:
    """Return how many of an element and its eight neighbours are in a mask."""
    wide = np.zeros((mask.shape[0] + 2, mask.shape[1] + 2))
    wide[1:-1, 1:-1] = mask
    rows = wide[:-2] + wide[1:-1] + wide[2:]
    found: Values = rows[:, :-2] + rows[:, 1:-1] + rows[:, 2:]
    return found


def grown_beyond(kind: int, readings: Readings, p: Values) -> Values | None:
    """Return a round outline larger by what may lie beyond the pad's edge, shape (K,).

    Its rim on the pad stays where it is: of what is cut off by the edge the touched elements'
    moments make a smaller outline. None where it lies on the pad whole.
    """
    left, top = readings.grid[:2].tolist()
    (x, y), (width, height) = p[:2].tolist(), readings.size_cm
    wide, high = half_extents(kind, p)
    right = float(x + wide > left + width) - float(x - wide < left)
    down = float(y + high > top + height) - float(y - high < top)
    if right == 0.0 and down == 0.0:
        return None
    grown, more = p.copy(), (GROWN - 1.0) / math.hypot(right, down)
    grown[2 : 2 + sizes.call(kind)] *= GROWN
    grown[0] = min(max(x + more * wide * right, left), left + width)
    grown[1] = min(max(y + more * high * down, top), top + height)
    return grown


def discs_around(readings: Readings, p: Values) -> Values | None:
    """Return discs around few scattered elements, each with the voids that it would have.

    Parameters
    ----------
    readings : Readings
    p : ndarray, shape (K,)
        A disc, its load, ..., and the voids' log odds.

    Returns
    -------
    ndarray, shape (N, K), or None
        None where elements are many, or hang together.
    """
    if readings.touched > FEW or np.count_nonzero(lone_of(readings)) < MOSTLY * readings.touched:
        return None
    shows = readings.shows
    rows, columns = np.nonzero(shows)
    down, across = int(np.ptp(rows)) + 1, int(np.ptp(columns)) + 1
    left, top, pitch, side = readings.grid[:4].tolist()
    half = 0.5 * pitch * max(down, across)
    middle_x = left + 0.5 * (side + pitch * float(columns.min() + columns.max()))
    middle_y = top + 0.5 * (side + pitch * float(rows.min() + rows.max()))
    places = even_places(DISCS, 3)
    x = middle_x + BESIDE * half * (2.0 * places[:, 0] - 1.0)
    y = middle_y + BESIDE * half * (2.0 * places[:, 1] - 1.0)
    radius = half * SMALLER * (LARGER / SMALLER) ** places[:, 2]
    off_x = (left + 0.5 * side + pitch * np.arange(shows.shape[1])) - x[:, None]
    off_y = (top + 0.5 * side + pitch * np.arange(shows.shape[0])) - y[:, None]
    squared = off_y[:, :, None] ** 2 + off_x[:, None, :] ** 2
    within = squared < (radius * radius)[:, None, None]
    covered, touched = within.sum(axis=(1, 2)), (within & shows).sum(axis=(1, 2))
    voids = np.clip(1.0 - touched / np.maximum(covered, 1), LEAST_VOIDS, MOST_VOIDS)
    found = np.repeat(p[None], DISCS, axis=0)
    found[:, 0], found[:, 1], found[:, 2] = x, y, radius
    found[:, -1] = np.log(voids / (1.0 - voids))
    possible: Values = found[touched > 0]
    return possible


def with_sides_moved(readings: Readings, p: Values) -> Values | None:
    """Return rectangles with a side elsewhere, moved along an axis, or turned, shape (N, K).

    None where hardly any element within reads nothing: what ends there is seen.
    """
    if p[-1] < math.log(MANY_VOIDS / (1.0 - MANY_VOIDS)):
        return None
    pitch, cos, sin = float(readings.grid[2]), math.cos(p[4]), math.sin(p[4])
    found = np.repeat(p[None], len(MOVES), axis=0)
    longer, shift = 0.5 * pitch * MOVES[:, :2], 0.5 * pitch * MOVES[:, 2:4]
    found[:, 2:4] += longer
    found[:, 0] += shift[:, 0] * cos - shift[:, 1] * sin
    found[:, 1] -= shift[:, 0] * sin + shift[:, 1] * cos
    found[:, 4] += MOVES[:, 4]
    return found


def _moves() -> Values:
    """Return by how much both axes of a rectangle grow, their middles move, and it is turned."""
    moves = list[tuple[float, ...]]()
    for axis in (0, 1):
        for way in (1.0, -1.0):
            for far in SIDES:
                moves.append(_move(axis, far, way * far))
            for far in ALONG:
                moves.append(_move(axis, 0.0, way * 2.0 * far))
    turns = [(0.0, 0.0, 0.0, 0.0, way * turn) for turn in TURNS for way in (1.0, -1.0)]
    return np.array(moves + turns)


def _move(axis: int, longer: float, shift: float) -> tuple[float, ...]:
    move = [0.0] * 5
    move[axis], move[2 + axis] = longer, shift
    return tuple(move)


MOVES = _moves()
