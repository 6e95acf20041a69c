"""Where an outline's rim runs through a grid, row by row, and what it covers there.

On a large pad most of what an outline covers it covers whole. A convex outline covers one run of
each row whole, and touches one that is a little longer: only the elements between the two ends
need geometry.
"""

from __future__ import annotations

import math
from typing import TypeAlias

import numpy as np
from numpy.typing import NDArray

from tactile_graph.compiled import compiled_as_is
from tactile_graph_likelihood.geometry.covered import Box, window
from tactile_graph_likelihood.geometry.outlines import DISC, ELLIPSE, OVAL, Values, corners_of
from tactile_graph_likelihood.geometry.oval import as_ellipse
from tactile_graph_likelihood.single.element_terms import ON, UNKNOWN
from tactile_graph_likelihood.single.problem import Problem

Runs: TypeAlias = NDArray[np.int64]
"""Of each row: first column touched, first covered whole, one past those, one past the touched."""

ROUNDING = 1e-9  # pitches by which runs are looked at too short, and the rim too wide
ROUND_NUMBERS = 7
FEW_BESIDE, SHARE_BESIDE = 3.0, 0.02  # touched elements beside an outline that may be strays


@compiled_as_is
def drawn_as(kind: int, corners: int, p: Values) -> tuple[Values, Values]:
    """Return what a convex outline's chords follow from.

    Returns
    -------
    (ndarray, ndarray)
        Of a round one centre x and y, half width, half height, slant, root and stretch, shape
        (7,), as in `coverage_ellipse`; of any other its corners, shape (N, 2). The other is empty.
    """
    if kind not in (DISC, ELLIPSE, OVAL):
        return np.empty(0), corners_of(kind, corners, p)
    if kind == OVAL:
        p = as_ellipse(p)
    out = np.empty(ROUND_NUMBERS)
    out[0], out[1] = p[0], p[1]
    if kind == DISC:
        out[2] = out[3] = p[2]
        out[4], out[5], out[6] = 0.0, 1.0, 1.0
    else:
        cos, sin = math.cos(p[4]), -math.sin(p[4])
        wide, high = math.hypot(p[2] * cos, p[3] * sin), math.hypot(p[2] * sin, p[3] * cos)
        out[2], out[3] = wide, high
        out[4] = (p[2] - p[3]) * (p[2] + p[3]) * cos * sin / (wide * wide)
        out[5] = p[2] * p[3] / (wide * wide)
        out[6] = (wide / high) * (wide / high)
    return out, np.empty((0, 2))


@compiled_as_is
def _reach_of_round(
    numbers: Values, top: float, bottom: float
) -> tuple[float, float, float, float]:
    """Return how far a round outline reaches between two heights, and how far it does all over."""
    x, y, wide, high = numbers[0], numbers[1], numbers[2], numbers[3]
    slant, root, stretch = numbers[4], numbers[5], numbers[6]
    h0, h1 = max(top - y, -high), min(bottom - y, high)
    if h0 >= h1:
        return math.inf, -math.inf, math.inf, -math.inf
    half0 = root * math.sqrt(max((high - h0) * (high + h0), 0.0))
    half1 = root * math.sqrt(max((high - h1) * (high + h1), 0.0))
    left0, left1 = (slant * h0 - half0) * stretch, (slant * h1 - half1) * stretch
    right0, right1 = (slant * h0 + half0) * stretch, (slant * h1 + half1) * stretch
    at = slant * wide
    left = -wide if h0 < -at < h1 else min(left0, left1)
    right = wide if h0 < at < h1 else max(right0, right1)
    if top - y <= -high or bottom - y >= high:
        return x + left, x + right, math.inf, -math.inf
    return x + left, x + right, x + max(left0, left1), x + min(right0, right1)


