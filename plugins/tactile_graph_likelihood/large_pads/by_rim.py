"""What a large outline says, by its rim element by element and what it covers whole at once.

Log likelihood, slopes and information, where a face is even and without foam.
"""

from __future__ import annotations

import math
from typing import NamedTuple

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
from tactile_graph_likelihood.single.density.element_terms import (
    CONTRAST,
    LEAST,
    OFF,
    ON,
    SIGMA,
    UNKNOWN,
    terms,
)
from tactile_graph_likelihood.single.density.information import (
    NO_SCORE,
    SLIVER,
    STEP,
    Information,
    Scatter,
    Score,
    add_outer,
    add_score,
    number_of_contrast,
    scatter_of,
    score_of,
    steps_of,
    summed,
    without_load,
)
from tactile_graph_likelihood.single.density.log_posterior import noise_at
from tactile_graph_likelihood.single.density.problem import Places, Problem

SLACK = 2.0 * STEP  # of a pitch: no difference moves an edge further


class Elements(NamedTuple):
    """Elements that are looked at one by one, those of the rim first, row by row.

    ``rows`` and ``columns`` are their places in the image; ``recorded`` says whether the record
    stands for all others that an outline covers.
    """

    rows: Places
    columns: Places
    recorded: bool


@compiled_as_is
def elements_of(whole: CoveredWhole, load: float, sigma: float, box: Box, runs: Runs) -> Elements:
    """Return the elements of an outline's rim, and those covered whole but not in the record.

    All of these, where the outline does not cover some of the record's.
    """
    recorded = still_covered(whole, load, sigma, box, runs)
    most = 0
    for i in range(box[2]):
        most += runs[i, 3] - runs[i, 0]
    rows, columns, count = np.empty(most, np.int64), np.empty(most, np.int64), 0
    for i in range(box[2]):
        for part in range(2):
            for column in range(runs[i, 2 * part], runs[i, 2 * part + 1]):
                rows[count], columns[count] = box[0] + i, column
                count += 1
    for i in range(box[2]):
        row, last = box[0] + i, runs[i, 2]
        a, b = columns_covered(whole, row, last) if recorded else (last, last)
        for part in range(2):
            for column in range(runs[i, 1] if part == 0 else b, a if part == 0 else last):
                rows[count], columns[count] = row, column
                count += 1
    return Elements(rows[:count], columns[:count], recorded)


@compiled_as_is
def log_likelihood_by_rim(problem: Problem, whole: CoveredWhole, p: Values) -> float:
    """Return what `log_posterior.log_likelihood` does, where a face is even and without foam."""
    kind, corners, grid = problem.kind, problem.corners, problem.grid
    rows, columns = problem.states.shape
    noise, load = noise_at(problem, p), p[unknowns(kind, corners)]
    box = window(kind, corners, p, grid, rows, columns, 0.0)
    if box[2] <= 0 or box[3] <= 0:
        return 0.0
    drawn = drawn_as(kind, corners, p)
    runs = runs_of(drawn, grid, box, 0.0)
    its = elements_of(whole, load, noise[SIGMA], box, runs)
    share = np.ones((1, its.rows.shape[0]))
    rim_shares(drawn, grid, box, runs, share[0, : rim_count(runs)])
    logs, states = np.empty(share.shape), np.empty(share.shape, problem.states.dtype)
    for k in range(share.shape[1]):
        logs[0, k] = problem.logs[its.rows[k], its.columns[k]]
        states[0, k] = problem.states[its.rows[k], its.columns[k]]
    found = terms(share, load, 0, 0, logs, states, noise)
    return found + log_likelihood_of_covered(whole, load, noise) if its.recorded else found


@compiled_as_is
def information_by_rim(problem: Problem, whole: CoveredWhole, p: Values, out: Information) -> None:
    """Write slope and information, where a face is even and without foam."""
    kind, corners, grid = problem.kind, problem.corners, problem.grid
    first, (rows, columns) = unknowns(kind, corners), problem.states.shape
    noise, load = noise_at(problem, p), p[first]
    out.slope[:] = 0.0
    out.matrix[:] = 0.0
    box = window(kind, corners, p, grid, rows, columns, SLACK * grid[2])
    if box[2] <= 0 or box[3] <= 0:
        return
    runs = runs_of(drawn_as(kind, corners, p), grid, box, SLACK * grid[2])
    share, rise = _rises_on_rim(problem, p, box, runs)
    its, on_rim = elements_of(whole, load, noise[SIGMA], box, runs), share.shape[0]
    scatter, total, along = scatter_of(noise), NO_SCORE, np.zeros(p.shape[0])
    power, by_power = noise[CONTRAST], number_of_contrast(problem)
    along[first], sliver = 1.0, SLIVER ** (1.0 / power)
    for k in range(its.rows.shape[0]):
        row, column, part = its.rows[k], its.columns[k], share[k] if k < on_rim else 1.0
        state = problem.states[row, column]
        if part <= 0.0 or state == UNKNOWN:
            continue
        log = noise[LEAST] if state == OFF else problem.logs[row, column]
        log_part = math.log(part)
        _, score = score_of(state, log, power * log_part + load, scatter)
        if k < on_rim:
            for m in range(first):
                along[m] = power * rise[m, k] / max(part, sliver)
            if by_power >= 0:
                along[by_power] = log_part
            add_outer(score, along, out)
            score = without_load(score)
        total = summed(total, score, 1.0)
    if its.recorded:
        total = summed(total, _score_of_covered(whole, load, noise[LEAST], scatter), 1.0)
    add_score(problem, total, out)


@compiled_as_is
def _rises_on_rim(problem: Problem, p: Values, box: Box, runs: Runs) -> tuple[Values, Values]:
    """Return the rim's coverage, shape (N,), and its slope along the outline's numbers, (D, N)."""
    kind, corners, grid = problem.kind, problem.corners, problem.grid
    first, count = unknowns(kind, corners), rim_count(runs)
    share, rise = np.empty(count), np.empty((first, count))
    rim_shares(drawn_as(kind, corners, p), grid, box, runs, share)
    steps, moved = steps_of(kind, corners, p, grid), p.copy()
    for k in range(first):
        moved[k] += steps[k]
        rim_shares(drawn_as(kind, corners, moved), grid, box, runs, rise[k])
        moved[k] = p[k]
        for i in range(count):
            rise[k, i] = (rise[k, i] - share[i]) / steps[k]
    return share, rise


@compiled_as_is
def _score_of_covered(whole: CoveredWhole, load: float, least: float, scatter: Scatter) -> Score:
    """Return what the record of elements that are covered whole says."""
    nodes = int(whole.numbers[NODES])
    _, off = score_of(OFF, least, load, scatter)
    total = summed(NO_SCORE, off, whole.numbers[OFFS])
    for k in range(nodes):
        _, on = score_of(ON, whole.readings[k], load, scatter)
        total = summed(total, on, whole.weights[k])
    return total
