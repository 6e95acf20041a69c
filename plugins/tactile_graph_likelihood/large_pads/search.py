"""The search for the mode of a wide outline: through blocks of elements, and by its rim."""

from __future__ import annotations

import math

import numpy as np

from tactile_graph.compiled import compiled_as_is
from tactile_graph_likelihood.geometry.covered import window
from tactile_graph_likelihood.geometry.linear import inverse_root
from tactile_graph_likelihood.geometry.outlines import Values, unknowns
from tactile_graph_likelihood.large_pads.coarse import Blocks, coarsened, in_one_piece
from tactile_graph_likelihood.large_pads.covered_whole import (
    covered_around,
    empty_for,
    nothing_covered,
)
from tactile_graph_likelihood.large_pads.rim import drawn_as, runs_of
from tactile_graph_likelihood.single.climbs.maximise import ENOUGH, ROUGH, maximise, softened
from tactile_graph_likelihood.single.climbs.search import (
    begins_softly,
    likeliest_start,
    looked_at,
    outline_of_moments,
)
from tactile_graph_likelihood.single.density.element_terms import FOAM, ON, UNKNOWN, VOIDS
from tactile_graph_likelihood.single.density.evaluate import log_likelihood_at
from tactile_graph_likelihood.single.density.goodness_of_fit import GoodnessOfFit
from tactile_graph_likelihood.single.density.log_posterior import log_likelihood, log_rest
from tactile_graph_likelihood.single.density.problem import Problem, turned_as

TRIES = 24  # outlines tried around the moments' own, in attempts after the first
STRIDE = 1.5  # pitches that an edge moves a round: rows it never felt lie beyond
SETTLED = 0.005  # gain in log posterior still promised, at which a top is taken for the mean
LEAST_DROP, MOST_DROP = 0.25, 1.0  # of a normal log posterior, half: a deviation from its top
FEW_BESIDE, SHARE_BESIDE = 3.0, 0.02  # touched elements beside an outline that may be strays


@compiled_as_is
def touched_beside(problem: Problem, p: Values) -> bool:
    """Return whether more is touched within a pitch beside an outline than strays may be.

    An edge that lies in a gap does not feel the touched row beyond it.
    """
    grid, (rows, columns) = problem.grid, problem.states.shape
    box = window(problem.kind, problem.corners, p, grid, rows, columns, grid[2])
    drawn = drawn_as(problem.kind, problem.corners, p)
    near, wide = runs_of(drawn, grid, box, 0.0), runs_of(drawn, grid, box, grid[2])
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
    """Maximise, with elements that feel a little beyond their edge first; as `maximise`."""
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
        whole = empty_for(problem, p)
        height = maximise(problem, whole, p, root, ENOUGH, STRIDE)
        if whole.runs.shape[0] > 0 or not touched_beside(problem, p):
            return height
    return maximise_on_large_pad(problem, STRIDE, p, root)


@compiled_as_is
def _start(
    problem: Problem, blocks: Blocks, start: Values, table: Values, tries: int, p: Values
) -> None:
    """Write where to begin: near the top, if blocks or the moments of what is solid show it.

    Parameters
    ----------
    problem, start, table
        As in `search.attempted`.
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
    if given or tries > 0:
        return
    outline_of_moments(problem.kind, problem.corners, blocks.moments, 0.0, 0.0, at)
    at[first] = blocks.load
    moved = p.copy()
    moved[: first + 1] = at
    here = log_likelihood_at(problem, covered_around(problem, p), p)
    if log_likelihood_at(problem, covered_around(problem, moved), moved) > here:
        p[:] = moved


@compiled_as_is
def attempted_on_large_pad(
    problem: Problem, table: Values, start: Values, attempt: int, least: float, p: Values,
    root: Values,
) -> tuple[float, float, GoodnessOfFit]:  # fmt: skip
    """Do what `search.attempted` does, where more than 4096 elements are touched."""
    blocks = coarsened(problem)
    given, seen = start[:0], blocks
    if attempt == 0:
        piece = in_one_piece(blocks.problem)
        given, seen = start, Blocks(piece, blocks.block, blocks.load, blocks.moments)
    _start(problem, seen, given, table, attempt * TRIES, p)
    height = maximise_from_blocks(problem, blocks.block, p, root)
    return looked_at(problem, p, root, height, least)


@compiled_as_is
def attempted_by_rim(
    problem: Problem, table: Values, start: Values, attempt: int, least: float, p: Values,
    root: Values,
) -> tuple[float, float, GoodnessOfFit]:  # fmt: skip
    """Do what `search.attempted` does, of an outline that is looked at by its rim."""
    if begins_softly(problem, table, start, attempt, p):
        maximise(softened(problem), nothing_covered(0), p, root, ROUGH, math.inf)
    height = maximise(problem, empty_for(problem, p), p, root, ENOUGH, math.inf)
    return looked_at(problem, p, root, height, least)


@compiled_as_is
def settled(problem: Problem, p: Values, root: Values) -> float:
    """Bring a wide outline to its top; return the height if the posterior is normal around it.

    Parameters
    ----------
    problem : Problem
        Of more than 1500 touched elements.
    p, root : ndarray, shape (K,) and (K, K)
        Near the top; written, with the lower root of the information there.

    Returns
    -------
    float
        The log posterior at the top; -inf where the outline is not wide, or the posterior is
        not as far down a deviation away along each axis as a normal one, as where a side lies in
        a gap.
    """
    whole, n = empty_for(problem, p), p.shape[0]
    if whole.runs.shape[0] == 0:
        return -math.inf
    height = maximise(problem, whole, p, root, SETTLED, math.inf)
    near, axes = turned_as(problem, p), inverse_root(root)
    for place in range(2 * n):
        way = 1.0 if place % 2 == 0 else -1.0
        trial = p + way * axes[place // 2]
        here = log_rest(near, trial)
        if here > -math.inf:
            here += log_likelihood_at(near, whole, trial)
        if not LEAST_DROP < height - here < MOST_DROP:
            return -math.inf
    return height
