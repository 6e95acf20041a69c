"""``fit_rectangle``: the rectangle whose outline lies nearest to points, robustly."""

from __future__ import annotations

import math
from typing import Annotated, TypeAlias

import numpy as np
from annotated_types import Ge, Gt
from numpy.typing import NDArray
from pydantic import AllowInfNan

from tactile_graph.compiled import compiled_later, compiled_twin_of
from tactile_graph.errors import Degenerate
from tactile_graph.wires import Image, Points
from tactile_graph_fitters.circle.principal_axes import NOT_SETTLED, OK, OUT_OF_RANGE, into_frame
from tactile_graph_fitters.ellipse.damped_steps import damped_step
from tactile_graph_fitters.orientation.element_pitch import THESIS_PITCH_CM, element_pitch_cm
from tactile_graph_fitters.orientation.oriented import Oriented
from tactile_graph_fitters.rectangle.fitted_rectangle import FittedRectangle, rectangle_of

ANGLES = 12  # tried over a quarter turn before the search
TRIM = 16  # part of the points left out each way, for strays
STARTS = 2  # of these are searched from
ROUNDS = 100
STEP = 1e-11  # of the points' extent
SCALE_CELLS = 0.5 / 1.3  # distance, in pitches, from which on a point counts linearly
LEVEL = 1e-5  # relative decrease of the cost over `PATIENCE` rounds that is taken for none
PATIENCE = 10

Values: TypeAlias = NDArray[np.float64]
Found: TypeAlias = tuple[int, float, float, float, float, float, float, int]
"""Status, centre (x, y), half sides, angle of the first side as seen, misfit, rounds."""


def fit_rectangle(
    points: Points,
    elements: Image | None = None,
    *,
    scale_cm: Annotated[float | None, Gt(0)] = None,
    inside_cm: Annotated[float, Ge(0), AllowInfNan(False)] = 0.0,
    cell_cm: Annotated[float | None, Gt(0)] = None,
) -> FittedRectangle:
    """Return the rectangle with the least robust distance of its outline from the points.

    Parameters
    ----------
    points : Points
        On the outline, on at least three of its sides: of fewer, as of two rows or an L, it is the
        smallest of the rectangles that are equally near.
    elements : Image, optional
        What was read, as it was read: not subdivided.
    scale_cm : float, optional
        Distance from which on a point counts linearly instead of by its square; 0.385 pitches of
        the elements if not given, 0.5 cm on the thesis' pad.
    inside_cm : float
        How far inside the outline the points lie; the sides come out larger by twice that.
        Centres of boundary cells lie about a third of a cell inside an outline that turns on
        each cell it covers by a fifth.
    cell_cm : float, optional
        Pitch of the elements that were read, for ``ambiguous`` and ``scale_cm``; that of
        ``elements`` if not given, or 1.3, the thesis' pad's.

    Returns
    -------
    FittedRectangle
        ``misfit`` is the root mean square distance in cm, each distance d counted as
        2 s**2 (sqrt(1 + (d / s)**2) - 1).

    Raises
    ------
    Degenerate
        If there are fewer than 5 distinct points, all are on one line, some are not finite, or
        no minimum is found.

    Notes
    -----
    Minimises the sum of 2 s**2 (sqrt(1 + (d / s)**2) - 1) (soft l1) over position, angle and half
    sides, d being the distance of a point from the nearest point of the outline. Angles over a
    quarter turn are tried with the points' (trimmed) bounding boxes first; Levenberg and
    Marquardt's iteration with iterated weights goes on from the best two. A side that no point
    holds, further out as near to all, ends with the outermost point. Points around a corner
    that a footprint lacks pull both its sides inwards. Source: thesis 4.3.1 and 6.1.3 (rectangle
    instead of ellipse, left to future work); Huber and Ronchetti 2009, Robust Statistics, chapter
    7.
    """
    xy = np.ascontiguousarray(points.xy_cm, dtype=np.float64)
    pitch_cm = element_pitch_cm(elements, cell_cm)
    scale_cm = SCALE_CELLS * pitch_cm if scale_cm is None else scale_cm
    status, x, y, first, second, angle, misfit, rounds = outline_fit(xy, scale_cm, STARTS, STEP)
    n = len(xy)
    if status != OK:
        raise Degenerate(_why(xy, status, rounds))
    first, second = 2.0 * (first + inside_cm), 2.0 * (second + inside_cm)
    return rectangle_of(Oriented(x, y, first, second, angle), misfit, n, rounds, pitch_cm)


fit_rectangle.usual_cm = {"cell_cm": THESIS_PITCH_CM}  # type: ignore[attr-defined]


