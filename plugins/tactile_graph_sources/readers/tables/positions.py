"""Positions beside the cells of stacked matrices: of columns above them, of rows before each."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np

from tactile_graph_sources.readers.tables.evidence import Numbers

_FEWEST = 3
_EVENLY = 1e-3
_LEAST_MM = 2.0
"""Distance of neighbours that can be no centimetres, as cells are smaller."""


def positions_of(rows: Sequence[Sequence[str]]) -> tuple[float, float] | None:
    """Return how far apart columns and rows are by the positions beside them; None without any.

    Parameters
    ----------
    rows : sequence of sequence of str
        The first lines of a table: one with a blank field and evenly spaced numbers, which stands
        above each matrix, and rows that begin with evenly spaced numbers, the same in each matrix.
    """
    head = rows[0]
    if head[0].strip() or sum(1 for row in rows if row == head) < 2:
        return None
    x = _step(_numbers(head[1:]))
    y = _step_again(_numbers([row[0] for row in rows if row != head])) if x else 0.0
    return (abs(x), abs(y)) if x and y else None


def pitch_cm(positions: tuple[float, float]) -> tuple[float, float] | None:
    """Return positions' distances as a pitch; None where they may be in another unit than mm."""
    x, y = positions
    return (x / 10.0, y / 10.0) if min(x, y) >= _LEAST_MM else None


def like_positions(matrices: Numbers) -> str:
    """Return what to tell of matrices whose first row or column may be positions, no cells.

    Parameters
    ----------
    matrices : ndarray, shape (n, rows, columns)
    """
    if len(matrices) < 2:
        return ""
    for what, lines in (("row", matrices[:, 0]), ("column", matrices[:, :, 0])):
        if _step(lines[0][np.isfinite(lines[0])]) and _are_alike(lines):
            return (
                f"a first {what} of evenly spaced numbers, the same in each matrix, read as cells "
                "(leave it out of the file if it holds positions)"
            )
    return ""


def _are_alike(lines: Numbers) -> bool:
    return np.array_equal(lines, np.broadcast_to(lines[0], lines.shape), equal_nan=True)


def _step_again(column: Numbers) -> float:
    """Return the step of numbers that are evenly spaced again and again; 0 where they are not."""
    again = np.flatnonzero(column[1:] == column[0])
    if not len(again):
        return 0.0
    n = int(again[0]) + 1
    same = np.array_equal(column, np.resize(column[:n], len(column)))
    return _step(column[:n]) if same else 0.0


def _step(numbers: Numbers) -> float:
    """Return the step of evenly spaced numbers; 0 where they are not."""
    if len(numbers) < _FEWEST or not np.isfinite(numbers).all():
        return 0.0
    steps = np.diff(numbers)
    step = float(steps.mean())
    return step if (np.abs(steps - step) <= _EVENLY * abs(step)).all() else 0.0


def _numbers(texts: Sequence[str]) -> Numbers:
    return np.array([_number(text) for text in texts])


def _number(text: str) -> float:
    try:
        return float(text)
    except ValueError:
        return math.nan
