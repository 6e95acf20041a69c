"""The likelihood of several outlines at once: their loads add up, then elements read the sum.

Other outlines that stay as they are enter by the load and the coverage that they bring to each
element.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from tactile_graph.compiled import compiled_as_is
from tactile_graph_likelihood.geometry.covered import window
from tactile_graph_likelihood.geometry.outline_prior import SMALLEST, log_prior
from tactile_graph_likelihood.geometry.outlines import REGULAR, Values, unknowns
from tactile_graph_likelihood.single.element_terms import (
    LEAST,
    OFF,
    UNKNOWN,
    States,
    terms,
)
from tactile_graph_likelihood.single.information import (
    SLIVER,
    STEP,
    Information,
    mirror,
    scatter_of,
    score_of,
    shares_with_slopes,
)
from tactile_graph_likelihood.single.load_shares import foam_margin, shares_around
from tactile_graph_likelihood.single.log_posterior import LN_TWO_PI
from tactile_graph_likelihood.single.problem import Places

WIDTH = 6
"""Columns of a table of points."""

OVERLAP = 0.1
"""Standard deviation of the coverage by which outlines, together, may exceed an element."""

MIDDLE, SPREAD = 9, 10
"""Places in a prior vector of several outlines, after those of `outline_prior`: mean and standard
deviation of the logarithm of an outline's load."""


class Outlines(NamedTuple):
    """Outlines as rows of a table.

    ``kinds`` and ``corners`` are as in `outlines`, shape (N,); ``points``, shape (N, 6), hold an
    outline's numbers, the logarithm of its load, and zeros.
    """

    kinds: Places
    corners: Places
    points: Values


class JointProblem(NamedTuple):
    """What the posterior of outlines depends on, beside others that stay as they are.

    ``grid``, ``logs``, ``states`` and ``noise`` are as in `Problem`; ``prior``, shape (11,), has
    `MIDDLE` and `SPREAD` too; ``load`` and ``share``, shape (rows, columns), are the load and
    the coverage that the others bring to each element: zeros for none.
    """

    grid: Values
    logs: Values
    states: States
    noise: Values
    prior: Values
    load: Values
    share: Values


class Coverage(NamedTuple):
    """What outlines bring to each element, all (…, rows, columns).

    ``expected`` and ``total`` are load and coverage with those of the others; ``own`` is the
    coverage of each outline, ``rise`` its slope along each number of its point.
    """

    expected: Values
    total: Values
    own: Values
    rise: Values


@compiled_as_is
def add_outline(problem: JointProblem, outlines: Outlines, k: int) -> None:
    """Add what one of some outlines brings to each element to what the others do."""
    lay(problem, outlines, k, 0, 0, problem.load, problem.share)


@compiled_as_is
def add_outlines(problem: JointProblem, outlines: Outlines) -> None:
    """Add what all of some outlines bring to each element to what the others do."""
    for k in range(outlines.kinds.shape[0]):
        add_outline(problem, outlines, k)


@compiled_as_is
def lay(
    problem: JointProblem, outlines: Outlines, k: int, row: int, column: int, load: Values,
    share: Values,
) -> None:  # fmt: skip
    """Add what one of some outlines brings to a load and a coverage that begin at an element."""
    kind, corners, p = outlines.kinds[k], outlines.corners[k], outlines.points[k]
    box, own = shares_around(kind, corners, p, problem.grid, problem.noise, problem.load.shape)
    scale, r, c = math.exp(p[unknowns(kind, corners)]), box[0] - row, box[1] - column
    for i in range(own.shape[0]):
        for j in range(own.shape[1]):
            load[r + i, c + j] += scale * own[i, j]
            share[r + i, c + j] += own[i, j]


@compiled_as_is
def overlap(share: Values) -> float:
    """Return by how much the log density falls where outlines overlap."""
    total = 0.0
    for i in range(share.shape[0]):
        for j in range(share.shape[1]):
            if share[i, j] > 1.0:
                total += ((share[i, j] - 1.0) / OVERLAP) ** 2
    return 0.5 * total


@compiled_as_is
def lightest(noise: Values) -> float:
    """Return the least logarithm of an outline's load: what shows twice over."""
    least: float = noise[LEAST] + math.log(2.0)
    return least


@compiled_as_is
def smallest(kind: int, corners: int, prior: Values) -> float:
    """Return the least size of an outline; a regular polygon's sides keep it from its centre."""
    least: float = prior[SMALLEST]
    return least / math.cos(math.pi / corners) if kind == REGULAR else least


@compiled_as_is
def log_rest_of(problem: JointProblem, outlines: Outlines) -> float:
    """Return the log prior density of all outlines and their loads, -inf where it is zero."""
    kinds, corners, points = outlines
    noise, prior = problem.noise, problem.prior
    total = 0.0
    for k in range(kinds.shape[0]):
        load = points[k, unknowns(kinds[k], corners[k])]
        if load < lightest(noise) or points[k, 2] < smallest(kinds[k], corners[k], prior):
            return -math.inf
        off = (load - prior[MIDDLE]) / prior[SPREAD]
        total -= 0.5 * (off * off + LN_TWO_PI) + math.log(prior[SPREAD])
        total += log_prior(kinds[k], corners[k], points[k], prior)
    return total


