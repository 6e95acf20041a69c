"""Whether what an outline misses lies to a side: then it is another shape's, and its place off.

Voids and strays are anywhere. Where a triangle, a T or an L is taken for a disc or a rectangle,
elements that read nothing lie together in some of its corners, and some that read a load beyond it
in others.
"""

from __future__ import annotations

import math

import numpy as np

from tactile_graph.compiled import compiled_as_is, compiled_later
from tactile_graph_likelihood.geometry import outlines
from tactile_graph_likelihood.geometry.covered import Box, window
from tactile_graph_likelihood.geometry.linear import cholesky, squared_length
from tactile_graph_likelihood.geometry.outlines import Values
from tactile_graph_likelihood.single.density.element_terms import ON, OVER, UNKNOWN, States

FEWEST, MISSED = 12, 4
"""Elements whose middles lie inside, and those that an outline misses, for anything to be said."""

NEAREST, FARTHEST = 0.4, 1.25
"""Pitches beyond an outline between which what reads a load counts as missed: nearer it is partly
covered, farther a stray."""

STRAY = 0.5
"""What such an element counts, a void being 1. Squared, it is the largest variance of a yes or no,
which is taken for that of a void, so that a few dead elements side by side say little."""

TERMS, SIDELESS = 6, 2
"""Terms that are fitted to what is missed, and the first of them, which say nothing of a side."""

_DISC, _RECTANGLE = outlines.DISC, outlines.RECTANGLE


@compiled_later
def lopsided(kind: int, p: Values, grid: Values, states: States) -> float:
    """Return how much what an outline misses lies to a side, in its standard deviations.

    Parameters
    ----------
    kind : int
        Of a disc, an ellipse or a rectangle.
    p : ndarray, shape (K,)
        The outline, as in `outlines`.
    grid : ndarray, shape (4,)
        As in `covered.window`.
    states : ndarray, shape (R, C)

    Returns
    -------
    float
        0 where too little is missed to say.

    Notes
    -----
    With u and v the place along both axes over half their lengths, voids and strays are regressed
    on 1 and ``u**2 + v**2``, as a hollow may be missed, and on what these leave of u, v, ``u**2 v``
    and ``u v**2``: terms that are odd, as those of a shape are whose middle lies elsewhere. What
    these explain is chi squared, made nearly normal as in `trend`. Rows and columns that read
    nothing there, between others that do, are dead, and left out.
    """
    rows, columns = states.shape
    box = window(kind, 0, p, grid, rows, columns, FARTHEST * grid[2])
    matrix, root = np.zeros((TERMS, TERMS)), np.zeros((TERMS, TERMS))
    right, terms = np.zeros(TERMS), np.ones(TERMS)
    inside, missed = _sum_up(kind, p, grid, states, box, matrix, right)
    if inside < FEWEST or missed < MISSED or not cholesky(matrix, root):
        return 0.0
    squared_length(root, right, terms)
    explained = 0.0
    for k in range(SIDELESS, TERMS):
        explained += terms[k] * terms[k]
    return math.sqrt(2.0 * explained) / STRAY - math.sqrt(2.0 * (TERMS - SIDELESS) - 1.0)


lopsided.passes = 10  # plain loops take 5 us an element


@compiled_as_is
def _sum_up(
    kind: int, p: Values, grid: Values, states: States, box: Box, matrix: Values, right: Values
) -> tuple[int, int]:
    """Return how many elements lie inside, and how many are missed; add up what these regress on.

    Of ``matrix``, sums of the terms' products, the lower half is written; ``right`` are those with
    what is missed.
    """
    row_reads, column_reads = _reading_lines(states, box)
    a, b, cos, sin = p[2], p[2], 1.0, 0.0
    if kind != _DISC:
        b, cos, sin = p[3], math.cos(p[4]), math.sin(p[4])
    per_pitch, terms = min(a, b) / grid[2], np.ones(TERMS)
    inside = missed = 0
    for r in range(box[2]):
        if _is_dead(row_reads, r):
            continue
        y = grid[1] + 0.5 * grid[3] + grid[2] * (box[0] + r) - p[1]
        for c in range(box[3]):
            state = states[box[0] + r, box[1] + c]
            if state == UNKNOWN or _is_dead(column_reads, c):
                continue
            x = grid[0] + 0.5 * grid[3] + grid[2] * (box[1] + c) - p[0]
            u, v = (x * cos - y * sin) / a, (x * sin + y * cos) / b
            squared = u * u + v * v
            far = max(abs(u), abs(v)) if kind == _RECTANGLE else math.sqrt(squared)
            reads = state in (ON, OVER)
            if far < 1.0:
                its = 0.0 if reads else 1.0
                inside += 1
            elif reads and NEAREST < (far - 1.0) * per_pitch < FARTHEST:
                its = -STRAY
            else:
                continue
            missed += its != 0.0
            terms[1], terms[2], terms[3] = squared, u, v
            terms[4], terms[5] = u * u * v, u * v * v
            for k in range(TERMS):
                right[k] += terms[k] * its
                for m in range(k + 1):
                    matrix[k, m] += terms[k] * terms[m]
    return inside, missed


@compiled_as_is
def _reading_lines(states: States, box: Box) -> tuple[States, States]:
    """Return which rows and columns of a window read a load, a bare one before and after them."""
    row_reads, column_reads = np.zeros(box[2] + 2, np.uint8), np.zeros(box[3] + 2, np.uint8)
    for r in range(box[2]):
        for c in range(box[3]):
            state = states[box[0] + r, box[1] + c]
            if state in (ON, OVER):
                row_reads[r + 1] = column_reads[c + 1] = 1
    return row_reads, column_reads


@compiled_as_is
def _is_dead(reads: States, line: int) -> bool:
    """Return whether a row or column reads nothing, but both beside it do."""
    dead: bool = reads[line + 1] == 0 and reads[line] == 1 and reads[line + 2] == 1
    return dead
