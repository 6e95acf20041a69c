"""The search for the mode of a wide outline, which begins on blocks of elements."""

from __future__ import annotations

import math

import numpy as np

from tactile_graph.compiled import compiled_as_is
from tactile_graph_likelihood.geometry.outlines import Values, unknowns
from tactile_graph_likelihood.large_pads.coarse import Blocks, coarsened, in_one_piece
from tactile_graph_likelihood.single.climbs.maximise import ENOUGH, ROUGH, maximise, softened
from tactile_graph_likelihood.single.climbs.search import (
    likeliest_start,
    looked_at,
    outline_of_moments,
)
from tactile_graph_likelihood.single.density.element_terms import FOAM, VOIDS
from tactile_graph_likelihood.single.density.goodness_of_fit import GoodnessOfFit
from tactile_graph_likelihood.single.density.log_posterior import log_likelihood
from tactile_graph_likelihood.single.density.problem import Problem

TRIES = 24  # outlines tried around the moments' own, in attempts after the first
STRIDE = 1.5  # pitches that an edge moves a round: rows it never felt lie beyond


@compiled_as_is
def maximise_on_large_pad(problem: Problem, stride: float, p: Values, root: Values) -> float:
    """Maximise, with elements that feel a little beyond their edge first; as `maximise`."""
    maximise(softened(problem), p, root, ROUGH, stride)
    return maximise(problem, p, root, ENOUGH, stride)


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
    if log_likelihood(problem, moved) > log_likelihood(problem, p):
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
    if blocks.block > 1 and problem.noise[FOAM] <= 0.0:  # they have led near enough to the top
        height = maximise(problem, p, root, ENOUGH, STRIDE)
    else:
        height = maximise_on_large_pad(problem, STRIDE, p, root)
    return looked_at(problem, p, root, height, least)
