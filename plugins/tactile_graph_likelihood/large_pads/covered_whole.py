"""``CoveredWhole``: readings that outlines of one search all cover whole, as few numbers.

What such an element adds to the likelihood depends on the outline by its load alone, so elements
that read nearly the same need not be looked at one by one. Their logarithms are sorted into bins;
two weighted readings stand for each bin, with its readings' number, mean, variance and skewness
(Gauss's rule for them), so that what they add is right to the third power of their spread.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from tactile_graph.compiled import compiled_as_is
from tactile_graph_likelihood.geometry.covered import Box, window
from tactile_graph_likelihood.geometry.outlines import Values, bounds, unknowns
from tactile_graph_likelihood.large_pads.rim import Runs, drawn_as, runs_of
from tactile_graph_likelihood.single.density.element_terms import (
    CONTRAST,
    FOAM,
    LEAST,
    OFF,
    ON,
    SIGMA,
    SQRT_HALF,
    VOIDS,
    on_level,
)
from tactile_graph_likelihood.single.density.load_shares import is_even
from tactile_graph_likelihood.single.density.log_posterior import noise_at
from tactile_graph_likelihood.single.density.problem import Problem

BINS_A_SIGMA, REACH = 12, 12
"""Bins a standard deviation of ln gain, and deviations from the middle beyond which a reading has
nothing to do with the object."""
FAR, NARROWER, LARGER = 2.0, 0.65, 1.5
"""By how many deviations the load may move, and how the deviation may change, before readings are
sorted anew."""
LARGE = 3000.0  # elements around an outline from which on it is looked at by its rim
MARGIN, KEPT = 2.0, 0.8
"""Pitches by which an outline may move so that it still covers all, and those at which that is
looked for anew."""
ENOUGH = 0.85  # of what might be covered whole
FLAT = 1e-9  # variance of a bin, over its width squared, that is none

COUNT, OFFS, NODES, LOAD, WIDTH = range(5)
"""Places in the numbers: elements, those that read nothing, weighted readings; the load's
logarithm and the sigma for which they were sorted."""


class CoveredWhole(NamedTuple):
    """Elements that are covered whole, and what they read; all written in place.

    ``first`` is the first row, ``runs`` hold a row's first and one past its last column;
    ``numbers`` are named by `COUNT` and so on; ``readings`` and ``weights`` have so many entries
    that count. ``runs`` of no rows: nothing is looked at in this way.
    """

    first: Runs
    runs: Runs
    numbers: Values
    readings: Values
    weights: Values


@compiled_as_is
def nothing_covered(rows: int) -> CoveredWhole:
    """Return a record without elements, for a pad of so many rows; 0 for none ever."""
    size = 2 * BINS_A_SIGMA * 2 * REACH if rows > 0 else 0
    return CoveredWhole(
        np.zeros(1, np.int64), np.zeros((rows, 2), np.int64), np.zeros(5), np.zeros(size),
        np.zeros(size),
    )  # fmt: skip


@compiled_as_is
def by_rims(problem: Problem) -> bool:
    """Return whether all that is covered whole bears the same load."""
    even = problem.noise[FOAM] <= 0.0 and problem.grid[4] <= 0.0 and is_even(problem.noise)
    for k in range(problem.estimated.shape[0]):
        even = even and problem.estimated[k] in (SIGMA, VOIDS, CONTRAST)
    return even


@compiled_as_is
def empty_for(problem: Problem, p: Values) -> CoveredWhole:
    """Return a record without elements yet; of no rows where looking at each costs no more."""
    left, top, right, bottom = bounds(problem.kind, problem.corners, p)
    elements = (right - left) * (bottom - top) / (problem.grid[2] * problem.grid[2])
    return nothing_covered(problem.states.shape[0] if elements > LARGE and by_rims(problem) else 0)


@compiled_as_is
def still_covered(whole: CoveredWhole, load: float, sigma: float, box: Box, runs: Runs) -> bool:
    """Return whether an outline covers all of them whole, and they are sorted for its load."""
    numbers = whole.numbers
    if numbers[COUNT] == 0.0:
        return False
    if abs(load - numbers[LOAD]) > FAR * numbers[WIDTH]:
        return False
    if not NARROWER * numbers[WIDTH] < sigma < LARGER * numbers[WIDTH]:
        return False
    for i in range(whole.runs.shape[0]):
        a, b = whole.runs[i, 0], whole.runs[i, 1]
        if a == b:
            continue
        row = whole.first[0] + i - box[0]
        if row < 0 or row >= box[2] or a < runs[row, 1] or b > runs[row, 2]:
            return False
    return True


@compiled_as_is
def columns_covered(whole: CoveredWhole, row: int, last: int) -> tuple[int, int]:
    """Return a row's first column of them and one past the last; ``last`` twice if none is."""
    i = row - whole.first[0]
    if not 0 <= i < whole.runs.shape[0] or whole.runs[i, 0] == whole.runs[i, 1]:
        return last, last
    return whole.runs[i, 0], whole.runs[i, 1]


