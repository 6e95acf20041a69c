"""Step ``mahalanobis``: the known object of least Mahalanobis distance, covariances shrunk."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated, Any, NamedTuple

import numpy as np
from annotated_types import Ge, Gt, Lt, MinLen
from numpy.typing import NDArray

from tactile_graph_classifiers.database.known import Known
from tactile_graph_classifiers.distances.classifier import DEFAULT_FEATURES, Lookup
from tactile_graph_classifiers.distances.identity import Identity
from tactile_graph_classifiers.distances.left_out import LeftOut, largest_accepted, left_out
from tactile_graph_classifiers.distances.nearest import nearest
from tactile_graph_classifiers.measuring.measurements import Measurements

Array = NDArray[np.float64]
RESOLUTION = 1e-3
"""Share of a feature's range over all readings below which a spread is not believed."""


class Mahalanobis:
    """Return which known object a reading is nearest to by its Mahalanobis distance.

    Parameters
    ----------
    database : Path or mapping, optional
        The object database, or an export of one; the sample of the thesis' objects if not given.
        It is read once, when the pipeline is loaded.
    features : list of str
        Which features to compare.
    prior_readings : float
        How many readings the common covariance of all objects counts for beside an object's own:
        it carries an object of few readings and fades with more. A large number makes all
        covariances the same.
    reject : bool
        Whether a reading too far from every object is unknown.
    confidence : float
        Share of a known object's readings to be accepted.

    Raises
    ------
    DataError
        If no object has two readings.

    Notes
    -----
    P. C. Mahalanobis, 1936. The covariances are shrunk to the pooled one, and that to its own
    diagonal, in proportion to readings (after J. H. Friedman, Regularized discriminant analysis,
    1989, doi:10.1080/01621459.1989.10478752). How far is too far is learned from how far each
    stored reading lies from its own object learned without it.
    """

    stateless = True

    def __init__(
        self,
        *,
        database: Path | dict[str, Any] | None = None,
        features: Annotated[list[str], MinLen(1)] = DEFAULT_FEATURES,
        prior_readings: Annotated[float, Ge(0)] = 4.0,
        reject: bool = True,
        confidence: Annotated[float, Gt(0), Lt(1)] = 0.99,
    ) -> None:
        self._lookup = Lookup(database, features)
        self.takes, self.takes_by, self.takes_hint = self._lookup.taken
        known = self._lookup.known
        shrinkage = _Shrinkage.of(known, prior_readings)
        covariances = shrinkage(known.scatters, known.counts - 1.0)
        self._means = known.means
        self._precisions = np.ascontiguousarray(np.linalg.inv(covariances))
        self._limits: Array | None = None
        if reject:
            ratios = [_ratios(out, shrinkage) for out in left_out(known)]
            found = np.concatenate(ratios) if ratios else np.zeros(0)
            typical = len(known.features) * (1.0 + 1.0 / known.counts)
            self._limits = np.asarray(typical * largest_accepted(found, confidence))

    def __call__(self, features: Measurements) -> Identity:
        """Return the nearest object, the runner-up and their margin.

        Raises
        ------
        DataError
            If a feature was not measured or is not finite, or the reading is in another unit.
        """
        vector = self._lookup.vector(features)
        two = nearest(vector, self._means, self._precisions)
        return self._lookup.identity(two, self._limits)


class _Shrinkage(NamedTuple):
    """How covariances are made from scatters: pooled scatter, its readings, prior, floor."""

    scatter: Array
    freedom: float
    prior: float
    floor: Array

    @classmethod
    def of(cls, known: Known, prior: float) -> _Shrinkage:
        freedom = float(np.maximum(known.counts - 1.0, 0.0).sum())
        if freedom == 0.0:
            raise known.nothing_varies()
        readings = np.concatenate([o.readings for o in known.objects])
        extent = np.ptp(readings, axis=0)
        # a feature that is the same in every reading says nothing until one differs
        floor = np.where(extent > 0.0, RESOLUTION * extent, np.maximum(1.0, abs(readings[0])))
        return cls(
            known.scatters.sum(axis=0),
            freedom,
            prior,
            floor**2,
        )

    def without(self, taken: Array) -> _Shrinkage:
        """Return the same with part of the pooled scatter taken out, one reading each."""
        return self._replace(scatter=self.scatter - taken, freedom=self.freedom - 1.0)

    def __call__(self, scatters: Array, freedom: Array | float) -> Array:
        """Return covariances, shape (…, F, F), of scatters of that many degrees of freedom."""
        pooled = self.scatter / max(self.freedom, 1.0)
        diagonal = np.eye(len(self.floor)) * np.diagonal(pooled, axis1=-2, axis2=-1)[..., None, :]
        lean = max(self.prior, 1e-9)  # without a prior, an object of one reading still needs one
        pooled = (self.freedom * pooled + lean * diagonal) / (self.freedom + lean)
        weight = np.asarray(freedom, dtype=np.float64)[..., None, None]
        return np.asarray((scatters + lean * pooled) / (weight + lean) + np.diag(self.floor))


def _ratios(out: LeftOut, shrinkage: _Shrinkage) -> Array:
    """Return each reading's squared distance to its object, over the one to be expected."""
    off = out.readings - out.means
    n = out.n_left + 1
    taken = off[:, :, None] * off[:, None, :] * (out.n_left / n)
    covariances = shrinkage.without(taken)(out.scatters, float(out.n_left - 1))
    squares = np.einsum("ni,nij,nj->n", off, np.linalg.inv(covariances), off)
    return np.asarray(squares / (off.shape[1] * (1.0 + 1.0 / out.n_left)))
