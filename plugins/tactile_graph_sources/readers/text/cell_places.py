"""What the places of a table with one cell a line say: where they lie, and whether on one grid."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from tactile_graph.errors import DataError
from tactile_graph_sources.readers.reading import Reading
from tactile_graph_sources.readers.tables.layout import Layout

Places = NDArray[np.float64]
FEWEST_OF_GRID = 0.02
"""Share of a grid's cells that must be there for numbers to be places on it."""
FULL = 0.9
"""Share of a grid's cells that must be there for its first row and column to be among them."""
LEAST_STEPS, MOST_ALIKE = 2.0, 0.8
"""Steps a line of cells must have to show that its cells lie apart, and the share of all cells that
then lie on the same columns if lines are not offset against each other."""


def refuse_no_grid(
    reading: Reading, layout: Layout, shape: tuple[int, int], places: Places
) -> None:
    """Refuse places that are no grid: next to none of its cells, or rows that are offset.

    Parameters
    ----------
    reading : Reading
    layout : Layout
    shape : (int, int)
        Rows and columns of the grid they would span; one that is told is believed.
    places : ndarray, shape (n, 2)
        Row and column of each place, once, in whole numbers.

    Raises
    ------
    DataError
        If they are more likely values, if rows are offset, or nothing says how far apart they are.
    """
    said = layout.said
    is_told = (reading.told.rows or said.rows) and (reading.told.columns or said.columns)
    if len(places) < FEWEST_OF_GRID * shape[0] * shape[1] and not is_told:
        raise DataError(
            str(reading.path),
            f"its header names row, column and value, but the {len(places)} places in it are next "
            f"to none of {shape[0]} x {shape[1]} cells: are they values? Give it another header, "
            "or rows and columns where they are places",
        )
    if layout.one_line and np.ptp(places[:, ("row", "column").index(layout.one_line)]) > 0.0:
        raise DataError(
            str(reading.path),
            f"its first lines lie in one {layout.one_line} and later ones do not, so how far apart "
            f"{layout.one_line}s are is not known; write whole numbers there and give pitch_cm",
        )
    if layout.spacing is None and is_told:
        return
    steps = layout.spacing or (1.0, 1.0)
    found = [
        (_offset_lines(places[:, axis], places[:, 1 - axis]) * steps[1 - axis], axis)
        for axis in (0, 1)
    ]
    # Offset by half, columns are so as much as rows: the cells that lie closer are neighbours.
    apart, axis = min((one for one in found if one[0]), default=(0.0, 0))
    if apart:
        raise DataError(
            str(reading.path), _staggered(("row", "column")[axis], apart, steps[1 - axis])
        )


def first_number(reading: Reading, layout: Layout, places: Places) -> int:
    """Return the number of the first row and column: 0 or 1.

    Parameters
    ----------
    reading : Reading
    layout : Layout
    places : ndarray, shape (n, 2)
        Row and column of each place, once, none of them below 0.

    Raises
    ------
    DataError
        If the setting ``first_cell`` says what cannot be.
    """
    told, said = reading.told, layout.said
    if layout.spacing is not None:
        if told.first_cell is not None:
            what = "first_cell: its rows and columns are positions, no numbers; leave it out"
            raise DataError(str(reading.path), what)
        return 0
    lowest, highest = places.min(axis=0), places.max(axis=0)
    if told.first_cell == 1 and lowest.min() == 0.0:
        what = "first_cell=1, but there are cells in row or column 0; leave it out"
        raise DataError(str(reading.path), what)
    if told.first_cell is not None or lowest.min() == 0.0:
        return told.first_cell or 0
    ends = (told.rows or said.rows or np.inf, told.columns or said.columns or np.inf)
    is_full = lowest.max() == 1.0 and len(places) >= FULL * highest.prod()
    if not is_full and (highest < ends).all():
        reading.assume("rows and columns counted from 1, as none is 0 (give first_cell)")
    return 1


def stated_origin_cm(
    reading: Reading, layout: Layout, lowest: Places
) -> tuple[float, float] | None:
    """Return where the grid begins so that each cell's centre lies where the file states it.

    Parameters
    ----------
    reading : Reading
    layout : Layout
    lowest : ndarray, shape (2,)
        Row and column of the grid's first cell, counted from the table's first line.

    Returns
    -------
    (float, float) or None
        None where positions are in no unit of length.
    """
    pitch_cm = reading.told.pitch_cm
    if pitch_cm is not None and reading.told.transpose:
        pitch_cm = pitch_cm[::-1]  # a told one is of the frame as it is to be seen
    pitch_cm = pitch_cm or layout.said.pitch_cm
    if layout.unit_cm is None or layout.spacing is None or pitch_cm is None:
        return None
    place = np.add(layout.first, lowest * layout.spacing) * layout.unit_cm
    x_cm, y_cm = np.round(place[::-1] - np.multiply(pitch_cm, 0.5), 9).tolist()
    return x_cm, y_cm


def _offset_lines(line: Places, along: Places) -> int:
    """Return how far apart the cells of each line are where lines are offset against each other.

    0 where they are not, as where cells of different lines lie on the same columns.
    """
    order = np.lexsort((along, line))
    steps = np.diff(along[order])[np.diff(line[order]) == 0]
    if len(steps) < LEAST_STEPS * len(np.unique(line)):
        return 0
    apart = int(np.median(steps))
    if apart < 2 or np.mean(steps % apart == 0) < MOST_ALIKE:
        return 0
    alike = np.bincount((along % apart).astype(np.intp)).max()
    return apart if alike < MOST_ALIKE * len(along) else 0


def _staggered(line: str, apart: float, step: float) -> str:
    return (
        f"its {line}s are offset against each other, as those of a hexagonal or staggered pad: the "
        f"cells of a {line} lie {apart:g} apart, those of all {line}s {step:g}. Frames are grids "
        "of rows and columns; resample the readings onto one first, in Python: "
        "scipy.interpolate.griddata((x, y), values, (grid_x, grid_y)), with grid_x and grid_y "
        "from numpy.meshgrid, about as far apart as the cells are"
    )
