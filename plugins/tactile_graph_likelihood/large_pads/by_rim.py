"""What a large outline says, by its rim element by element and what it covers whole at once.

Log likelihood, slopes and information, where a face is even and without foam.
"""

from __future__ import annotations

import math

import numpy as np

from tactile_graph.compiled import compiled_as_is
from tactile_graph_likelihood.geometry.covered import Box, window
from tactile_graph_likelihood.geometry.outlines import Values, unknowns
from tactile_graph_likelihood.large_pads.covered_whole import (
    NODES,
    OFFS,
    CoveredWhole,
    columns_covered,
    log_likelihood_of_covered,
    still_covered,
)
from tactile_graph_likelihood.large_pads.rim import Runs, drawn_as, rim_count, rim_shares, runs_of
from tactile_graph_likelihood.single.element_terms import (
    LEAST,
    OFF,
    ON,
    SIGMA,
    UNKNOWN,
    terms,
)
from tactile_graph_likelihood.single.information import (
    NO_SCORE,
    SLIVER,
    STEP,
    Information,
    Scatter,
    Score,
    add_outer,
    add_score,
    mirror,
    scatter_of,
    score_of,
    steps_of,
    summed,
    without_load,
)
from tactile_graph_likelihood.single.log_posterior import noise_at
from tactile_graph_likelihood.single.problem import Problem

SLACK = 2.0 * STEP  # of a pitch: no difference moves an edge further


@compiled_as_is
def log_likelihood_by_rim(problem: Problem, whole: CoveredWhole, p: Values) -> float:
    """Return what `log_posterior.log_likelihood` does, where a face is even and without foam.

    Elements that are covered whole, but not in the record, are taken one by one; all of them, where
    this outline does not cover some of the record's.
    """
    kind, corners, grid = problem.kind, problem.corners, problem.grid
    rows, columns = problem.states.shape
    noise, load = noise_at(problem, p), p[unknowns(kind, corners)]
    box = window(kind, corners, p, grid, rows, columns, 0.0)
    if box[2] <= 0 or box[3] <= 0:
        return 0.0
    numbers, xy = drawn_as(kind, corners, p)
    runs = runs_of(numbers, xy, grid, box, 0.0)
    known = still_covered(whole, load, noise[SIGMA], box, runs)
    on_rim, beyond = rim_count(runs), 0
    for i in range(box[2]):
        beyond += runs[i, 2] - runs[i, 1]
    share = np.empty((1, on_rim + beyond))
    logs, states = np.empty(share.shape), np.empty(share.shape, problem.states.dtype)
    rim_shares(numbers, xy, grid, box, runs, share[0, :on_rim])
    at, more = 0, on_rim
    for i in range(box[2]):
        row, last = box[0] + i, runs[i, 2]
        for part in range(2):
            for column in range(runs[i, 2 * part], runs[i, 2 * part + 1]):
                logs[0, at], states[0, at] = problem.logs[row, column], problem.states[row, column]
                at += 1
        a, b = columns_covered(whole, row, last) if known else (last, last)
        for part in range(2):
            for column in range(runs[i, 1] if part == 0 else b, a if part == 0 else last):
                share[0, more] = 1.0
                logs[0, more] = problem.logs[row, column]
                states[0, more] = problem.states[row, column]
                more += 1
    found = terms(share[:, :more], load, 0, 0, logs, states, noise)
    return found + log_likelihood_of_covered(whole, load, noise) if known else found


@compiled_as_is
def information_by_rim(problem: Problem, whole: CoveredWhole, p: Values, out: Information) -> None:
    """Write slope and information, where a face is even and without foam."""
    kind, corners, grid = problem.kind, problem.corners, problem.grid
    first, (rows, columns) = unknowns(kind, corners), problem.states.shape
    noise = noise_at(problem, p)
    out.slope[:] = 0.0
    out.matrix[:] = 0.0
    box = window(kind, corners, p, grid, rows, columns, SLACK * grid[2])
    if box[2] <= 0 or box[3] <= 0:
        return
    numbers, xy = drawn_as(kind, corners, p)
    runs = runs_of(numbers, xy, grid, box, SLACK * grid[2])
    share, rise = _rises_on_rim(problem, p, box, runs)
    scatter, at, total = scatter_of(noise), 0, NO_SCORE
    along = np.zeros(p.shape[0])
    along[first] = 1.0
    for i in range(box[2]):
        row = box[0] + i
        for part in range(2):
            for column in range(runs[i, 2 * part], runs[i, 2 * part + 1]):
                state, its = problem.states[row, column], share[at]
                at += 1
                if its <= 0.0 or state == UNKNOWN:
                    continue
                for k in range(first):
                    along[k] = rise[k, at - 1] / max(its, SLIVER)
                log = noise[LEAST] if state == OFF else problem.logs[row, column]
                score = score_of(state, log, math.log(its) + p[first], scatter)
                add_outer(score, along, out)
                total = summed(total, without_load(score), 1.0)
    known = still_covered(whole, p[first], noise[SIGMA], box, runs)
    for i in range(box[2]):
        row, last = box[0] + i, runs[i, 2]
        a, b = columns_covered(whole, row, last) if known else (last, last)
        for part in range(2):
            for column in range(runs[i, 1] if part == 0 else b, a if part == 0 else last):
                state = problem.states[row, column]
                if state == UNKNOWN:
                    continue
                log = noise[LEAST] if state == OFF else problem.logs[row, column]
                total = summed(total, score_of(state, log, p[first], scatter), 1.0)
    if known:
        total = summed(total, _score_of_covered(whole, p[first], noise[LEAST], scatter), 1.0)
    add_score(problem, total, out)
    mirror(out.matrix)


@compiled_as_is
def _rises_on_rim(problem: Problem, p: Values, box: Box, runs: Runs) -> tuple[Values, Values]:
    """Return the rim's coverage, shape (N,), and its slope along the outline's numbers, (D, N)."""
    kind, corners, grid = problem.kind, problem.corners, problem.grid
    first, count = unknowns(kind, corners), rim_count(runs)
    share, rise = np.empty(count), np.empty((first, count))
    numbers, xy = drawn_as(kind, corners, p)
    rim_shares(numbers, xy, grid, box, runs, share)
    steps, moved = steps_of(kind, corners, p, grid), p.copy()
    for k in range(first):
        moved[k] += steps[k]
        numbers, xy = drawn_as(kind, corners, moved)
        moved[k] = p[k]
        rim_shares(numbers, xy, grid, box, runs, rise[k])
        for i in range(count):
            rise[k, i] = (rise[k, i] - share[i]) / steps[k]
    return share, rise


@compiled_as_is
def _score_of_covered(whole: CoveredWhole, load: float, least: float, scatter: Scatter) -> Score:
    """Return what the record of elements that are covered whole says."""
    nodes = int(whole.numbers[NODES])
    off = score_of(OFF, least, load, scatter)
    total = summed(NO_SCORE, off, whole.numbers[OFFS])
    for k in range(nodes):
        on = score_of(ON, whole.readings[k], load, scatter)
        total = summed(total, on, whole.weights[k])
    return total
