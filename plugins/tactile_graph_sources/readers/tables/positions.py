"""Positions beside the cells of stacked matrices: of columns above them, of rows before each."""

from __future__ import annotations

import math
import re
from collections.abc import Sequence

import numpy as np

from tactile_graph_sources.readers.tables.evidence import Numbers
from tactile_graph_sources.readers.words.units import length_unit

_FEWEST = 3
_EVENLY = 1e-3
_LEAST_ROUNDED = 2.0
"""Distance of neighbours that may be rounded to whole ones."""
_LEAST_MM = 2.0
"""Distance of neighbours that can be no centimetres, as cells are smaller."""

_OF_POSITIONS = re.compile(
    r"(?<![^\W\d_])(?:positions?|coordinates?|x|y)(?![^\W\d_])", re.IGNORECASE
)


def positions_of(rows: Sequence[Sequence[str]]) -> tuple[float, float] | None:
    """Return how far apart columns and rows are by the positions beside them; None without any.

    Parameters
    ----------
    rows : sequence of sequence of str
        The first lines of a table: one with a blank field, or a word, and evenly spaced numbers,
        which stands above each matrix, and rows that begin with evenly spaced numbers, the same in
        each matrix. Where nothing but constants changes inside, all of it may be readings.
    """
    head = rows[0]
    if not math.isnan(_number(head[0])) or sum(1 for row in rows if row == head) < 2:
        return None
    x = _step(_numbers(head[1:]))
    rest = [row for row in rows if row != head]
    y, n = _step_again(_numbers([row[0] for row in rest])) if x else (0.0, 0)
    if not x or not y:
        return None
    inside = [tuple(row[1:]) for row in rest]
    is_static = all(row == inside[k % n] for k, row in enumerate(inside))
    if is_static and len({text for row in inside for text in row}) > 1:
        return None
    return abs(x), abs(y)


def unit_cm(corner: str, words: Sequence[str]) -> float | None:
    """Return the centimetres of the unit of positions; None where nobody says it.

    Parameters
    ----------
    corner : str
        What stands above the first column: ``mm``, ``y [cm]``.
    words : sequence of str
        The lines before the table: ``Positions in cm``.
    """
    said = [line for line in words if _OF_POSITIONS.search(line)]
    units = [length_unit(text.strip(" \t,;|:.")) for text in (corner, *said)]
    return next((unit for unit in units if unit is not None), None)


def pitch_cm(positions: tuple[float, float], unit: float | None) -> tuple[float, float] | None:
    """Return positions' distances as a pitch; None where they may be in another unit than mm."""
    x, y = positions
    if unit is None:
        return (x / 10.0, y / 10.0) if min(x, y) >= _LEAST_MM else None
    return x * unit, y * unit


def like_positions(matrices: Numbers) -> str:
    """Return what to tell of matrices whose first row or column may be positions, no cells.

    Parameters
    ----------
    matrices : ndarray, shape (n, rows, columns)
    """
    if not len(matrices):
        return ""
    lines = {"row": matrices[:, 0, 1:], "column": matrices[:, 1:, 0]}
    found = [what for what, line in lines.items() if _is_even(line[0]) and _are_alike(line)]
    if not found or (len(found) == 1 and _are_alike(matrices)):
        return ""
    alike = ", the same in each matrix," if len(matrices) > 1 else ""
    return (
        f"a first {' and a first '.join(found)} of evenly spaced numbers{alike} read as cells "
        "(leave it out of the file if it holds positions)"
    )


def _is_even(numbers: Numbers) -> bool:
    """Return whether numbers are evenly spaced, perhaps rounded, and more than one apart."""
    step = _step(numbers)
    whole = np.isfinite(numbers).all() and (numbers % 1 == 0).all()
    if step or len(numbers) < _FEWEST or not whole:
        return abs(step) > 1.0
    steps = np.diff(numbers)
    return bool(np.abs(steps).min() >= _LEAST_ROUNDED and np.ptp(steps) <= 1.0)


def _are_alike(lines: Numbers) -> bool:
    return np.array_equal(lines, np.broadcast_to(lines[0], lines.shape), equal_nan=True)


def _step_again(column: Numbers) -> tuple[float, int]:
    """Return the step of numbers that are evenly spaced again and again, and how many are.

    The step is 0 where they are not.
    """
    again = np.flatnonzero(column[1:] == column[0])
    n = int(again[0]) + 1 if len(again) else 0
    same = n > 0 and np.array_equal(column, np.resize(column[:n], len(column)))
    return (_step(column[:n]), n) if same else (0.0, 0)


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
