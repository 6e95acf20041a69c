"""What the numbers of a table say of themselves: columns that count, cells that lie together."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

Numbers = NDArray[np.float64]
CLEAR = 0.85
"""A lag at which cells differ by less than this share of those beside it is a row's length."""
EVEN = 3.0
MOST_CELLS, MOST_FRAMES = 1 << 14, 100
MOST_LINES, FEWEST_ROWS = 400, 3
FAR_APART = 0.7
NEARLY, HALF_WAY = 1.1, 0.6
"""How unlike lines may be that are alike again: times the next line, and the most unlike before."""

SURE_STEPS = 8
"""Steps upwards that no readings of a cell make."""


def rises(column: Numbers) -> bool:
    """Return whether a column climbs in steps much alike, as times and frame numbers do.

    Two lines are enough only because nothing can be said against it; the steps of eight or more
    may be of any size. A long column may begin anew, as where a device started again.
    """
    if len(column) < 2 or not (np.abs(column) < 1e30).all():
        return False
    steps = np.diff(column)
    if steps.min() > 0.0:
        return len(steps) >= SURE_STEPS or bool(steps.max() <= EVEN * steps.min())
    anew = np.flatnonzero(steps <= 0.0) + 1
    parts = np.split(column, anew)
    from_start = (column[anew] <= column[0] + np.abs(column[1] - column[0])).all()
    return bool(from_start) and all(len(part) > SURE_STEPS for part in parts)


def climbs_in_parts(column: Numbers, n_parts: int) -> bool:
    """Return whether lines have times or numbers of their own, which may begin anew in each part.

    Parameters
    ----------
    column : ndarray, shape (lines,)
    n_parts : int
        Groups of lines; what a whole group has in common climbs from one to the next alone.
    """
    if len(column) < 2 or not (np.abs(column) < 1e30).all():
        return False
    steps = np.diff(column)
    n_anew = n_parts - 1
    return bool((steps < 0.0).sum() <= n_anew and (steps > 0.0).sum() > 2 * n_anew)


def counts_up(column: Numbers) -> bool:
    """Return whether a column goes up by one from line to line."""
    sound = len(column) > 1 and bool((np.abs(column) < 1e15).all())
    return sound and bool((np.diff(column) == 1.0).all()) and column[0] % 1 == 0


def is_count(row: Numbers) -> bool:
    """Return whether a row is 0, 1, 2, … or 1, 2, 3, …: numbers of columns, not values."""
    first = row[0]
    return len(row) >= 3 and first in (0.0, 1.0) and bool((np.diff(row) == 1.0).all())


def spacing(places: Numbers, in_length: bool, of_line: bool = False) -> float | None:
    """Return the distance of neighbouring places along an axis; None where they lie anywhere.

    Whole numbers are places one apart, however many they leave out, unless the axis is
    ``in_length``. One place alone, which tells no distance, gives 0; ``of_line`` says that it is
    so along the other axis: then each place may stand there once.
    """
    found, n = np.unique(np.round(places[np.abs(places) < 1e9], 6), return_counts=True)
    found = found[n >= 0.2 * np.median(n)] if len(found) else found  # a damaged line is no place
    if not len(found):
        return None
    if not in_length and bool((found % 1 == 0).all()):
        return 1.0
    if len(found) == 1:
        return 0.0
    if 2 * len(found) > len(places) and not of_line:
        return None
    step = float(np.diff(found).min())
    on_grid = np.abs((found - found[0]) / step - np.rint((found - found[0]) / step)) < 1e-3
    if on_grid.mean() < 0.9:
        return None
    return step


def is_sum(total: Numbers, cells: Numbers) -> bool:
    """Return whether a column holds the sums of the others, shape (lines, cells)."""
    if not (np.abs(cells) < 1e30).all() or not np.isfinite(total).all() or not cells.any():
        return False
    return bool(np.allclose(total, cells.sum(axis=1), rtol=1e-4, atol=1e-6))