@compiled_as_is
def _reach_of_polygon(xy: Values, top: float, bottom: float) -> tuple[float, float, float, float]:
    """Return the same for a convex polygon."""
    n = xy.shape[0]
    left0 = left1 = left = math.inf
    right0 = right1 = right = -math.inf
    for i in range(n):
        j = i + 1 if i + 1 < n else 0
        xa, ya, xb, yb = xy[i, 0], xy[i, 1], xy[j, 0], xy[j, 1]
        if top <= ya <= bottom:
            left, right = min(left, xa), max(right, xa)
        if ya == yb:
            continue
        low, high = min(ya, yb), max(ya, yb)
        slope = (xb - xa) / (yb - ya)
        if low <= top <= high:
            x = xa + (top - ya) * slope
            left0, right0 = min(left0, x), max(right0, x)
        if low <= bottom <= high:
            x = xa + (bottom - ya) * slope
            left1, right1 = min(left1, x), max(right1, x)
    left, right = min(left, left0, left1), max(right, right0, right1)
    if left0 > right0 or left1 > right1:
        return left, right, math.inf, -math.inf
    return left, right, max(left0, left1), min(right0, right1)


@compiled_as_is
def runs_of(numbers: Values, xy: Values, grid: Values, box: Box, slack: float) -> Runs:
    """Return which elements of a window's rows an outline touches, and which it covers whole.

    Parameters
    ----------
    numbers, xy
        As `drawn_as` gives them.
    grid, box
        As in `covered.covered`.
    slack : float
        In cm: the runs hold for any outline whose edge lies within so much of this one's.

    Returns
    -------
    ndarray of int64, shape (rows, 4)
        Columns of the image: first touched, first covered whole, one past those, one past the
        touched.
    """
    row, column, rows, columns = box
    pitch, side, left = grid[2], grid[3], grid[0]
    slack += ROUNDING * pitch
    runs = np.empty((rows, 4), np.int64)
    end = column + columns
    for i in range(rows):
        top = grid[1] + (row + i) * pitch
        if xy.shape[0] == 0:
            reach = _reach_of_round(numbers, top - slack, top + side + slack)
        else:
            reach = _reach_of_polygon(xy, top - slack, top + side + slack)
        first = last = a = b = column
        if reach[0] <= reach[1]:
            from_left = (reach[0] - slack - side - left) / pitch
            to_right = (reach[1] + slack - left) / pitch
            first = math.floor(min(max(from_left, column - 1.0), end)) + 1
            last = math.ceil(max(min(to_right, float(end)), float(column)))
            last = max(first, last)
        if reach[2] <= reach[3]:
            from_left = (reach[2] + slack - left) / pitch
            to_right = (reach[3] - slack - side - left) / pitch
            a = math.ceil(max(min(from_left, float(end)), float(column)))
            b = math.floor(min(max(to_right, column - 1.0), end - 1.0)) + 1
        a = min(max(a, first), last)
        b = min(max(b, a), last)
        runs[i, 0], runs[i, 1], runs[i, 2], runs[i, 3] = first, a, b, last
    return runs


@compiled_as_is
def rim_count(runs: Runs) -> int:
    """Return how many elements are touched but not in the middle of their row."""
    count = 0
    for i in range(runs.shape[0]):
        count += runs[i, 1] - runs[i, 0] + runs[i, 3] - runs[i, 2]
    return count


@compiled_as_is
def touched_beside(problem: Problem, p: Values) -> bool:
    """Return whether more is touched within a pitch beside an outline than strays may be.

    An edge that lies in a gap does not feel the touched row beyond it.
    """
    grid, (rows, columns) = problem.grid, problem.states.shape
    box = window(problem.kind, problem.corners, p, grid, rows, columns, grid[2])
    numbers, xy = drawn_as(problem.kind, problem.corners, p)
    near, wide = runs_of(numbers, xy, grid, box, 0.0), runs_of(numbers, xy, grid, box, grid[2])
    known, on = 0, 0
    for i in range(box[2]):
        for column in range(wide[i, 0], wide[i, 3]):
            if near[i, 0] <= column < near[i, 3]:
                continue
            state = problem.states[box[0] + i, column]
            known += 1 if state != UNKNOWN else 0
            on += 1 if state == ON else 0
    return on > FEW_BESIDE + SHARE_BESIDE * known
