"""The largest connected piece of what is touched."""

from __future__ import annotations

import numpy as np

from tactile_graph.compiled import compiled_as_is
from tactile_graph_likelihood.single.element_terms import OFF, ON, States
from tactile_graph_likelihood.single.problem import Places


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
    piece = np.zeros(states.shape, np.int64)
    stack = np.empty(states.size, np.int64)
    pieces, best, most = 0, 0, 0
    for row in range(rows):
        for column in range(columns):
            if states[row, column] == ON and piece[row, column] == 0:
                pieces += 1
                count = _fill(states, reach, row, column, pieces, piece, stack)
                if count > most:
                    best, most = pieces, count
    out = states.copy()
    for i in range(rows):
        for j in range(columns):
            if states[i, j] == ON and piece[i, j] != best:
                out[i, j] = OFF
    return out


@compiled_as_is
def _fill(
    states: States, reach: int, row: int, column: int, label: int, piece: Places, stack: Places
) -> int:
    """Write a label on all of a piece; return how many of its elements are touched."""
    rows, columns = states.shape
    count, waiting, stack[0] = 0, 1, row * columns + column
    piece[row, column] = label
    while waiting > 0:
        waiting -= 1
        row, column = stack[waiting] // columns, stack[waiting] % columns
        if states[row, column] == ON:
            count += 1
        for i in range(max(row - reach, 0), min(row + reach + 1, rows)):
            for j in range(max(column - reach, 0), min(column + reach + 1, columns)):
                if piece[i, j] == 0 and states[i, j] != OFF:
                    piece[i, j] = label
                    stack[waiting] = i * columns + j
                    waiting += 1
    return count
