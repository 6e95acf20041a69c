"""The log likelihood of a large outline: its rim element by element, what is inside at once."""

from __future__ import annotations

import math

import numpy as np

from tactile_graph.compiled import compiled_as_is
from tactile_graph_likelihood.geometry.covered import window
from tactile_graph_likelihood.geometry.outlines import Values, unknowns
from tactile_graph_likelihood.large_pads.rim_shares import rim_shares
from tactile_graph_likelihood.large_pads.rims import drawn_as, rim_count, runs_of
from tactile_graph_likelihood.single.covered_whole import (
    Inside,
    columns_inside,
    holds,
    log_likelihood_inside,
)
from tactile_graph_likelihood.single.element_terms import SIGMA, terms
from tactile_graph_likelihood.single.log_posterior import log_likelihood, noise_at
from tactile_graph_likelihood.single.problem import Problem


@compiled_as_is
def likelihood_at(problem: Problem, inside: Inside, p: Values) -> float:
    """Return the log likelihood at a point: element by element, or by the rim if that is asked for.

    Parameters
    ----------
    problem, p
        As in `log_posterior.log_likelihood`.
    inside : Inside
        Of no rows where each element is to be looked at.
    """
    if inside.runs.shape[0] == 0:
        return log_likelihood(problem, p)
    return log_likelihood_by_rim(problem, inside, p)


@compiled_as_is
def log_likelihood_by_rim(problem: Problem, inside: Inside, p: Values) -> float:
    """Return what `log_posterior.log_likelihood` does, where a face is even and without foam.

    Elements that are covered whole, but not inside, are taken one by one; all of them, where some
    of what is inside lies without this outline.
    """
    kind, corners, grid = problem.kind, problem.corners, problem.grid
    rows, columns = problem.states.shape
    noise, load = noise_at(problem, p), p[unknowns(kind, corners)]
    box = window(kind, corners, p, grid, rows, columns, 0.0)
    if box[2] <= 0 or box[3] <= 0:
        return 0.0
    numbers, xy = drawn_as(kind, corners, p)
    runs = runs_of(numbers, xy, grid, box, 0.0)
    known = holds(inside, load, noise[SIGMA], box, runs)
    on_rim, whole = rim_count(runs), 0
    for i in range(box[2]):
        whole += runs[i, 2] - runs[i, 1]
    expected = np.empty((1, on_rim + whole))
    logs, states = np.empty(expected.shape), np.empty(expected.shape, problem.states.dtype)
    rim_shares(numbers, xy, grid, box, runs, expected[0, :on_rim])
    scale, at, more = math.exp(load), 0, on_rim
    for i in range(box[2]):
        row, last = box[0] + i, runs[i, 2]
        for part in range(2):
            for column in range(runs[i, 2 * part], runs[i, 2 * part + 1]):
                expected[0, at] *= scale
                logs[0, at], states[0, at] = problem.logs[row, column], problem.states[row, column]
                at += 1
        a, b = columns_inside(inside, row, last) if known else (last, last)
        for part in range(2):
            for column in range(runs[i, 1] if part == 0 else b, a if part == 0 else last):
                expected[0, more] = scale
                logs[0, more] = problem.logs[row, column]
                states[0, more] = problem.states[row, column]
                more += 1
    found = terms(expected[:, :more], 0, 0, logs, states, noise)
    return found + log_likelihood_inside(inside, load, noise) if known else found