def row_length_clarity(cells: Numbers, columns: int) -> float:
    """Return how much likelier cells one row apart are alike than cells a row and one apart.

    Parameters
    ----------
    cells : ndarray, shape (frames, cells)
        Frames with their cells in a row.
    columns : int
        The row's length to be weighed.

    Returns
    -------
    float
        Mean difference of cells ``columns`` apart, over that of cells one less or one more apart:
        clearly below 1 where rows are that long, about 1 where they are not, and NaN where the
        cells are all alike.
    """
    return _clarity(_sound(cells), columns)


def _clarity(cells: Numbers, columns: int) -> float:
    if columns < 3 or columns + 1 >= cells.shape[1]:
        return float("nan")
    beside = min(_difference(cells, columns - 1), _difference(cells, columns + 1))
    return _difference(cells, columns) / beside if beside > 0.0 else float("nan")


def row_lengths(cells: Numbers) -> list[tuple[int, int]]:
    """Return (rows, columns) of frames that the cells themselves speak for, the clearest first."""
    n = cells.shape[1]
    if not 8 < n <= MOST_CELLS:
        return []
    cells = _sound(cells)
    divisors = [c for c in range(3, n // 2 + 1) if n % c == 0]
    clarity = {c: _clarity(cells, c) for c in divisors}
    clear = [c for c in divisors if clarity[c] < CLEAR]
    # Twice a row's length is a lag of likeness too, but one of less.
    clear.sort(key=lambda c: _difference(cells, c))
    return [(n // c, c) for c in clear]


def is_one_row(cells: Numbers, columns: int) -> bool:
    """Return whether cells of a line lie together as one row does, not as rows of ``columns``.

    Then those ``columns`` apart differ much more than neighbours, and no less than those one more
    or one less apart.
    """
    cells = _sound(cells)
    clarity = _clarity(cells, columns)
    return clarity > CLEAR and _difference(cells, 1) < FAR_APART * _difference(cells, columns)


def line_period(cells: Numbers) -> int | None:
    """Return after how many lines they are as alike again as one line is to the next.

    Rows of matrices are, after lines that are unlike; frames are not, as each is most like the
    next one.

    Parameters
    ----------
    cells : ndarray, shape (lines, cells)

    Returns
    -------
    int or None
        None where no number of lines stands out.
    """
    n = len(cells)
    if n < 2 * FEWEST_ROWS:
        return None
    cells = np.clip(np.nan_to_num(cells[:MOST_LINES]), -1e9, 1e9)
    lags = np.arange(1, len(cells) // 2 + 2)
    apart = np.array([np.mean(np.abs(cells[k:] - cells[:-k])) for k in lags])
    unlike = np.maximum.accumulate(apart)
    again = (apart <= NEARLY * apart[0]) & (apart < HALF_WAY * unlike)
    found = np.flatnonzero(again[FEWEST_ROWS - 1 : -1])
    if not len(found):
        return None
    first = int(found[0]) + FEWEST_ROWS - 1
    # The first dip's bottom: what lies twice as far is one of the next matrix.
    bottom = first + int(np.argmin(apart[first : first + first // 2 + 1]))
    return int(lags[bottom])


def _difference(cells: Numbers, lag: int) -> float:
    return float(np.mean(np.abs(cells[:, lag:] - cells[:, :-lag])))


def _sound(cells: Numbers) -> Numbers:
    """Return the cells with 0 for what is missing or too large to reckon with.

    Each frame is scaled to its own spread: one of garbage must not drown the others.
    """
    cells = cells[:MOST_FRAMES]
    cells = np.where(np.abs(cells) < 1e30, cells, 0.0)
    spread = np.abs(cells - np.median(cells, axis=1, keepdims=True)).mean(axis=1, keepdims=True)
    scaled: Numbers = np.divide(cells, spread, out=np.zeros_like(cells), where=spread > 0.0)
    return scaled


def as_numbers(rows: Any) -> Numbers:
    """Return rows of floats as an array."""
    return np.asarray(rows, dtype=np.float64)