@compiled_as_is
def gain(problem: JointProblem, outlines: Outlines) -> float:
    """Return what outlines add to the log likelihood of an image where others already lie."""
    grid, logs, states, noise = problem.grid, problem.logs, problem.states, problem.noise
    (rows, cols), margin = states.shape, foam_margin(grid, noise)
    r0, c0, r1, c1 = rows, cols, 0, 0
    for k in range(outlines.kinds.shape[0]):
        kind, corners, p = outlines.kinds[k], outlines.corners[k], outlines.points[k]
        box = window(kind, corners, p, grid, rows, cols, margin)
        if box[2] > 0 and box[3] > 0:
            r0, c0 = min(r0, box[0]), min(c0, box[1])
            r1, c1 = max(r1, box[0] + box[2]), max(c1, box[1] + box[3])
    if r1 <= r0 or c1 <= c0:
        return 0.0
    load, share = problem.load[r0:r1, c0:c1].copy(), problem.share[r0:r1, c0:c1].copy()
    before = terms(load, 0.0, r0, c0, logs, states, noise) - overlap(share)
    for k in range(outlines.kinds.shape[0]):
        lay(problem, outlines, k, r0, c0, load, share)
    return terms(load, 0.0, r0, c0, logs, states, noise) - overlap(share) - before


@compiled_as_is
def slopes(problem: JointProblem, outlines: Outlines, out: Information) -> None:
    """Write the slope of `gain` and its information, shape (6 N,) and (6 N, 6 N).

    Places of numbers that an outline does not have get a one on the diagonal. As in
    `information.information`; an element under several outlines couples them.
    """
    kinds, corners, points = outlines
    grid, noise, states = problem.grid, problem.noise, problem.states
    rows, cols = states.shape
    count = kinds.shape[0]
    expected, total = problem.load.copy(), problem.share.copy()
    own, size = np.zeros((count, rows, cols)), count * WIDTH
    rise = np.zeros((size, rows, cols))
    for x in range(size):
        out.slope[x] = 0.0
        for y in range(size):
            out.matrix[x, y] = 0.0
    margin = foam_margin(grid, noise) + grid[2] * STEP
    for k in range(count):
        kind, n, first = kinds[k], corners[k], unknowns(kinds[k], corners[k])
        for m in range(first + 1, WIDTH):
            out.matrix[k * WIDTH + m, k * WIDTH + m] = 1.0
        box = window(kind, n, points[k], grid, rows, cols, margin)
        if box[2] <= 0 or box[3] <= 0:
            continue
        scale, r, c = math.exp(points[k, first]), box[0], box[1]
        steep = np.zeros((first, box[2], box[3]))
        here, _ = shares_with_slopes(kind, n, points[k], grid, noise, box, rows, cols, steep)
        for i in range(box[2]):
            for j in range(box[3]):
                own[k, r + i, c + j] = here[i, j]
                expected[r + i, c + j] += scale * here[i, j]
                total[r + i, c + j] += here[i, j]
                for m in range(first):
                    rise[k * WIDTH + m, r + i, c + j] = steep[m, i, j]
    _sum_up(problem, outlines, Coverage(expected, total, own, rise), out)


@compiled_as_is
def _sum_up(
    problem: JointProblem, outlines: Outlines, coverage: Coverage, out: Information
) -> None:
    """Add each element's part to slope and information."""
    kinds, corners, points = outlines
    expected, total, own, rise = coverage
    logs, states, noise = problem.logs, problem.states, problem.noise
    slope, matrix = out
    rows, cols = states.shape
    scatter, size, count = scatter_of(noise), slope.shape[0], kinds.shape[0]
    along, tight, used = np.zeros(size), np.zeros(size), np.empty(size, np.int64)
    firsts, scales = np.empty(count, np.int64), np.empty(count)
    for k in range(count):
        firsts[k] = unknowns(kinds[k], corners[k])
        scales[k] = math.exp(points[k, firsts[k]])
    for i in range(rows):
        for j in range(cols):
            n = 0
            for k in range(count):
                if own[k, i, j] <= 0.0:
                    continue
                first, scale = firsts[k], scales[k]
                floor = max(expected[i, j], SLIVER * scale)
                for m in range(first):
                    at = k * WIDTH + m
                    along[n], tight[n] = scale * rise[at, i, j] / floor, rise[at, i, j]
                    used[n] = at
                    n += 1
                along[n], tight[n] = scale * own[k, i, j] / expected[i, j], 0.0
                used[n] = k * WIDTH + first
                n += 1
            if n == 0:
                continue
            score, weight = 0.0, 0.0
            state = states[i, j]
            if state != UNKNOWN:
                log = noise[LEAST] if state == OFF else logs[i, j]
                _, found = score_of(state, log, math.log(expected[i, j]), scatter)
                score, weight = found[0], found[1]
            excess = (total[i, j] - 1.0) / (OVERLAP * OVERLAP)
            push = 1.0 / (OVERLAP * OVERLAP) if excess > 0.0 else 0.0
            for a_ in range(n):
                x = used[a_]
                slope[x] += score * along[a_]
                if push > 0.0:
                    slope[x] -= excess * tight[a_]
                for b_ in range(a_ + 1):
                    y = used[b_]
                    matrix[x, y] += weight * along[a_] * along[b_] + push * tight[a_] * tight[b_]
    mirror(matrix)