@compiled_as_is
def keep_current(problem: Problem, whole: CoveredWhole | None, p: Values) -> None:
    """Look for what outlines around a point cover whole, and sort its readings, if need be.

    Parameters
    ----------
    problem, p
        As in `log_posterior`.
    whole : CoveredWhole or None
        Written, unless it suits; None on a small pad.
    """
    if whole is None:
        return
    if whole.runs.shape[0] > 0:
        _keep_current(problem, whole, p)


@compiled_as_is
def _keep_current(problem: Problem, whole: CoveredWhole, p: Values) -> None:
    grid, (rows, columns) = problem.grid, problem.states.shape
    box = window(problem.kind, problem.corners, p, grid, rows, columns, 0.0)
    drawn = drawn_as(problem.kind, problem.corners, p)
    load, sigma = p[unknowns(problem.kind, problem.corners)], noise_at(problem, p)[SIGMA]
    wanted = runs_of(drawn, grid, box, MARGIN * grid[2])
    count = 0
    for i in range(box[2]):
        count += wanted[i, 2] - wanted[i, 1]
    near = abs(load - whole.numbers[LOAD]) < 0.5 * FAR * whole.numbers[WIDTH]
    if near and ENOUGH * count <= whole.numbers[COUNT]:
        runs = runs_of(drawn, grid, box, KEPT * grid[2])
        if still_covered(whole, load, sigma, box, runs):
            return
    whole.first[0] = box[0]
    whole.runs[:] = 0
    for i in range(box[2]):
        whole.runs[i, 0], whole.runs[i, 1] = wanted[i, 1], wanted[i, 2]
    whole.numbers[COUNT], whole.numbers[LOAD], whole.numbers[WIDTH] = count, load, sigma
    _sort(problem, whole)


@compiled_as_is
def _sort(problem: Problem, whole: CoveredWhole) -> None:
    """Write the weighted readings that stand for them, and how many read nothing."""
    numbers, logs, states = whole.numbers, problem.logs, problem.states
    size = 2 * REACH * BINS_A_SIGMA
    width = numbers[WIDTH] / BINS_A_SIGMA
    lowest = numbers[LOAD] - REACH * numbers[WIDTH]
    bins = np.zeros((size, 4))
    offs = 0
    for i in range(whole.runs.shape[0]):
        row = whole.first[0] + i
        for column in range(whole.runs[i, 0], whole.runs[i, 1]):
            state = states[row, column]
            if state == OFF:
                offs += 1
            elif state == ON:
                place = (logs[row, column] - lowest) / width
                if 0.0 <= place < size:
                    k = int(place)
                    d = place - k - 0.5
                    bins[k, 0] += 1.0
                    bins[k, 1] += d
                    bins[k, 2] += d * d
                    bins[k, 3] += d * d * d
    at = 0
    for k in range(size):
        if bins[k, 0] > 0.0:
            at = _add_nodes(whole, at, lowest + (k + 0.5) * width, width, bins[k])
    numbers[OFFS], numbers[NODES] = offs, at


@compiled_as_is
def _add_nodes(whole: CoveredWhole, at: int, middle: float, width: float, sums: Values) -> int:
    """Write the one or two readings that have a bin's moments; return where the next go."""
    n, readings, weights = sums[0], whole.readings, whole.weights
    mean = sums[1] / n
    variance = sums[2] / n - mean * mean
    if variance < FLAT:
        readings[at], weights[at] = middle + width * mean, n
        return at + 1
    spread = math.sqrt(variance)
    third = sums[3] / n - 3.0 * mean * variance - mean * mean * mean
    half = 0.5 * third / (variance * spread)
    root = math.sqrt(1.0 + half * half)
    for k in range(2):
        way = 1.0 if k == 0 else -1.0
        readings[at + k] = middle + width * (mean + spread * (half + way * root))
        weights[at + k] = 0.5 * n * (1.0 - way * half / root)
    return at + 2


@compiled_as_is
def log_likelihood_of_covered(whole: CoveredWhole, load: float, noise: Values) -> float:
    """Return what they add to a log likelihood, at a load's logarithm."""
    sigma, level, total = noise[SIGMA], on_level(noise), 0.0
    for k in range(int(whole.numbers[NODES])):
        u = (whole.readings[k] - load) / sigma
        a = level - 0.5 * u * u
        if a > 30.0:
            total += whole.weights[k] * a
        elif a > -30.0:
            total += whole.weights[k] * math.log(1.0 + math.exp(a))
    if whole.numbers[OFFS] > 0.0:
        z = (load - noise[LEAST]) / sigma
        off = 1.0 - (1.0 - noise[VOIDS]) * 0.5 * math.erfc(-SQRT_HALF * z)
        total += whole.numbers[OFFS] * math.log(off)
    return total


@compiled_as_is
def covered_around(problem: Problem, p: Values) -> CoveredWhole:
    """Return what outlines around a point cover whole, of a large pad."""
    whole = empty_for(problem, p)
    keep_current(problem, whole, p)
    return whole
