"""Pairs of sketches for a set of touched elements, begun with straight cuts through it.

Outlines that are convex and do not overlap lie on either side of a straight line.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from tactile_graph.compiled import compiled_as_is
from tactile_graph_likelihood.geometry.outlines import Values
from tactile_graph_likelihood.several.joint.joint_posterior import WIDTH, JointProblem
from tactile_graph_likelihood.several.joint.sketch import settle_sketches
from tactile_graph_likelihood.single.density.problem import Places

ANGLES = 12
OWN = 1.0 / 12.0  # variance of an element's own extent, in pitches
HALF_AXIS = 1.87  # half axis of a sketch over the standard deviation along it
THINNEST = 0.05  # variance across a sketch over the mean one
CLIMBED = 6  # cuts, of 24, that are climbed from, and one more for each pair that is asked for
SAME, SAME_CUT = 0.6, 0.05
"""Distance, in pitches, of the centres of sketches that are the same, and of those of cuts that
leave the same elements on either side: half of 24."""


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
def sketch_of(a: Values, grid: Values, p: Values) -> None:
    """Write the sketch that has the moments of some elements; from the same sums."""
    n, pitch = a[0], grid[2]
    xx, yy = a[3] / n - (a[1] / n) ** 2 + OWN, a[5] / n - (a[2] / n) ** 2 + OWN
    xy = a[4] / n - a[1] * a[2] / (n * n)
    middle, off = 0.5 * (xx + yy), math.hypot(0.5 * (xx - yy), xy)
    p[0] = grid[0] + 0.5 * grid[3] + pitch * a[1] / n
    p[1] = grid[1] + 0.5 * grid[3] + pitch * a[2] / n
    p[2] = math.log(HALF_AXIS * pitch) + 0.5 * math.log(middle + off)
    p[3] = math.log(HALF_AXIS * pitch)
    p[3] += 0.5 * math.log(max(middle - off, THINNEST * middle))
    p[4] = 0.5 * math.atan2(-2.0 * xy, xx - yy)
    p[5] = a[6] / n


@compiled_as_is
def sketch_of_mask(
    mask: NDArray[np.bool_], logs: Values, grid: Values, points: Values
) -> None:  # fmt: skip
    """Write the sketch that has a mask's moments, shape (1, 6)."""
    sums = np.zeros(7)
    for i in range(mask.shape[0]):
        for j in range(mask.shape[1]):
            if mask[i, j]:
                count_in(sums, float(j), float(i), logs[i, j])
    sketch_of(sums, grid, points[0])


@compiled_as_is
def count_in(sums: Values, x: float, y: float, log: float) -> None:
    """Add an element at a column and row, of a log load, to sums as `spread` has them."""
    sums[0] += 1.0
    sums[1] += x
    sums[2] += y
    sums[3] += x * x
    sums[4] += x * y
    sums[5] += y * y
    sums[6] += log


class Across(NamedTuple):
    """The touched elements of a piece in order at each angle.

    Parameters
    ----------
    row, column : ndarray of int64, shape (N,)
    along : ndarray, shape (ANGLES, N)
        How far each lies along the angle's direction, in pitches.
    order : ndarray of int64, shape (ANGLES, N)
        Which comes first, second, …
    """

    row: Places
    column: Places
    along: Values
    order: Places


@compiled_as_is
def across(mask: NDArray[np.bool_]) -> Across:
    """Return the elements of a mask in order at each angle.

    Each order is sorted from that of the angle before, of which few places differ.
    """
    n = 0
    for i in range(mask.shape[0]):
        for j in range(mask.shape[1]):
            n += mask[i, j]
    row, column = np.empty(n, np.int64), np.empty(n, np.int64)
    along, order, last = np.empty((ANGLES, n)), np.empty((ANGLES, n), np.int64), np.arange(n)
    n = 0
    for i in range(mask.shape[0]):
        for j in range(mask.shape[1]):
            if mask[i, j]:
                row[n], column[n] = i, j
                n += 1
    for t in range(ANGLES):
        angle = math.pi * (t + 0.5) / ANGLES
        cos, sin = math.cos(angle), math.sin(angle)
        for i in range(n):
            along[t, i] = cos * column[i] + sin * row[i]
        for i in range(1, n):
            at, k = last[i], i - 1
            far = along[t, at]
            while k >= 0 and (
                along[t, last[k]] > far or (along[t, last[k]] == far and last[k] > at)
            ):
                last[k + 1] = last[k]
                k -= 1
            last[k + 1] = at
        for i in range(n):
            order[t, i] = last[i]
    return Across(row, column, along, order)


