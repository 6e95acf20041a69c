"""``Known``: the objects of a database in memory, as classifiers take them."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from tactile_graph.errors import DataError, did_you_mean, one_of
from tactile_graph_classifiers.database.choice import FEW, Choice
from tactile_graph_classifiers.database.instrument import Instrument
from tactile_graph_classifiers.database.statistics import Statistics

Array = NDArray[np.float64]


class OtherQuantityError(DataError):
    """Readings in another unit than that the objects were learned in."""


class OtherPadError(DataError):
    """Readings of another pad than the one on which the objects' reliefs were learned."""


@dataclass(frozen=True, eq=False)
class KnownObject:
    """One object with its readings.

    Parameters
    ----------
    name : str
    shape : str
        disc, rectangle, ellipse, polygon; empty where nobody said.
    readings : ndarray, shape (n, F)
    statistics : Statistics
        Of these readings.
    sources : tuple of str
        Where each reading comes from.
    """

    name: str
    shape: str
    readings: Array
    statistics: Statistics
    sources: tuple[str, ...] = ()


@dataclass(frozen=True, eq=False)
class Known:
    """Objects whose readings measure the same features.

    Parameters
    ----------
    where : str
        The file, for errors.
    features : tuple of str
    quantity : str
        What the images' values meant.
    objects : tuple of KnownObject
    pipeline : str
        Name of the pipeline that measured them.
    choice : Choice, optional
        How a discriminant of all these features tells them apart best, where that is known.
    instrument : Instrument, optional
        What they were recorded with, where that is known.
    """

    where: str
    features: tuple[str, ...]
    quantity: str
    objects: tuple[KnownObject, ...]
    pipeline: str = ""
    choice: Choice | None = None
    instrument: Instrument | None = None

    @property
    def names(self) -> tuple[str, ...]:
        """The objects' names, in order."""
        return tuple(o.name for o in self.objects)

    @cached_property
    def counts(self) -> Array:
        """Number of readings of each object, shape (K,)."""
        return np.array([o.statistics.n for o in self.objects], dtype=np.float64)

    @cached_property
    def means(self) -> Array:
        """Mean of each object, shape (K, F)."""
        return np.array([o.statistics.mean for o in self.objects])

    @cached_property
    def scatters(self) -> Array:
        """Scatter of each object, shape (K, F, F)."""
        return np.array([o.statistics.scatter for o in self.objects])

    @cached_property
    def covariances(self) -> Array:
        """Unbiased covariance of each object, shape (K, F, F)."""
        return np.array([o.statistics.covariance for o in self.objects])

    @property
    def few(self) -> str:
        """What to say of objects with fewer than `FEW` readings; empty where there are none."""
        few = [f"{o.name} ({o.statistics.n})" for o in self.objects if o.statistics.n < FEW]
        return f"fewer than {FEW} readings of {one_of(few, 6)}" if few else ""

    def nothing_varies(self) -> DataError:
        """Return the error that no object has two readings."""
        return DataError(
            self.where,
            "no object has two readings, so nothing says how much readings vary; learn more",
        )

    def chosen(self, features: Sequence[str] | None) -> Known:
        """Return the objects with these features alone.

        Parameters
        ----------
        features : sequence of str, optional
            All that were learned if not given.

        Raises
        ------
        ValueError
            If a feature is named twice, or none.
        DataError
            If one of them was not learned.
        """
        if features is None:
            return self
        if not features or len(set(features)) != len(features):
            raise ValueError(f"features: name at least one, each once, got {list(features)}")
        for name in features:
            if name not in self.features:
                near = did_you_mean(name, self.features)
                hint = near or f"; there are: {one_of(self.features, 30)}"
                raise DataError(self.where, f"no feature named {name!r} was learned{hint}")
        at = [self.features.index(f) for f in features]
        objects = tuple(
            KnownObject(
                o.name,
                o.shape,
                o.readings[:, at],
                Statistics(
                    o.statistics.n, o.statistics.mean[at], o.statistics.scatter[np.ix_(at, at)]
                ),
                o.sources,
            )
            for o in self.objects
        )
        return Known(
            self.where, tuple(features), self.quantity, objects, self.pipeline,
            instrument=self.instrument,
        )  # fmt: skip

    def same_readings(self, other: Known) -> bool:
        """Return whether both hold the same readings of the same objects.

        Parameters
        ----------
        other : Known
        """
        mine, theirs = self.objects, other.objects
        return (self.features, self.names) == (other.features, other.names) and all(
            np.array_equal(a.readings, b.readings) for a, b in zip(mine, theirs, strict=True)
        )

    @property
    def remedy(self) -> str:
        """What to do about readings in another unit."""
        raw = ", or take these for bare readings too (--with quantity=raw)"
        return (
            f"the objects were learned in {self.quantity}; learn them from recordings like these"
            " (tactile-graph learn),"
            " into another database, and name that as the step's database"
            f"{raw if self.quantity == 'raw' else ''}"
        )

    def measured(self, quantity: str) -> None:
        """Check that a reading is in the unit the objects were learned in.

        Parameters
        ----------
        quantity : str
            Empty where a reading does not say.

        Raises
        ------
        OtherQuantityError
            If it is not.
        """
        if quantity and self.quantity and quantity != self.quantity:
            raise OtherQuantityError(self.where, f"this reading is in {quantity}; {self.remedy}")
