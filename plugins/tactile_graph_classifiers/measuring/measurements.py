"""``Measurements``: one reading of an object as named numbers, which classifiers take."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from tactile_graph.errors import DataError, did_you_mean, one_of


@dataclass(frozen=True, eq=False)
class Measurements:
    """One reading of an object: named features.

    A plugin's own features reach the classifiers as this, or as a record that provides it.

    Parameters
    ----------
    names : tuple of str
        Names of the features, units included where there are any; each once.
    values : ndarray of float64, shape (len(names),)
    quantity : str
        What the image's values meant that weights and loads are in; empty where none are.
    """

    names: tuple[str, ...]
    values: NDArray[np.float64]
    quantity: str = ""

    def __post_init__(self) -> None:
        self.values.setflags(write=False)

    def positions(self, wanted: tuple[str, ...]) -> NDArray[np.intp]:
        """Return where each of the wanted features stands.

        Parameters
        ----------
        wanted : tuple of str

        Raises
        ------
        DataError
            If one of them was not measured.
        """
        for name in wanted:
            if name not in self.names:
                hint = did_you_mean(name, self.names) or f"; there are: {one_of(self.names, 30)}"
                raise DataError("features", f"{name!r} was not measured{hint}")
        return np.array([self.names.index(name) for name in wanted], dtype=np.intp)

    def replaced(self, name: str, value: float) -> Measurements:
        """Return the same reading with another value of one feature, added if it had none.

        Parameters
        ----------
        name : str
        value : float
        """
        if name not in self.names:
            return Measurements((*self.names, name), np.append(self.values, value), self.quantity)
        values = self.values.copy()
        values[self.names.index(name)] = value
        return Measurements(self.names, values, self.quantity)
