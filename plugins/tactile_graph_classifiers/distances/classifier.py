"""What the classifier steps share: known objects, features looked up, the answer as a record."""

from __future__ import annotations

import math
from collections.abc import Sequence
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from tactile_graph.errors import DataError
from tactile_graph.quantities import is_quantity
from tactile_graph_classifiers.database.known import Known
from tactile_graph_classifiers.distances.identity import UNKNOWN, Identity
from tactile_graph_classifiers.distances.nearest import Two
from tactile_graph_classifiers.measuring.measurements import Measurements

Array = NDArray[np.float64]
DEFAULT_FEATURES = ["weight", "area_cm2"]
"""The two features of thesis section 4.4."""


class Taken(NamedTuple):
    """What a classifier says to the loader of the quantities it takes.

    Parameters
    ----------
    takes : dict
        Quantities by port.
    takes_by : str
        The setting that is due to; empty where nobody gave it.
    takes_hint : str
        What to do about another one.
    """

    takes: dict[str, tuple[str, ...]]
    takes_by: str
    takes_hint: str


class Lookup:
    """The known objects a classifier chooses from, and the way from a reading to its vector.

    Parameters
    ----------
    database : Path, mapping or None
        As the steps take it.
    features : sequence of str, optional
        All that were learned if not given.

    Attributes
    ----------
    taken : Taken
        The quantity the objects were learned in, for the loader to check.
    """

    def __init__(
        self, database: Path | dict[str, Any] | None, features: Sequence[str] | None
    ) -> None:
        from tactile_graph_classifiers.database.opening import load_known

        self._take(load_known(database, features), database is not None)

    @classmethod
    def of(cls, known: Known, named: bool) -> Lookup:
        """Return the lookup of objects that were read already.

        Parameters
        ----------
        known : Known
        named : bool
            Whether the setting ``database`` names where they are from.
        """
        made = cls.__new__(cls)
        made._take(known, named)
        return made

    def _take(self, known: Known, named: bool) -> None:
        self.known: Known = known
        if not self.known.objects:
            raise DataError(self.known.where, "no object was learned yet")
        quantity = self.known.quantity
        self.taken = Taken(
            {"features": (quantity,)} if is_quantity(quantity) else {},
            "database" if named else "",
            f"{self.known.where}: {self.known.remedy}",
        )
        # One attribute for both: threads may share a classifier.
        self._last: tuple[tuple[str, ...], NDArray[np.intp]] = ((), np.zeros(0, np.intp))

    def vector(self, features: Measurements) -> Array:
        """Return the chosen features of a reading, shape (F,).

        Parameters
        ----------
        features : Measurements

        Raises
        ------
        DataError
            If a feature was not measured or is not finite, or the reading is in another unit.
        """
        names, positions = self._last
        if features.names is not names:
            positions = features.positions(self.known.features)
            self._last = (features.names, positions)
        if features.quantity != self.known.quantity:
            self.known.measured(features.quantity)
        vector: Array = features.values[positions]
        if not math.isfinite(vector @ vector):
            self._refuse(vector)
        return vector

    def _refuse(self, vector: Array) -> None:
        for name, value in zip(self.known.features, vector.tolist(), strict=True):
            if not math.isfinite(value):
                raise DataError("features", f"{name!r} must be a finite number, got {value}")

    def identity(self, two: Two, limits: Array | None) -> Identity:
        """Return the answer that the two nearest objects make.

        Parameters
        ----------
        two : (int, int, float, float)
            The two nearest and their squared distances.
        limits : ndarray, shape (K,), optional
            Largest squared distance at which each is accepted.

        Raises
        ------
        DataError
            If even the nearest is beyond what a number can hold.
        """
        best, second, square, next_square = two
        objects = self.known.objects
        if not math.isfinite(square):
            raise DataError("features", "they are too far from every known object for a number")
        known = limits is None or square <= limits[best]
        distance = math.sqrt(square)
        single = second < 0
        beyond = math.sqrt(next_square) if next_square < math.inf else None
        if single or beyond is None:
            margin = 1.0
        else:
            margin = 1.0 - distance / beyond if beyond > 0.0 else 0.0
        return Identity(
            objects[best].name if known else UNKNOWN,
            objects[best].shape if known else "",
            bool(known),
            distance,
            None if limits is None else math.sqrt(limits[best]),
            objects[best].name,
            "" if single else objects[second].name,
            beyond,
            margin,
        )


def share_of_features(weights: Sequence[float] | None, n_features: int) -> Array:
    """Return the weight of each feature, shape (F,); 1 unless given.

    Parameters
    ----------
    weights : sequence of float, optional
    n_features : int

    Raises
    ------
    ValueError
        If there is not one for each feature, or one is below 0, or all are 0.
    """
    if weights is None:
        return np.ones(n_features)
    if len(weights) != n_features or min(weights) < 0.0 or max(weights) == 0.0:
        raise ValueError(
            f"weights: needs one number >= 0 for each of the {n_features} features, not all 0,"
            f" got {list(weights)}"
        )
    return np.array(weights, dtype=np.float64)
