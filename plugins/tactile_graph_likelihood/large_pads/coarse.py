"""A large image in blocks of elements: where a search begins that would be lost in the fine one."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from tactile_graph.compiled import compiled_as_is
from tactile_graph_likelihood.geometry.lengths import length
from tactile_graph_likelihood.geometry.outlines import Values
from tactile_graph_likelihood.geometry.pieces import components
from tactile_graph_likelihood.large_pads.solid import solid, typical_load
from tactile_graph_likelihood.single.climbs.search import moments
from tactile_graph_likelihood.single.density.element_terms import (
    LEAST,
    OFF,
    ON,
    SIGMA,
    STRAYS,
    UNKNOWN,
    VOIDS,
    States,
)
from tactile_graph_likelihood.single.density.problem import Places, Problem

ACROSS, NARROW = 13.0, 5.0  # blocks that the touched region is long, and broad, at least
WIDE = 3.6  # standard deviations in a width: rectangles have 3.5, discs 4
SHOWS = 0.15  # share of touched elements from which on a block is
APART = 3  # rows or columns that neighbours of a piece are apart: voids break what is thin
UNEVEN, VOID, STRAY = 0.3, 0.03, 0.01  # of blocks: sigma, share of voids, and of strays


@compiled_as_is
def block_of(grid: Values, found: Values) -> int:
    """Return how many elements wide blocks may be that still show what has such moments."""
    middle, off = 0.5 * (found[3] + found[5]), length(0.5 * (found[3] - found[5]), found[4])
    long = WIDE * math.sqrt(middle + off) / grid[2]
    broad = WIDE * math.sqrt(max(middle - off, 0.0)) / grid[2]
    return max(1, int(min(long / ACROSS, broad / NARROW)))


class Blocks(NamedTuple):
    """The same question about an image in blocks, how many elements wide they are, and the load.

    Of a small object a block is 1; the typical log load is NaN if not known. ``moments`` are those
    of all elements that are part of something solid.
    """

    problem: Problem
    block: int
    load: float
    moments: Values


@compiled_as_is
def coarsened(problem: Problem) -> Blocks:
    """Return a large image in blocks.

    A block reads which share of its elements is touched by something solid: whatever their gains
    are, and however far off strays are.
    """
    grid, logs, states = problem.grid, problem.logs, problem.states
    typical = typical_load(logs, states)
    if math.isnan(typical):
        return Blocks(problem, 1, typical, np.zeros(7))
    body = solid(logs, states, typical, problem.noise[SIGMA])
    found = moments(grid, logs, body)
    block = block_of(grid, found)
    if block == 1:
        rough = _read(problem, grid, logs, body, problem.noise, problem.estimated)
        return Blocks(rough, 1, typical, found)
    blocks, shares = _blocks(body, block)
    noise = np.zeros(problem.noise.shape)
    noise[SIGMA], noise[VOIDS], noise[STRAYS] = UNEVEN, VOID, STRAY
    noise[LEAST] = math.log(SHOWS)
    wide = grid.copy()
    wide[2], wide[3] = block * grid[2], block * grid[2] - (grid[2] - grid[3])
    rough = _read(problem, wide, shares, blocks, noise, problem.estimated[:0])
    return Blocks(rough, block, typical, found)


@compiled_as_is
def in_one_piece(problem: Problem) -> Problem:
    """Return the same for the largest piece of what is touched."""
    piece = largest_piece(problem.states, APART)
    return _read(problem, problem.grid, problem.logs, piece, problem.noise, problem.estimated)


@compiled_as_is
def _read(
    problem: Problem, grid: Values, logs: Values, states: States, noise: Values, estimated: Places
) -> Problem:
    """Return the same question about another image."""
    return Problem(
        problem.kind, problem.corners, grid, logs, states, noise, estimated,
        problem.guess[: estimated.shape[0]], problem.prior, problem.belief, problem.precision,
    )  # fmt: skip


@compiled_as_is
def _blocks(body: States, block: int) -> tuple[States, Values]:
    """Return states of blocks, and the logarithm of the touched share of each."""
    rows, columns = body.shape
    down, across = (rows + block - 1) // block, (columns + block - 1) // block
    known, on = np.zeros((down, across)), np.zeros((down, across))
    for i in range(rows):
        at = i // block
        for j in range(across):
            for column in range(j * block, min((j + 1) * block, columns)):
                state = body[i, column]
                known[at, j] += 1.0 if state != UNKNOWN else 0.0
                on[at, j] += 1.0 if state == ON else 0.0
    states, logs = np.empty((down, across), body.dtype), np.zeros((down, across))
    for i in range(down):
        for j in range(across):
            if known[i, j] < 0.5 * block * block:
                states[i, j] = UNKNOWN
            elif on[i, j] < SHOWS * known[i, j]:
                states[i, j] = OFF
            else:
                states[i, j] = ON
                logs[i, j] = math.log(on[i, j] / known[i, j])
    return states, logs


@compiled_as_is
def largest_piece(states: States, reach: int) -> States:
    """Return states in which only the piece with the most touched elements reads a load.

    Parameters
    ----------
    states : ndarray of uint8, shape (rows, columns)
        As in `element_terms`.
    reach : int
        How many rows or columns apart neighbours in a piece may be. Elements of which nothing is
        known join what they touch.
    """
    rows, columns = states.shape
    piece = components(states, reach)  # what is `OFF` is 0, and counts as none
    counts = np.zeros(piece.size + 1, np.int64)
    for i in range(rows):
        for j in range(columns):
            counts[piece[i, j]] += 1 if states[i, j] == ON else 0
    best, out = 0, states.copy()
    for i in range(rows):
        for j in range(columns):
            if states[i, j] == ON and counts[piece[i, j]] > counts[best]:
                best = piece[i, j]
    for i in range(rows):
        for j in range(columns):
            if states[i, j] == ON and piece[i, j] != best:
                out[i, j] = OFF
    return out
