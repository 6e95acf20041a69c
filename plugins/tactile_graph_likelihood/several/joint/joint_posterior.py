"""The likelihood of several outlines at once: their loads add up, then elements read the sum.

Other outlines that stay as they are enter by the load and the coverage that they bring to each
element.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from tactile_graph.compiled import compiled_as_is
from tactile_graph_likelihood.geometry.covered import Box, window
from tactile_graph_likelihood.geometry.outline_prior import SMALLEST, log_prior
from tactile_graph_likelihood.geometry.outlines import REGULAR, Values, unknowns
from tactile_graph_likelihood.single.density.element_terms import (
    LEAST,
    OFF,
    UNKNOWN,
    States,
    terms,
)
from tactile_graph_likelihood.single.density.information import (
    MOST_ODDS,
    SLIVER,
    STEP,
    Information,
    mirror,
    scatter_of,
    score_of,
    shares_with_slopes,
)
from tactile_graph_likelihood.single.density.load_shares import foam_margin, shares_around
from tactile_graph_likelihood.single.density.log_posterior import LN_TWO_PI
from tactile_graph_likelihood.single.density.pressure_slopes import Laid
from tactile_graph_likelihood.single.density.problem import Places

NONE_ESTIMATED = np.zeros(0, np.int64)
"""Of the noise, which several outlines share as it is told."""

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


def apart(problem: JointProblem) -> JointProblem:
    """Return a problem on which more may be laid: its load and share are copies."""
    grid, logs, states, noise, prior, load, share = problem  # `_replace` takes ten times as long
    return JointProblem(grid, logs, states, noise, prior, load.copy(), share.copy())


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
def window_of(problem: JointProblem, outlines: Outlines, margin: float) -> Box:
    """Return the window of elements that outlines, and a margin around them, reach."""
    rows, cols = problem.states.shape
    r0, c0, r1, c1 = rows, cols, 0, 0
    for k in range(outlines.kinds.shape[0]):
        kind, corners, p = outlines.kinds[k], outlines.corners[k], outlines.points[k]
        box = window(kind, corners, p, problem.grid, rows, cols, margin)
        if box[2] > 0 and box[3] > 0:
            r0, c0 = min(r0, box[0]), min(c0, box[1])
            r1, c1 = max(r1, box[0] + box[2]), max(c1, box[1] + box[3])
    return r0, c0, max(r1 - r0, 0), max(c1 - c0, 0)


@compiled_as_is
def gain(problem: JointProblem, outlines: Outlines) -> float:
    """Return what outlines add to the log likelihood of an image where others already lie."""
    logs, states, noise = problem.logs, problem.states, problem.noise
    row, column, rows, cols = window_of(problem, outlines, foam_margin(problem.grid, noise))
    if rows == 0 or cols == 0:
        return 0.0
    load = problem.load[row : row + rows, column : column + cols].copy()
    share = problem.share[row : row + rows, column : column + cols].copy()
    before = terms(load, 0.0, row, column, logs, states, noise) - overlap(share)
    for k in range(outlines.kinds.shape[0]):
        lay(problem, outlines, k, row, column, load, share)
    return terms(load, 0.0, row, column, logs, states, noise) - overlap(share) - before


@compiled_as_is
def slopes(problem: JointProblem, outlines: Outlines, out: Information) -> float:
    """Write the slope of `gain` and its information, shape (6 N,) and (6 N, 6 N); return `gain`.

    Places of numbers that an outline does not have get a one on the diagonal. As in
    `information.information`; an element under several outlines couples them.
    """
    kinds, corners, points = outlines
    grid, noise = problem.grid, problem.noise
    count = kinds.shape[0]
    size, margin = count * WIDTH, foam_margin(grid, noise) + grid[2] * STEP
    out.slope[:] = 0.0
    out.matrix[:] = 0.0
    for k in range(count):
        for m in range(unknowns(kinds[k], corners[k]) + 1, WIDTH):
            out.matrix[k * WIDTH + m, k * WIDTH + m] = 1.0
    row, column, rows, cols = window_of(problem, outlines, margin)
    if rows == 0 or cols == 0:
        return 0.0
    expected = problem.load[row : row + rows, column : column + cols].copy()
    total = problem.share[row : row + rows, column : column + cols].copy()
    own, rise = np.zeros((count, rows, cols)), np.zeros((size, rows, cols))
    for k in range(count):
        kind, n, first = kinds[k], corners[k], unknowns(kinds[k], corners[k])
        box = window(
            kind, n, points[k], grid, problem.states.shape[0], problem.states.shape[1], margin
        )
        if box[2] <= 0 or box[3] <= 0:
            continue
        scale, r, c = math.exp(points[k, first]), box[0] - row, box[1] - column
        steep = np.zeros((first, box[2], box[3]))
        laid = Laid(kind, n, points[k], grid, noise, box)
        here, _ = shares_with_slopes(
            laid, problem.states.shape[0], problem.states.shape[1], NONE_ESTIMATED, steep
        )
        for i in range(box[2]):
            for j in range(box[3]):
                own[k, r + i, c + j] = here[i, j]
                expected[r + i, c + j] += scale * here[i, j]
                total[r + i, c + j] += here[i, j]
        for m in range(first):
            for i in range(box[2]):
                for j in range(box[3]):
                    rise[k * WIDTH + m, r + i, c + j] = steep[m, i, j]
    return _sum_up(problem, outlines, row, column, Coverage(expected, total, own, rise), out)


@compiled_as_is
def _sum_up(
    problem: JointProblem, outlines: Outlines, row: int, column: int, coverage: Coverage,
    out: Information,
) -> float:  # fmt: skip
    """Add each element's part to slope and information; return what all add to the likelihood."""
    kinds, corners, points = outlines
    expected, total, own, rise = coverage
    noise, scatter, count = problem.noise, scatter_of(problem.noise), kinds.shape[0]
    size = count * WIDTH
    along, tight, used = np.empty(size), np.empty(size), np.empty(size, np.int64)
    firsts, scales = np.empty(count, np.int64), np.empty(count)
    for k in range(count):
        firsts[k] = unknowns(kinds[k], corners[k])
        scales[k] = math.exp(points[k, firsts[k]])
    found, odds, per_square = 0.0, 1.0, 1.0 / (OVERLAP * OVERLAP)
    for i in range(expected.shape[0]):
        for j in range(expected.shape[1]):
            n = 0
            for k in range(count):
                if own[k, i, j] <= 0.0:
                    continue
                first, scale = firsts[k], scales[k]
                floor = max(expected[i, j], SLIVER * scale)
                for m in range(first):
                    at = k * WIDTH + m
                    if rise[at, i, j] != 0.0:
                        along[n], tight[n] = scale * rise[at, i, j] / floor, rise[at, i, j]
                        used[n] = at
                        n += 1
                along[n], tight[n] = scale * own[k, i, j] / expected[i, j], 0.0
                used[n] = k * WIDTH + first
                n += 1
            if n == 0:
                continue
            score, weight = 0.0, 0.0
            state = problem.states[row + i, column + j]
            if state != UNKNOWN:
                log = noise[LEAST] if state == OFF else problem.logs[row + i, column + j]
                likelier, its = score_of(state, log, math.log(expected[i, j]), scatter)
                score, weight = its[0], its[1]
                odds *= likelier
                before = problem.load[row + i, column + j]
                if before > 0.0:
                    likelier, _ = score_of(state, log, math.log(before), scatter)
                    odds /= likelier
                if not 1.0 / MOST_ODDS < odds < MOST_ODDS:
                    found += math.log(odds)
                    odds = 1.0
            over, push = total[i, j] - 1.0, 0.0
            if over > 0.0:
                push, beyond = per_square, max(problem.share[row + i, column + j] - 1.0, 0.0)
                found -= 0.5 * per_square * (over * over - beyond * beyond)
            for a in range(n):
                x, by_load, by_share = used[a], weight * along[a], push * tight[a]
                out.slope[x] += score * along[a] - over * by_share
                for b in range(a + 1):
                    out.matrix[x, used[b]] += by_load * along[b] + by_share * tight[b]
    mirror(out.matrix)
    return found + math.log(odds)
