"""Straight cuts through a set of touched elements: outlines that do not overlap lie either side."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from tactile_graph.compiled import compiled_as_is
from tactile_graph_likelihood.geometry.outlines import ELLIPSE, Values
from tactile_graph_likelihood.several.joint_posterior import WIDTH, JointProblem, Outlines, gain
from tactile_graph_likelihood.single.element_terms import ON, States
from tactile_graph_likelihood.single.search import THINNEST, outline_of_moments

Labels = NDArray[np.int64]

ANGLES = 12
OWN = 1.0 / 12.0  # variance of an element's own extent, in pitches


@compiled_as_is
def spread(a: Values) -> float:
    """Return the area of the ellipse that has the moments of some elements, in elements.

    From sums over them: number, x, y, xx, xy, yy and log loads.
    """
    n = a[0]
    xx, yy = a[3] / n - (a[1] / n) ** 2 + OWN, a[5] / n - (a[2] / n) ** 2 + OWN
    xy = a[4] / n - a[1] * a[2] / (n * n)
    return 4.0 * math.pi * math.sqrt(max(xx * yy - xy * xy, OWN * OWN))


@compiled_as_is
def ellipse_of(a: Values, grid: Values, p: Values) -> None:
    """Write the point of that ellipse, in cm; from the same sums."""
    n, pitch = a[0], grid[2]
    found = np.empty(7)
    found[0], found[6] = n, a[6] / n
    found[1] = grid[0] + 0.5 * grid[3] + pitch * a[1] / n
    found[2] = grid[1] + 0.5 * grid[3] + pitch * a[2] / n
    found[3] = (a[3] / n - (a[1] / n) ** 2 + OWN) * pitch * pitch
    found[4] = (a[4] / n - a[1] * a[2] / (n * n)) * pitch * pitch
    found[5] = (a[5] / n - (a[2] / n) ** 2 + OWN) * pitch * pitch
    outline_of_moments(ELLIPSE, 0, found, 0.0, THINNEST, p)


def cuts(problem: JointProblem, least: int, sides: States) -> tuple[Values, float]:
    """Propose cuts of a piece: at each of 12 angles the fullest halves, and the narrowest neck.

    Parameters
    ----------
    problem : JointProblem
        In its states only the piece's elements are on; nothing lies beside.
    least : int
        Elements on either side.
    sides : ndarray of uint8, shape (24, rows, columns)
        Written: 1 and 2 on the two sides of each cut, 0 off the piece.

    Returns
    -------
    (ndarray, float)
        What the two ellipses with the halves' moments add to the log likelihood, shape (24,), -inf
        where there is no cut; and what the piece's one ellipse does.
    """
    r, c = np.nonzero(problem.states == ON)
    angles = np.pi * (np.arange(ANGLES) + 0.5) / ANGLES
    along = np.cos(angles)[:, None] * c + np.sin(angles)[:, None] * r
    across = Across(r, c, along, np.argsort(along, axis=1, kind="stable"))
    return cuts_across.call(problem, across, least, sides)


class Across(NamedTuple):
    """The touched elements of a piece in order at each angle.

    Parameters
    ----------
    row, column : ndarray of int64, shape (N,)
    along : ndarray, shape (ANGLES, N)
        How far each lies along the angle's direction, in pitches.
    order : ndarray of int64, shape (ANGLES, N)
        Which comes first, second, …; sorted by numpy, since a sort compiles for a second.
    """

    row: NDArray[np.int64]
    column: NDArray[np.int64]
    along: Values
    order: NDArray[np.int64]


@compiled_as_is
def cuts_across(
    problem: JointProblem, across: Across, least: int, sides: States
) -> tuple[Values, float]:
    """Return what `cuts` returns."""
    grid, logs = problem.grid, problem.logs
    rows, cols = problem.states.shape
    r, c = across.row, across.column
    n = r.shape[0]
    index = np.full((rows + 2, cols + 2), -1, np.int64)
    for i in range(n):
        index[r[i] + 1, c[i] + 1] = i
    found = np.full(2 * ANGLES, -math.inf)
    sums, place = np.zeros((n + 1, 7)), np.empty(n, np.int64)
    kinds, corners = np.full(2, ELLIPSE), np.zeros(2, np.int64)
    points = np.zeros((2, WIDTH))
    halves = Outlines(kinds, corners, points)
    for t in range(ANGLES):
        along, order = across.along[t], across.order[t]
        for i in range(n):
            at = order[i]
            place[at] = i
            x, y = float(c[at]), float(r[at])
            sums[i + 1, 0] = i + 1.0
            sums[i + 1, 1] = sums[i, 1] + x
            sums[i + 1, 2] = sums[i, 2] + y
            sums[i + 1, 3] = sums[i, 3] + x * x
            sums[i + 1, 4] = sums[i, 4] + x * y
            sums[i + 1, 5] = sums[i, 5] + y * y
            sums[i + 1, 6] = sums[i, 6] + logs[r[at], c[at]]
        neck, full, thin = 0.0, math.inf, math.inf
        full_at = thin_at = 0
        for k in range(1, n):
            at = order[k - 1]
            for dy in range(3):
                for dx in range(3):
                    other = index[r[at] + dy, c[at] + dx]
                    if other >= 0 and other != at:
                        neck += 1.0 if place[other] >= k else -1.0
            if k < least or k > n - least or along[order[k]] - along[at] < 1e-9:
                continue
            area = spread(sums[k]) + spread(sums[n] - sums[k])
            if area < full:
                full, full_at = area, k
            narrow = neck * (1.0 / k + 1.0 / (n - k))
            if narrow < thin:
                thin, thin_at = narrow, k
        for way in range(2):
            k = full_at if way == 0 else thin_at
            if k == 0 or (way == 1 and k == full_at):
                continue
            ellipse_of(sums[k], grid, points[0])
            ellipse_of(sums[n] - sums[k], grid, points[1])
            found[2 * t + way] = gain(problem, halves)
            for i in range(n):
                sides[2 * t + way, r[i], c[i]] = 1 if place[i] < k else 2
    ellipse_of(sums[n], grid, points[0])
    whole = gain(problem, Outlines(kinds[:1], corners[:1], points[:1]))
    return found, whole


@compiled_as_is
def components(on: NDArray[np.bool_], reach: int) -> Labels:
    """Return a label from 1 for each set of touched elements no more than ``reach`` apart."""
    rows, cols = on.shape
    labels = np.zeros((rows, cols), np.int64)
    todo = np.empty((rows * cols, 2), np.int64)
    count = 0
    for i in range(rows):
        for j in range(cols):
            if not on[i, j] or labels[i, j] > 0:
                continue
            count += 1
            labels[i, j] = count
            todo[0, 0], todo[0, 1] = i, j
            left = 1
            while left > 0:
                left -= 1
                r, c = todo[left, 0], todo[left, 1]
                for y in range(max(r - reach, 0), min(r + reach + 1, rows)):
                    for x in range(max(c - reach, 0), min(c + reach + 1, cols)):
                        if on[y, x] and labels[y, x] == 0:
                            labels[y, x] = count
                            todo[left, 0], todo[left, 1] = y, x
                            left += 1
    return labels
