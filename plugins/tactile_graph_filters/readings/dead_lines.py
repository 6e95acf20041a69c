"""Rows and columns of an image that read nothing: no valid cell, or the same in nearly all."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from tactile_graph.compiled import compiled_later, compiled_twin_of
from tactile_graph.wires import Image

LEAST_CELLS = 4
"""A line of fewer is never called dead: its cells may well be equal by chance."""
EQUAL_SHARE = 0.75
"""Of a dead line's cells so many read the same; others may lie on a dead line across it."""
MOST_SHARE = 0.25
"""Where so many lines are constant, as on a pad without noise, that says nothing of one."""

Flags = NDArray[np.bool_]
BOOL = np.dtype(np.bool_)


def dead_lines(image: Image) -> tuple[Flags, Flags]:
    """Return which rows, shape (rows,), and which columns, shape (columns,), are dead.

    Parameters
    ----------
    image : Image
    """
    values, valid = image.values, image.valid
    n_rows, n_columns = values.shape
    rows, columns = np.empty(n_rows, BOOL), np.empty(n_columns, BOOL)
    constant_lines.call(values, rows, columns)
    if valid is None:
        return rows, columns
    rows |= ~valid.any(axis=1)
    columns |= ~valid.any(axis=0)
    return rows, columns


def _constant_plain(values: NDArray[np.float64], rows: Flags, columns: Flags) -> None:
    """Write which rows and which columns read the same in nearly all of their cells.

    Lines of too few cells do not, nor does any line where too many do.
    """
    for lines, constant in ((values, rows), (values.T, columns)):
        constant[:] = False
        if lines.shape[1] < LEAST_CELLS or not len(lines):
            continue
        middle = np.sort(lines, axis=1)[:, lines.shape[1] // 2]
        found = (lines == middle[:, None]).mean(axis=1) >= EQUAL_SHARE
        if found.mean() < MOST_SHARE:
            constant[:] = found


@compiled_twin_of(_constant_plain)
def constant_lines(values, rows, columns):  # type: ignore[no-untyped-def]
    """Do the same in loops; few lines have so many equal neighbours that they can be constant."""
    n_rows, n_columns = values.shape
    along_rows, along_columns = np.zeros(n_rows, np.int64), np.zeros(n_columns, np.int64)
    for i in range(n_rows):
        for j in range(1, n_columns):
            along_rows[i] += values[i, j] == values[i, j - 1]
        for j in range(n_columns if i > 0 else 0):  # as cells lie in memory, not down each column
            along_columns[j] += values[i, j] == values[i - 1, j]
    _constant(values, along_rows, rows)
    _constant(values.T, along_columns, columns)


@compiled_later
def _constant(lines, alike, constant):  # type: ignore[no-untyped-def]
    """Write which lines are constant, given how many neighbours in each of them read the same.

    Each cell that reads otherwise parts at most two pairs of neighbours.
    """
    n_lines, n = lines.shape
    constant[:] = False
    n_constant = 0
    for i in range(n_lines):
        if n < LEAST_CELLS or alike[i] < (2.0 * EQUAL_SHARE - 1.0) * n - 1.0:
            continue
        constant[i] = _equal_to_most(lines[i]) / n >= EQUAL_SHARE
        n_constant += constant[i]
        if not n_constant < MOST_SHARE * n_lines:
            constant[:] = False
            break


@compiled_later
def _equal_to_most(line):  # type: ignore[no-untyped-def]
    """Return how many cells read what most do, by R. S. Boyer and J S. Moore's vote (1991, MJRTY).

    Each cell votes for its reading or against another's: only a majority can be left in the end.
    """
    most, votes = line[0], 0
    for j in range(len(line)):
        if votes == 0:
            most = line[j]
        votes += 1 if line[j] == most else -1
    equal = 0
    for j in range(len(line)):
        equal += line[j] == most
    return equal
