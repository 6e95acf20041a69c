"""The search for the mode on a large pad: through blocks of elements, and by the outline's rim."""

from __future__ import annotations

import math

import numpy as np

from tactile_graph.compiled import compiled_as_is
from tactile_graph_likelihood.geometry.covered import window
from tactile_graph_likelihood.geometry.outlines import Values, unknowns
from tactile_graph_likelihood.large_pads.by_rim import goodness_by_rim
from tactile_graph_likelihood.large_pads.coarse import Blocks, coarsened, in_one_piece
from tactile_graph_likelihood.large_pads.covered_whole import (
    covered_around,
    empty_for,
    nothing_covered,
)
from tactile_graph_likelihood.large_pads.rim import drawn_as, runs_of
from tactile_graph_likelihood.single.element_terms import FOAM, ON, UNKNOWN, VOIDS
from tactile_graph_likelihood.single.goodness_of_fit import GoodnessOfFit, goodness_of_fit
from tactile_graph_likelihood.single.log_posterior import log_likelihood
from tactile_graph_likelihood.single.maximise import ENOUGH, ROUGH, maximise, softened
from tactile_graph_likelihood.single.problem import Problem
from tactile_graph_likelihood.single.search import ATTEMPTS, POOR, SAME, TRIES, likeliest_start

STRIDE = 1.5  # pitches that an edge moves a round: rows it never felt lie beyond
FEW_BESIDE, SHARE_BESIDE = 3.0, 0.02  # touched elements beside an outline that may be strays


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


@compiled_as_is
def maximise_on_large_pad(problem: Problem, stride: float, p: Values, root: Values) -> float:
    """Maximise as `maximise_softly_first` does; ``stride`` as in `maximise`."""
    maximise(softened(problem), nothing_covered(0), p, root, ROUGH, stride)
    return maximise(problem, empty_for(problem, p), p, root, ENOUGH, stride)


@compiled_as_is
def maximise_from_blocks(problem: Problem, block: int, p: Values, root: Values) -> float:
    """Maximise, with true elements at once from where blocks have brought a large outline.

    Parameters
    ----------
    problem, p, root
        As in `maximise`.
    block : int
        How many elements wide the blocks were.

    Returns
    -------
    float
        The log posterior at the top.
    """
    if block > 1 and problem.noise[FOAM] <= 0.0:
        height = maximise(problem, empty_for(problem, p), p, root, ENOUGH, STRIDE)
        if not touched_beside(problem, p):
            return height
    return maximise_on_large_pad(problem, STRIDE, p, root)


@compiled_as_is
def _start(
    problem: Problem, blocks: Blocks, start: Values, table: Values, tries: int, p: Values
) -> None:
    """Write where to begin: near the top, if blocks show it.

    Parameters
    ----------
    problem, start, table
        As in `find_mode_on_large_pad`.
    blocks : Blocks
    tries : int
        As in `likeliest_start`.
    p : ndarray, shape (K,)
        Written.
    """
    first, rough = unknowns(problem.kind, problem.corners), blocks.problem
    given = start.shape[0] == p.shape[0]
    if given:
        p[:] = start
    if blocks.block == 1:
        if not given:
            likeliest_start(rough, table, tries, p)
        return
    at, root = np.zeros(first + 1), np.zeros((first + 1, first + 1))
    if given:
        at[:first], at[first] = start[:first], math.log(1.0 - problem.noise[VOIDS])
    else:
        likeliest_start(rough, table, tries, at)
        for k in range(problem.guess.shape[0]):
            p[first + 1 + k] = problem.guess[k, 0]
    maximise_on_large_pad(rough, math.inf, at, root)
    at[first] = blocks.load
    if given:
        moved = p.copy()
        moved[: first + 1] = at
        if log_likelihood(problem, p) > log_likelihood(problem, moved):
            return
    p[: first + 1] = at


@compiled_as_is
def _fit(problem: Problem, p: Values) -> GoodnessOfFit:
    """Return how well the image fits a large or small outline."""
    whole = covered_around(problem, p)
    if whole.runs.shape[0] == 0:
        return goodness_of_fit(problem, p)
    return goodness_by_rim(problem, whole, p)


@compiled_as_is
def find_mode_on_large_pad(
    problem: Problem, table: Values, start: Values, first: int, last: int, p: Values, root: Values,
    height: float,
) -> tuple[float, bool, GoodnessOfFit]:  # fmt: skip
    """Return what `search.find_mode` does, of a pad of more than 1024 elements."""
    n, fit = p.shape[0], GoodnessOfFit(0.0, 0.0, 0.0, 0.0)
    trial, its_root = np.zeros(n), np.zeros((n, n))
    blocks = coarsened(problem)
    for attempt in range(first, last):
        given, seen = start[:0], blocks
        if attempt == 0:
            given, seen = start, Blocks(in_one_piece(blocks.problem), blocks.block, blocks.load)
        _start(problem, seen, given, table, attempt * TRIES, trial)
        here = maximise_from_blocks(problem, blocks.block, trial, its_root)
        again = attempt > 0 and abs(here - height) < SAME
        if here > height:
            height = here
            p[:] = trial
            for k in range(n):
                root[k, :] = its_root[k]
        if height > -math.inf:
            fit = _fit(problem, p)
            if fit.surprise > POOR or again:
                return height, False, fit
    return height, last < ATTEMPTS, fit
