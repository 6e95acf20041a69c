"""How likely a load, cell by cell, is under a rectangle: cost and gradient over its five unknowns.

A cell's expected load is its coverage by the rectangle. On a pad with bumps and voids a covered
cell reads its coverage times a lognormal gain, or nothing; a bare cell reads nothing but for
strays. What a cell adds to the cost is the negative logarithm of that likelihood.
"""

from __future__ import annotations

import math
from typing import NamedTuple, TypeAlias

import numpy as np
from numpy.typing import NDArray

from tactile_graph.compiled import compiled_later

OFF, ON, UNKNOWN = range(3)
"""State of a cell: not touched, touched, not known (broken)."""

Values: TypeAlias = NDArray[np.float64]
States: TypeAlias = NDArray[np.uint8]


class Window(NamedTuple):
    """The part of a pad around a footprint.

    Parameters
    ----------
    cells_cm : ndarray, shape (N, 2)
        Centres (x, y) of the touched cells.
    logs : ndarray, shape (rows, columns)
        Logarithm of each touched cell's load over a fully covered cell's.
    states : ndarray of uint8, shape (rows, columns)
        `OFF`, `ON` or `UNKNOWN`.
    x_cm, y_cm : ndarray
        Cell centres along x and down y.
    """

    cells_cm: Values
    logs: Values
    states: States
    x_cm: Values
    y_cm: Values


SQRT_HALF = math.sqrt(0.5)
DENSITY = 1.0 / math.sqrt(2.0 * math.pi)


@compiled_later
def cost(
    p: Values, logs: Values, states: States, xs: Values, ys: Values, law: Values, slope: Values
) -> float:
    """Return the cost of a rectangle; write its gradient into ``slope``.

    Parameters
    ----------
    p : ndarray, shape (5,)
        Centre x and y, half length, half breadth in cm, angle in radians as seen.
    logs : ndarray, shape (rows, columns)
        Logarithm of each touched cell's load over a fully covered cell's.
    states : ndarray of uint8, shape (rows, columns)
        `OFF`, `ON` or `UNKNOWN`.
    xs, ys : ndarray
        Cell centres along x and down y, in cm.
    law : ndarray, shape (6,)
        Standard deviation of the gains' logarithms; share of voids; log of a full cell's load
        over the least that shows; likelihood of a stray; width in cm over which a cell's coverage
        rises from 0 to 1; 1 where the loads are to be used and 0 where only the states are.
    slope : ndarray, shape (5,)
        Written: the gradient.

    Returns
    -------
    float
    """
    sigma, voids, full, stray, width = law[0], law[1], law[2], law[3], law[4]
    use = law[5] > 0.0
    x, y, half, other = p[0], p[1], p[2], p[3]
    cos, sin = math.cos(p[4]), math.sin(p[4])
    present = 1.0 - voids
    at_full = present * 0.5 * math.erfc(-SQRT_HALF * full / sigma)
    cost_stray, cost_void = -math.log(stray), -math.log(1.0 - at_full)
    cost_full = -math.log(at_full + stray)
    total = g_x = g_y = g_half = g_other = g_angle = 0.0
    for i in range(ys.shape[0]):
        dy = y - ys[i]
        for j in range(xs.shape[0]):
            state = states[i, j]
            if state == UNKNOWN:
                continue
            dx = xs[j] - x
            u, v = dx * cos + dy * sin, dy * cos - dx * sin
            along, across = 0.5 + (half - abs(u)) / width, 0.5 + (other - abs(v)) / width
            if along <= 0.0 or across <= 0.0:
                if state == ON:
                    total += cost_stray
                continue
            if along >= 1.0 and across >= 1.0 and (state == OFF or not use):
                total += cost_void if state == OFF else cost_full
                continue
            covered = min(along, 1.0) * min(across, 1.0)
            known = math.log(covered)
            if state == ON and use:
                d = (logs[i, j] - known) / sigma
                likely = math.exp(-0.5 * d * d)
                total -= math.log(likely + stray)
                slope_here = -likely * d / (sigma * covered * (likely + stray))
            else:
                z = (known + full) / sigma
                shows = present * 0.5 * math.erfc(-SQRT_HALF * z)
                d_shows = present * DENSITY * math.exp(-0.5 * z * z) / (sigma * covered)
                if state == ON:
                    total -= math.log(shows + stray)
                    slope_here = -d_shows / (shows + stray)
                else:
                    total -= math.log(1.0 - shows)
                    slope_here = d_shows / (1.0 - shows)
            g_u = slope_here * min(across, 1.0) / width if along < 1.0 else 0.0
            g_v = slope_here * min(along, 1.0) / width if across < 1.0 else 0.0
            g_half += g_u
            g_other += g_v
            g_u = -g_u if u > 0.0 else g_u if u < 0.0 else 0.0
            g_v = -g_v if v > 0.0 else g_v if v < 0.0 else 0.0
            g_x += g_v * sin - g_u * cos
            g_y += g_u * sin + g_v * cos
            g_angle += g_u * v - g_v * u
    slope[0], slope[1], slope[2], slope[3], slope[4] = g_x, g_y, g_half, g_other, g_angle
    return total