def _why(xy: Values, status: int, rounds: int) -> str:
    n = len(xy)
    points = "1 point" if n == 1 else f"{n} points"
    bad = n - int(np.isfinite(xy).all(axis=1).sum())
    if bad:
        return f"{bad} of {points} not finite: no rectangle fits"
    if status == NOT_SETTLED and rounds:
        return f"{points}: no rectangle found within {rounds} rounds"
    if status == OUT_OF_RANGE:
        return f"{points} too large or too small for their squares: no rectangle fits"
    return f"{points}: a rectangle needs at least 5 that are not on one line"


def _equations(
    uv: Values, p: Values, scale: float, normal: Values, slope: Values
) -> tuple[float, float]:
    """Return the robust cost; write the weighted normal matrix and slope of half of it.

    ``uv`` has shape (2, N); ``p`` is centre (u, v), half sides and angle, here counter-clockwise
    in (u, v). The second value is the sum of the squared distances' weights.
    """
    u, v, half, other, angle = p.tolist()
    cos, sin = math.cos(angle), math.sin(angle)
    du, dv = uv[0] - u, uv[1] - v
    a, b = du * cos + dv * sin, dv * cos - du * sin
    sa, sb = np.where(a < 0.0, -1.0, 1.0), np.where(b < 0.0, -1.0, 1.0)
    over_a, over_b = np.abs(a) - half, np.abs(b) - other
    corner = (over_a > 0.0) & (over_b > 0.0)
    away = np.hypot(over_a, over_b)
    beside = over_a > over_b
    distance = np.where(corner, away, np.where(beside, over_a, over_b))
    safe = np.where(corner, away, 1.0)
    na = np.where(corner, over_a / safe, beside.astype(float))
    nb = np.where(corner, over_b / safe, 1.0 - beside)
    root = np.sqrt(1.0 + (distance / scale) ** 2)
    weight = 1.0 / root
    ga, gb = na * sa, nb * sb
    rows = np.stack([gb * sin - ga * cos, -ga * sin - gb * cos, -na, -nb, ga * b - gb * a])
    normal[...] = (rows * weight) @ rows.T
    slope[...] = rows @ (weight * distance)
    return float(2.0 * scale * scale * (root - 1.0).sum()), float(weight.sum())


@compiled_twin_of(_equations)
def equations(
    uv: Values, p: Values, scale: float, normal: Values, slope: Values
) -> tuple[float, float]:
    """Do the same in loops."""
    half, other = p[2], p[3]
    cos, sin = math.cos(p[4]), math.sin(p[4])
    row = np.empty(5)
    normal[:, :] = 0.0
    slope[:] = 0.0
    total = weights = 0.0
    for i in range(uv.shape[1]):
        du, dv = uv[0, i] - p[0], uv[1, i] - p[1]
        a, b = du * cos + dv * sin, dv * cos - du * sin
        over_a, over_b = abs(a) - half, abs(b) - other
        if over_a > 0.0 and over_b > 0.0:
            distance = math.sqrt(over_a * over_a + over_b * over_b)
            na, nb = over_a / distance, over_b / distance
        elif over_a > over_b:
            distance, na, nb = over_a, 1.0, 0.0
        else:
            distance, na, nb = over_b, 0.0, 1.0
        root = math.sqrt(1.0 + (distance / scale) ** 2)
        weight = 1.0 / root
        total += root - 1.0
        weights += weight
        ga, gb = (-na if a < 0.0 else na), (-nb if b < 0.0 else nb)
        row[0], row[1] = gb * sin - ga * cos, -ga * sin - gb * cos
        row[2], row[3], row[4] = -na, -nb, ga * b - gb * a
        for k in range(5):
            slope[k] += weight * distance * row[k]
            for m in range(5):
                normal[k, m] += weight * row[k] * row[m]
    return 2.0 * scale * scale * total, weights


@compiled_later
def _boxed(uv: Values, angle: float, p: Values) -> None:
    """Write the points' bounding box along an angle, the outermost sixteenth each way left out."""
    n = uv.shape[1]
    cos, sin = math.cos(angle), math.sin(angle)
    a, b = np.sort(uv[0] * cos + uv[1] * sin), np.sort(uv[1] * cos - uv[0] * sin)
    first, last = n // TRIM, n - 1 - n // TRIM
    p[2], p[3], p[4] = 0.5 * (a[last] - a[first]), 0.5 * (b[last] - b[first]), angle
    mid_a, mid_b = 0.5 * (a[last] + a[first]), 0.5 * (b[last] + b[first])
    p[0], p[1] = mid_a * cos - mid_b * sin, mid_a * sin + mid_b * cos


