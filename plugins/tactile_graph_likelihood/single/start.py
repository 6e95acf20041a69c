"""Where the search begins: an outline with the moments of the touched elements."""

from __future__ import annotations

import math

import numpy as np

from tactile_graph.compiled import compiled_as_is
from tactile_graph_likelihood.geometry.outlines import (
    DISC,
    ELLIPSE,
    OVAL,
    RECTANGLE,
    REGULAR,
    Values,
)
from tactile_graph_likelihood.geometry.oval import to_oval
from tactile_graph_likelihood.single.element_terms import ON, States

STRAY = 7.0  # squared distance over the variance; a rectangle's corners are at 6, a disc's rim at 4
TRIMS = 8
THINNEST = 0.05  # variance across an outline over the mean one: touched elements may be a line
LIGHT_EDGE = 0.25  # ln of a full element's load over the mean, whose edge is partly covered


@compiled_as_is
def moments(grid: Values, logs: Values, states: States) -> Values:
    """Return count, mean x and y, variances xx, xy and yy, and mean log load of what is touched.

    The variances count each element with its own extent; y runs down. Elements further from the
    mean than any of an outline's are left out, until none is: strays, far away on a large pad.
    """
    found = np.zeros(7)
    _moments_within(grid, logs, states, math.inf, found)
    for _ in range(TRIMS):
        count = found[0]
        if not _moments_within(grid, logs, states, STRAY, found) or found[0] == count:
            break
    return found


@compiled_as_is
def _moments_within(grid: Values, logs: Values, states: States, far: float, out: Values) -> bool:
    """Write the moments of what lies within a squared distance by moments; False if nothing."""
    pitch, half = grid[2], 0.5 * grid[3]
    left, top, area = grid[0] + half, grid[1] + half, pitch * pitch
    mean_x, mean_y = (out[1] - left) / pitch, (out[2] - top) / pitch
    det = max(out[3] * out[5] - out[4] * out[4], 1e-12 * area * area) / area
    a, b, c = out[5] / det, -2.0 * out[4] / det, out[3] / det
    count = x = y = xx = xy = yy = log = 0.0
    for i in range(states.shape[0]):
        v = i - mean_y
        for j in range(states.shape[1]):
            if states[i, j] != ON:
                continue
            u = j - mean_x
            if far < math.inf and a * u * u + b * u * v + c * v * v > far:
                continue
            count += 1.0
            x += j
            y += i
            xx += j * j
            xy += i * j
            yy += i * i
            log += logs[i, j]
    if count == 0.0:
        return False
    x, y, own = x / count, y / count, 1.0 / 12.0
    out[0], out[6] = count, log / count
    out[1], out[2] = left + pitch * x, top + pitch * y
    out[3] = (xx / count - x * x + own) * area
    out[4] = (xy / count - x * y) * area
    out[5] = (yy / count - y * y + own) * area
    return True


@compiled_as_is
def first_outline(kind: int, corners: int, found: Values, turn: float, p: Values) -> None:
    """Write what `outline_of_moments` does; thin outlines begin broader."""
    outline_of_moments(kind, corners, found, turn, THINNEST, p)


@compiled_as_is
def outline_of_moments(
    kind: int, corners: int, found: Values, turn: float, thinnest: float, p: Values
) -> None:
    """Write an outline with given moments, and the load's logarithm, into ``p``.

    Parameters
    ----------
    kind, corners : int
        Of the outline, as in `outlines`.
    found : ndarray, shape (7,)
        As `moments` gives it.
    turn : float
        Angle in radians by which the outline is turned from where the moments have it.
    thinnest : float
        Least variance across, over the mean of the two.
    p : ndarray, shape (K,)
        Written, up to the load.
    """
    xx, xy, yy = found[3], found[4], found[5]
    p[0], p[1] = found[1], found[2]
    middle, off = 0.5 * (xx + yy), math.hypot(0.5 * (xx - yy), xy)
    major, minor = middle + off, max(middle - off, thinnest * middle)
    angle = 0.5 * math.atan2(-2.0 * xy, xx - yy) + turn
    last = 3
    if kind == DISC:
        p[2] = math.sqrt(4.0 * middle)
    elif kind in (ELLIPSE, OVAL, RECTANGLE):
        spread = 3.0 if kind == RECTANGLE else 4.0
        along, across = math.cos(turn) ** 2, math.sin(turn) ** 2
        p[2] = math.sqrt(spread * (major * along + minor * across))
        p[3] = math.sqrt(spread * (major * across + minor * along))
        p[4] = angle
        if kind == OVAL:
            to_oval(p)
        last = 5
    else:
        # the variance along any axis of a regular polygon, over that of its corners' circle
        step = 2.0 * math.pi / corners
        radius = math.sqrt(12.0 * middle / (2.0 + math.cos(step)))
        if kind == REGULAR:
            p[2], p[3] = radius, angle
            last = 4
        else:
            for k in range(corners):
                along = radius * math.sqrt(major / middle) * math.cos(turn + k * step)
                across = radius * math.sqrt(minor / middle) * math.sin(turn + k * step)
                cos, sin = math.cos(angle - turn), -math.sin(angle - turn)
                p[2 * k] = found[1] + along * cos - across * sin
                p[2 * k + 1] = found[2] + along * sin + across * cos
            last = 2 * corners
    p[last] = found[6] + LIGHT_EDGE


@compiled_as_is
def turns(kind: int, corners: int) -> int:
    """Return how many angles, over a period, are worth a try."""
    if kind == RECTANGLE:
        return 6
    return 4 if kind == REGULAR else 1
