"""Least squares of an even disc's load on each element: the kernel of ``fit_circle_load``."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from tactile_graph.compiled import compiled_later
from tactile_graph_fitters.ellipse.damped_steps import damped_step
from tactile_graph_pads.coverage.ellipse import ellipse_areas

OK, TOO_FEW, NOT_SETTLED, UNDETERMINED = range(4)
MOST_ROUNDS = 20
SETTLED = 1e-3  # of an element's side, by which the last step moves centre or radius
STEP = 1e-6  # of an element's side, over which slopes are taken
SHARE_FLOOR = 0.3  # of a full load: lighter elements are no surer than this

Values = NDArray[np.float64]
Usable = NDArray[np.bool_]
Found = tuple[int, float, float, float, float, float, float, float, int, int]


class Readings(NamedTuple):
    """Loads on a grid of elements.

    Parameters
    ----------
    loads : ndarray of float64, shape (rows, columns)
    usable : ndarray of bool, shape (rows, columns)
        Elements whose load is known.
    grid : ndarray, shape (4,)
        Left and top edge of the first element, pitch, side of an element; in cm.
    shows_from : float
        Least load that shows.
    """

    loads: Values
    usable: Usable
    grid: Values
    shows_from: float


@compiled_later
def start_of(readings: Readings, p: Values) -> int:
    """Write the disc with the load's moments, and its full load, into ``p``; return the touched.

    ``p`` holds x, y, radius and the load of a fully covered element.
    """
    loads, usable, grid = readings.loads, readings.usable, readings.grid
    count = 0
    total = x = y = xx = yy = 0.0
    for i in range(loads.shape[0]):
        for j in range(loads.shape[1]):
            if usable[i, j] and loads[i, j] > 0.0:
                load = loads[i, j]
                count += 1
                total += load
                x += j * load
                y += i * load
                xx += j * j * load
                yy += i * i * load
    if count == 0:
        return 0
    x, y = x / total, y / total
    pitch, half = grid[2], 0.5 * grid[3]
    p[0], p[1] = grid[0] + half + pitch * x, grid[1] + half + pitch * y
    p[2] = pitch * math.sqrt(2.0 * max(xx / total - x * x + yy / total - y * y, 0.05))
    p[3] = total * pitch * pitch / (math.pi * p[2] * p[2])
    return count


@compiled_later
def equations(readings: Readings, p: Values, normal: Values, slope: Values) -> tuple[float, int]:
    """Write the normal equations at ``p``; return the weighted cost and the elements in it."""
    loads, usable, grid = readings.loads, readings.usable, readings.grid
    shows_from = readings.shows_from
    rows, columns = loads.shape
    pitch, side, full = grid[2], grid[3], p[3]
    x, y, r, h = p[0] - grid[0], p[1] - grid[1], p[2], STEP * grid[3]
    at = ellipse_areas(x, y, r, r, 0.0, pitch, side, rows, columns)
    along = ellipse_areas(x + h, y, r, r, 0.0, pitch, side, rows, columns)
    down = ellipse_areas(x, y + h, r, r, 0.0, pitch, side, rows, columns)
    wider = ellipse_areas(x, y, r + h, r + h, 0.0, pitch, side, rows, columns)
    normal[:, :] = 0.0
    slope[:] = 0.0
    area, cost, count = side * side, 0.0, 0
    row = np.empty(4)
    for i in range(rows):
        for j in range(columns):
            share, load = at[i, j] / area, loads[i, j]
            if not usable[i, j] or (share <= 0.0 and load <= 0.0):
                continue
            count += 1
            off = full * share - load
            if load <= 0.0:
                if off <= shows_from:
                    continue  # so little does not show
                off -= shows_from
            weight = 1.0 / (max(share, SHARE_FLOOR) * full)
            row[0] = weight * full * (along[i, j] - at[i, j]) / (h * area)
            row[1] = weight * full * (down[i, j] - at[i, j]) / (h * area)
            row[2] = weight * full * (wider[i, j] - at[i, j]) / (h * area)
            row[3] = weight * share
            off *= weight
            cost += off * off
            for a in range(4):
                slope[a] += row[a] * off
                for b in range(a + 1):
                    normal[a, b] += row[a] * row[b]
    for a in range(4):
        for b in range(a):
            normal[b, a] = normal[a, b]
    return cost, count


@compiled_later
def even_disc(readings: Readings) -> Found:
    """Return the disc whose even load is nearest to an image's, by least squares.

    Returns
    -------
    (int, float, ..., int, int)
        Status, x, y, radius, load of a fully covered element, relative rms, standard deviations
        of centre and radius, number of elements, rounds.
    """
    p, best = np.zeros(4), np.zeros(4)
    normal, slope, step = np.empty((4, 4)), np.empty(4), np.empty(4)
    touched = start_of(readings, p)
    if touched < 4:
        return TOO_FEW, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, touched, 0
    status, damping, rounds = NOT_SETTLED, 0.0, 0
    cost, count = equations(readings, p, normal, slope)
    best[:] = p
    trial, turned = np.empty((4, 4)), np.empty(4)
    while rounds < MOST_ROUNDS:
        rounds += 1
        if not damped_step(normal, slope, damping, step):
            status = UNDETERMINED
            break
        reach = max(abs(step[0]), abs(step[1]), abs(step[2]))
        p[:] = best + step
        if reach > best[2] or p[2] <= 0.0 or p[3] <= 0.0:
            damping = max(10.0 * damping, 0.1)
            continue
        if reach < SETTLED * readings.grid[3]:
            best[:] = p
            status = OK
            break
        new, many = equations(readings, p, trial, turned)
        if new <= cost:
            cost, count, damping = new, many, 0.1 * damping if damping > 1e-3 else 0.0
            best[:] = p
            normal[:, :] = trial
            slope[:] = turned
        else:
            damping = max(10.0 * damping, 0.1)
    rms = math.sqrt(cost / max(count - 4, 1))
    centre, radius = _scatter(normal, rms)
    return status, best[0], best[1], best[2], best[3], rms, centre, radius, count, rounds


@compiled_later
def _scatter(normal: Values, rms: float) -> tuple[float, float]:
    """Return standard deviations of centre and radius, by the inverse of the normal equations."""
    zero, unit, column = 0.0, np.zeros(4), np.zeros(4)
    out = np.zeros(3)
    for a in range(3):
        unit[:] = 0.0
        unit[a] = -1.0
        if not damped_step(normal, unit, zero, column):
            return math.inf, math.inf
        out[a] = column[a]
    return rms * math.sqrt(max(out[0] + out[1], 0.0)), rms * math.sqrt(max(out[2], 0.0))
