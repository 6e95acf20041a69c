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
    """Do the same in loops: what more than half of the cells read is found without sorting."""
    _constant(values, rows)
    _constant(values.T, columns)


@compiled_later
def _constant(lines, constant):  # type: ignore[no-untyped-def]
    """Write which lines are constant, by R. S. Boyer and J S. Moore's vote (1991, MJRTY).

    Each cell votes for its reading or against another's: only a majority can be left in the end.
    """
    n_lines, n = lines.shape
    n_constant = 0
    for i in range(n_lines):
        constant[i] = False
        if n < LEAST_CELLS:
            continue
        most, votes = lines[i, 0], 0
        for j in range(n):
            if votes == 0:
                most = lines[i, j]
            votes += 1 if lines[i, j] == most else -1
        equal = 0
        for j in range(n):
            equal += lines[i, j] == most
        constant[i] = equal / n >= EQUAL_SHARE
        n_constant += constant[i]
    if not n_constant < MOST_SHARE * n_lines:
        for i in range(n_lines):
            constant[i] = False
