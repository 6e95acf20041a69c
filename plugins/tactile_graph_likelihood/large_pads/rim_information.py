"""Slopes and information of a large outline: its rim by differences, what is inside at once."""

from __future__ import annotations

import math

import numpy as np

from tactile_graph.compiled import compiled_as_is
from tactile_graph_likelihood.geometry.covered import Box, window
from tactile_graph_likelihood.geometry.outlines import Values, unknowns
from tactile_graph_likelihood.large_pads.rim_shares import rim_shares
from tactile_graph_likelihood.large_pads.rims import Runs, drawn_as, rim_count, runs_of
from tactile_graph_likelihood.single.covered_whole import NODES, OFFS, Inside, columns_inside, holds
from tactile_graph_likelihood.single.element_terms import ON, SIGMA, UNKNOWN, on_level
from tactile_graph_likelihood.single.information import (
    SLIVER,
    STEP,
    _add_noise_slopes,
    _add_outer,
    _score,
    information,
    steps_of,
)
from tactile_graph_likelihood.single.log_posterior import noise_at
from tactile_graph_likelihood.single.problem import Problem

SLACK = 2.0 * STEP  # of a pitch: no difference moves an edge further


@compiled_as_is
def information_at(
    problem: Problem, inside: Inside, p: Values, slope: Values, matrix: Values
) -> None:
    """Do what `information.information` does, element by element or by the rim.

    Parameters
    ----------
    problem, p, slope, matrix
        As there.
    inside : Inside
        As in `rim_likelihood.likelihood_at`.
    """
    if inside.runs.shape[0] == 0:
        information(problem, p, slope, matrix)
    else:
        _information_by_rim(problem, inside, p, slope, matrix)


@compiled_as_is
def _information_by_rim(
    problem: Problem, inside: Inside, p: Values, slope: Values, matrix: Values
) -> None:
    """Write slope and information, where a face is even and without foam."""
    kind, corners, grid = problem.kind, problem.corners, problem.grid
    first, (rows, columns) = unknowns(kind, corners), problem.states.shape
    noise = noise_at(problem, p)
    slope[:] = 0.0
    matrix[:] = 0.0
    box = window(kind, corners, p, grid, rows, columns, SLACK * grid[2])
    if box[2] <= 0 or box[3] <= 0:
        return
    numbers, xy = drawn_as(kind, corners, p)
    runs = runs_of(numbers, xy, grid, box, SLACK * grid[2])
    share, rise = _rises_on_rim(problem, p, box, runs)
    level, at = on_level(noise), 0
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
                mu, log = math.log(its) + p[first], problem.logs[row, column]
                score = _score(state == ON, log, mu, noise, level)
                _add_noise_slopes(
                    state == ON, score, first, noise, problem.estimated, slope, matrix
                )
                _add_outer(score, along, slope, matrix)
    _add_whole(problem, inside, p, noise, box, runs, slope, matrix)
    for k in range(p.shape[0]):
        for m in range(k):
            matrix[m, k] = matrix[k, m]


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
def _add_whole(
    problem: Problem, inside: Inside, p: Values, noise: Values, box: Box, runs: Runs,
    slope: Values, matrix: Values,
) -> None:  # fmt: skip
    """Add what elements that are covered whole say of the load and of the noise."""
    first = unknowns(problem.kind, problem.corners)
    load, level = p[first], on_level(noise)
    known = holds(inside, load, noise[SIGMA], box, runs)
    its_slope, its_matrix = np.zeros(p.shape[0]), np.zeros(matrix.shape)
    for i in range(box[2]):
        row = box[0] + i
        last = runs[i, 2]
        a, b = columns_inside(inside, row, last) if known else (last, last)
        for part in range(2):
            for column in range(runs[i, 1] if part == 0 else b, a if part == 0 else last):
                if problem.states[row, column] == UNKNOWN:
                    continue
                on = problem.states[row, column] == ON
                score = _score(on, problem.logs[row, column], load, noise, level)
                _add_noise_slopes(on, score, first, noise, problem.estimated, slope, matrix)
                slope[first] += score[0]
                matrix[first, first] += score[1]
    if not known:
        return
    nodes = int(inside.numbers[NODES])
    for k in range(nodes + 1):
        on = k < nodes
        weight = inside.weights[k] if on else inside.numbers[OFFS]
        score = _score(on, inside.readings[k] if on else 0.0, load, noise, level)
        its_slope[:] = 0.0
        its_matrix[:] = 0.0
        _add_noise_slopes(on, score, first, noise, problem.estimated, its_slope, its_matrix)
        its_slope[first] = score[0]
        its_matrix[first, first] = score[1]
        for m in range(first, p.shape[0]):
            slope[m] += weight * its_slope[m]
            matrix[m, m] += weight * its_matrix[m, m]