@compiled_as_is
def summed(piece: Across, t: int, logs: Values, place: Places) -> Values:
    """Return the sums over the first elements at an angle, shape (N + 1, 7), as `spread` has them.

    Each element's place in the order is written.
    """
    n = piece.row.shape[0]
    sums = np.zeros((n + 1, 7))
    for i in range(n):
        at = piece.order[t, i]
        place[at] = i
        r, c = piece.row[at], piece.column[at]
        x, y = float(c), float(r)
        sums[i + 1, 0] = i + 1.0
        sums[i + 1, 1] = sums[i, 1] + x
        sums[i + 1, 2] = sums[i, 2] + y
        sums[i + 1, 3] = sums[i, 3] + x * x
        sums[i + 1, 4] = sums[i, 4] + x * y
        sums[i + 1, 5] = sums[i, 5] + y * y
        sums[i + 1, 6] = sums[i, 6] + logs[r, c]
    return sums


@compiled_as_is
def cut_at(
    piece: Across, t: int, sums: Values, place: Places, index: Places, least: int
) -> tuple[int, int]:
    """Return after how many elements at an angle halves are fullest, and the neck narrowest.

    0 where there is no such cut, or the same. ``index`` numbers the elements on a grid with a rim.
    """
    along, order = piece.along[t], piece.order[t]
    n = order.shape[0]
    neck, full, thin = 0.0, math.inf, math.inf
    full_at = thin_at = 0
    for k in range(1, n):
        at = order[k - 1]
        for dy in range(3):
            for dx in range(3):
                other = index[piece.row[at] + dy, piece.column[at] + dx]
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
    return full_at, thin_at if thin_at != full_at else 0


@compiled_as_is
def partings(
    problem: JointProblem, mask: NDArray[np.bool_], least: int, found: Values, evidence: Values
) -> None:
    """Write the best pairs of sketches for a piece beside others, and the evidence of each.

    At each of 12 angles the piece is cut where the halves fill their moments' ellipses best, and
    where the neck is narrowest; the halves' moments are where a pair begins. Only those that fill
    their ellipses best of all are climbed from.

    Parameters
    ----------
    problem : JointProblem
        Beside the others.
    mask : ndarray of bool, shape (rows, columns)
        The piece.
    least : int
        Elements on either side.
    found : ndarray, shape (M, 2, 6)
    evidence : ndarray, shape (M,)
        Written, the likeliest at first sight first; -inf where there are fewer.
    """
    (rows, cols), piece = problem.states.shape, across(mask)
    n = piece.row.shape[0]
    index, place = np.full((rows + 2, cols + 2), -1, np.int64), np.empty(n, np.int64)
    for i in range(n):
        index[piece.row[i] + 1, piece.column[i] + 1] = i
    starts, area = np.zeros((2 * ANGLES, 2, WIDTH)), np.full(2 * ANGLES, math.inf)
    for t in range(ANGLES):
        sums = summed(piece, t, problem.logs, place)
        ways = cut_at(piece, t, sums, place, index, least)
        for way in range(2):
            s, k = 2 * t + way, ways[way]
            if k > 0:
                sketch_of(sums[k], problem.grid, starts[s, 0])
                sketch_of(sums[n] - sums[k], problem.grid, starts[s, 1])
                area[s] = spread(sums[k]) + spread(sums[n] - sums[k])
    worth = np.full(2 * ANGLES, -math.inf)
    for _ in range(CLIMBED + evidence.shape[0]):
        fullest = 0
        for s in range(2 * ANGLES):
            if area[s] < area[fullest]:
                fullest = s
        if area[fullest] == math.inf:
            break
        area[fullest] = math.inf
        for s in range(2 * ANGLES):
            if area[s] < math.inf and _same(starts[fullest], starts[s], SAME_CUT * problem.grid[2]):
                area[s] = math.inf
        worth[fullest] = settle_sketches(problem, starts[fullest], 0, 1)
    for m in range(evidence.shape[0]):
        evidence[m], best = -math.inf, 0
        for s in range(2 * ANGLES):
            if worth[s] > worth[best]:
                best = s
        if worth[best] == -math.inf:
            continue
        for k in range(2):
            for x in range(WIDTH):
                found[m, k, x] = starts[best, k, x]
        for s in range(2 * ANGLES):
            if _same(found[m], starts[s], SAME * problem.grid[2]):
                worth[s] = -math.inf
        evidence[m] = settle_sketches(problem, found[m], 1, 2)


@compiled_as_is
def _same(one: Values, other: Values, far: float) -> bool:
    """Return whether two pairs of sketches lie at the same places."""
    straight = crossed = 0.0
    for k in range(2):
        for m in range(2):
            straight = max(straight, abs(one[k, m] - other[k, m]))
            crossed = max(crossed, abs(one[k, m] - other[1 - k, m]))
    return min(straight, crossed) < far
