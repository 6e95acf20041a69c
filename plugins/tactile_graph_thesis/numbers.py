"""The numbers the thesis gives, as data: ``numbers.yaml``, with the place of each."""

from __future__ import annotations

from collections.abc import Mapping
from functools import cache
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

FILE = Path(__file__).parent / "numbers.yaml"


class ErrorTable(NamedTuple):
    """A table of errors as the thesis prints it.

    Parameters
    ----------
    place : str
        Where it stands.
    objects, columns, units : tuple of str
        Of its rows, of its columns, and the unit of each column.
    values : ndarray, shape (objects, columns)
    """

    place: str
    objects: tuple[str, ...]
    columns: tuple[str, ...]
    units: tuple[str, ...]
    values: NDArray[np.float64]


@cache
def numbers(name: str) -> Mapping[str, Any]:
    """Return what the thesis gives on a table, figure or subject.

    Parameters
    ----------
    name : str
        A key of ``numbers.yaml``.
    """
    found: Mapping[str, Any] = _all()[name]
    return found


@cache
def _all() -> Mapping[str, Any]:
    import yaml

    data: Mapping[str, Any] = yaml.safe_load(FILE.read_text(encoding="utf-8"))
    return data


@cache
def error_table(name: str) -> ErrorTable:
    """Return a table of errors.

    Parameters
    ----------
    name : str
        ``table-4.3`` and the like.
    """
    data = numbers(name)
    columns = tuple(data["columns"])
    units = tuple(data.get("units") or [data["unit"]] * len(columns))
    values = np.array(list(data["rows"].values()), dtype=np.float64)
    values.setflags(write=False)
    return ErrorTable(data["place"], tuple(data["rows"]), columns, units, values)
