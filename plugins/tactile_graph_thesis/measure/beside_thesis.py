"""Errors beside a table of the thesis: maximum and average, in groups as large as its own."""

from __future__ import annotations

from collections.abc import Mapping
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from tactile_graph_thesis.item import Compared
from tactile_graph_thesis.numbers import error_table, numbers

Array = NDArray[np.float64]
LOW, HIGH = 0.05, 0.95


class Spread(NamedTuple):
    """Maximum and average of a quantity's errors.

    Parameters
    ----------
    largest, average : float
        Means over groups of each group's maximum, and over all readings; NaN without any.
    largest_range, average_range : (float, float)
        Between these lie nine in ten groups' own.
    missing : int
        Readings without an answer, which are left out.
    """

    largest: float
    average: float
    largest_range: tuple[float, float]
    average_range: tuple[float, float]
    missing: int


def spread(errors: Array, group: int) -> Spread:
    """Return maximum and average of absolute errors, and their ranges over groups.

    Parameters
    ----------
    errors : ndarray, shape (readings,)
        NaN without an answer.
    group : int
        Readings of a group; what is left over is in the average alone.
    """
    good = errors[np.isfinite(errors)]
    missing = len(errors) - len(good)
    if not len(good):
        nothing = (np.nan, np.nan)
        return Spread(np.nan, np.nan, nothing, nothing, missing)
    n = max(len(good) // group, 1)
    groups = good[: n * group].reshape(n, -1)
    largest, means = groups.max(axis=1), groups.mean(axis=1)
    return Spread(
        float(largest.mean()), float(good.mean()), _range(largest), _range(means), missing
    )


def _range(values: Array) -> tuple[float, float]:
    low, high = np.quantile(values, [LOW, HIGH])
    return float(low), float(high)


class BesideThesis(NamedTuple):
    """A table of the thesis beside ours.

    Parameters
    ----------
    rows : mapping
        Object -> a `Compared` for each column of the thesis.
    missing : mapping
        Object -> readings without an answer, which are left out.
    """

    rows: Mapping[str, tuple[Compared, ...]]
    missing: Mapping[str, int]

    @property
    def compared(self) -> tuple[Compared, ...]:
        """The rows of all objects."""
        return tuple(one for rows in self.rows.values() for one in rows)


def beside_thesis(
    table: str, errors: Mapping[str, Array], group: int | None = None
) -> BesideThesis:
    """Return maximum and average of errors beside those of a table.

    Parameters
    ----------
    table : str
        ``table-4.3`` and the like.
    errors : mapping
        Object -> shape (readings, quantities or more): signed or absolute, NaN without an answer.
        The first quantities are the table's.
    group : int, optional
        Readings of a group whose maximum counts; the thesis' own number if not given.
    """
    thesis = error_table(table)
    group = group or int(numbers("readings")["each"])
    rows, missing = {}, {}
    for name, told in zip(thesis.objects, thesis.values, strict=True):
        found = [spread(np.abs(column), group) for column in errors[name].T[: len(told) // 2]]
        ours = [
            value
            for one in found
            for value in ((one.largest, *one.largest_range), (one.average, *one.average_range))
        ]
        rows[name] = tuple(
            Compared(
                f"{name}, {column}",
                unit,
                value,
                float(number),
                low,
                high,
                largest=column.endswith("max"),
            )
            for column, unit, number, (value, low, high) in zip(
                thesis.columns, thesis.units, told, ours, strict=True
            )
        )
        missing[name] = found[-1].missing
    return BesideThesis(rows, missing)
