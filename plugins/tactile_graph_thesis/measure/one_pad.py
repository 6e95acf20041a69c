"""Tables 4.3 to 4.8 of one pad: average errors of every object by every algorithm."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from tactile_graph import Frame, load
from tactile_graph_thesis.measure.circles import circle_errors
from tactile_graph_thesis.measure.rectangles import signed_errors
from tactile_graph_thesis.numbers import error_table

Array = NDArray[np.float64]
TABLES = {
    "table-4.3": "circle-1",
    "table-4.4": "circle-2",
    "table-4.5": "circle-3",
    "table-4.7": "rectangle-1",
    "table-4.8": "rectangle-2",
}
"""Which pipeline a table belongs to."""
NEAR = 0.3
"""Share by which an average may be off the thesis' that comes out."""


class Cell(NamedTuple):
    """One average error of the tables.

    Parameters
    ----------
    table, object, quantity, unit : str
    thesis : float
    """

    table: str
    object: str
    quantity: str
    unit: str
    thesis: float

    @property
    def words(self) -> str:
        """What it is, in words."""
        return f"{self.table.replace('-', ' ')}, {self.object}, {self.quantity}"


def cells() -> list[Cell]:
    """Return the 39 average errors that the thesis prints, in the order of its tables."""
    found = []
    for table in TABLES:
        printed = error_table(table)
        for name, row in zip(printed.objects, printed.values, strict=True):
            told = zip(printed.columns[1::2], printed.units[1::2], row[1::2], strict=True)
            found += [
                Cell(table, name, column.removesuffix(" avg"), unit, float(value))
                for column, unit, value in told
            ]
    return found


def pad_errors(discs: Sequence[Frame], rectangles: Sequence[Frame]) -> dict[tuple[str, str], Array]:
    """Return the errors of each table and object, shape (readings, 3).

    Parameters
    ----------
    discs, rectangles : sequence of Frame
        As many of each object.

    Notes
    -----
    Absolute. A disc without an answer errs by its radius, a rectangle without one is NaN.
    """
    found: dict[tuple[str, str], Array] = {}
    for table, name in TABLES.items():
        objects, run = error_table(table).objects, load(name).runner()
        if name.startswith("circle"):
            errors = circle_errors(discs, [run], objects)[0]
            found |= {(table, o): e for o, e in zip(objects, errors, strict=True)}
        else:
            signed = signed_errors(run, rectangles)
            found |= {(table, o): np.abs(signed[o][:, :3]) for o in objects}
    return found


def averages(errors: dict[tuple[str, str], Array]) -> Array:
    """Return the 39 averages in the order of `cells`.

    Parameters
    ----------
    errors : dict
        As `pad_errors` gives them.
    """
    return np.concatenate([_means(one) for one in errors.values()])


def _means(errors: Array) -> Array:
    found = np.isfinite(errors).any(axis=0)
    return np.where(found, np.nanmean(np.where(found, errors, 0.0), axis=0), np.nan)


def near(found: Array) -> NDArray[np.bool_]:
    """Return which averages are within 30 % of the thesis'; a NaN is not.

    Parameters
    ----------
    found : ndarray, shape (39,)
    """
    thesis = np.array([cell.thesis for cell in cells()])
    return np.asarray(np.abs(found / thesis - 1.0) <= NEAR)