@compiled_later
def _minimise(uv: Values, p: Values, scale: float, least: float) -> tuple[float, int]:
    """Bring ``p`` to a minimum; return the cost there and the rounds made, < 0 if given up."""
    normal, slope, step = np.empty((5, 5)), np.empty(5), np.empty(5)
    new_normal, new_slope, trial = np.empty((5, 5)), np.empty(5), np.empty(5)
    now, _ = equations(uv, p, scale, normal, slope)
    damping, before = 1e-3, np.inf
    for rounds in range(1, ROUNDS + 1):
        ridge = 1e-9 * (normal[0, 0] + normal[1, 1])
        for k in range(5):
            normal[k, k] += ridge  # a side without points: leave it where it is
        solved = damped_step(normal, slope, damping, step)
        size = promised = 0.0
        for k in range(5):
            trial[k] = p[k] + step[k]
            size = max(size, abs(step[k]))
            promised -= slope[k] * step[k]
        if not solved:
            damping = max(10.0 * damping, 1e-6)
            continue
        trial[2], trial[3] = abs(trial[2]), abs(trial[3])
        new, _ = equations(uv, trial, scale, new_normal, new_slope)
        if new <= now + 1e-15 * uv.shape[1] * scale * scale:
            p[:] = trial
            now = min(new, now)
            normal[:, :] = new_normal
            slope[:] = new_slope
            damping = 0.1 * damping if damping > 1e-12 else 0.0
        else:
            damping = max(10.0 * damping, 1e-6)
        if size <= least or damping > 1e12:
            return now, rounds
        # Along a kink, where the nearest side of a point changes, the search tacks without end.
        if rounds % PATIENCE == 0:
            if now >= before * (1.0 - LEVEL):
                return now, rounds
            before = now
    return now, -ROUNDS


@compiled_later
def _draw_in(uv: Values, p: Values) -> None:
    """Bring a side that lies beyond all points in to the outermost one.

    No point holds it: the search left it anywhere. To no point is it further then.
    """
    cos, sin = math.cos(p[4]), math.sin(p[4])
    a_least, a_most, b_least, b_most = p[2], -p[2], p[3], -p[3]
    for i in range(uv.shape[1]):
        du, dv = uv[0, i] - p[0], uv[1, i] - p[1]
        a, b = du * cos + dv * sin, dv * cos - du * sin
        a_least, a_most = min(a_least, a), max(a_most, a)
        b_least, b_most = min(b_least, b), max(b_most, b)
    a_least, a_most = max(a_least, -p[2]), min(a_most, p[2])
    b_least, b_most = max(b_least, -p[3]), min(b_most, p[3])
    mid_a, mid_b = 0.5 * (a_least + a_most), 0.5 * (b_least + b_most)
    p[0] += mid_a * cos - mid_b * sin
    p[1] += mid_a * sin + mid_b * cos
    p[2], p[3] = 0.5 * (a_most - a_least), 0.5 * (b_most - b_least)


@compiled_later
def outline_fit(xy: Values, scale_cm: float, starts: int, least_step: float) -> Found:
    """Return status, centre (x, y), half sides and angle in cm and as seen, misfit and rounds.

    The best ``starts`` boxes are searched from, each until a step is below ``least_step`` of the
    points' extent.
    """
    status, uv, frame = into_frame(xy)
    if status != OK or xy.shape[0] < 5:
        return (status if status != OK else 1), 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0
    x, y, unit, cos, sin = frame
    scale = scale_cm / unit
    costs, boxes = np.empty(ANGLES), np.empty((ANGLES, 5))
    normal, slope = np.empty((5, 5)), np.empty(5)
    for k in range(ANGLES):
        _boxed(uv, 0.5 * math.pi * k / ANGLES, boxes[k])
        costs[k], _ = equations(uv, boxes[k], scale, normal, slope)
    best, p = np.empty(5), np.empty(5)
    least, rounds, settled = np.inf, 0, False
    for _ in range(starts):
        k = int(np.argmin(costs))
        costs[k] = np.inf
        p[:] = boxes[k]
        found, made = _minimise(uv, p, scale, least_step)
        rounds += abs(made)
        if found < least:
            least, settled = found, made > 0
            best[:] = p
    _draw_in(uv, best)
    u, v = best[0], best[1]
    # v runs as y does, down, in the frame: as seen its angles run the other way.
    angle = -(best[4] + math.atan2(sin, cos))
    return (
        OK if settled else NOT_SETTLED,
        x + unit * (u * cos - v * sin),
        y + unit * (u * sin + v * cos),
        unit * best[2],
        unit * best[3],
        angle,
        unit * math.sqrt(least / xy.shape[0]),
        rounds,
    )
