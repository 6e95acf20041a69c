"""Step ``minimum_distance``: the known object of least distance by equation 4.8."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated, Any, Literal

import numpy as np
from annotated_types import Gt, Lt, MinLen
from numpy.typing import NDArray

from tactile_graph.errors import DataError
from tactile_graph_classifiers.database.known import Known
from tactile_graph_classifiers.distances.classifier import (
    DEFAULT_FEATURES,
    Lookup,
    share_of_features,
)
from tactile_graph_classifiers.distances.identity import Identity
from tactile_graph_classifiers.distances.left_out import largest_accepted, left_out
from tactile_graph_classifiers.distances.nearest import nearest
from tactile_graph_classifiers.distances.variances import variances_of
from tactile_graph_classifiers.measuring.measurements import Measurements

Array = NDArray[np.float64]


class MinimumDistance:
    """Return which known object a reading is nearest to, each feature over its variance.

    Parameters
    ----------
    database : Path or mapping, optional
        The object database, or an export of one; the sample of the thesis' objects if not given.
        It is read once, when the pipeline is loaded.
    features : list of str
        Which features to compare.
    weights : list of float, optional
        Weighs the features' terms against each other.
    over : "variance" or "deviation"
        What a difference is divided by before it is squared; equation 4.8 has the variance, which
        makes features of different units incomparable, the deviation does not.
    reject : bool
        Whether a reading too far from every object is unknown.
    confidence : float
        Share of a known object's readings to be accepted.

    Notes
    -----
    Equation 4.8 of the thesis, after Christ and Sanderson, 1982. The distance given is the root of
    the equation's d. How far is too far is learned from how far each stored reading lies from its
    own object learned without it.
    """

    stateless = True

    def __init__(
        self,
        *,
        database: Path | dict[str, Any] | None = None,
        features: Annotated[list[str], MinLen(1)] = DEFAULT_FEATURES,
        weights: list[float] | None = None,
        over: Literal["variance", "deviation"] = "variance",
        reject: bool = True,
        confidence: Annotated[float, Gt(0), Lt(1)] = 0.99,
    ) -> None:
        self._lookup = Lookup(database, features)
        self.takes, self.takes_by, self.takes_hint = self._lookup.taken
        known = self._lookup.known
        share = share_of_features(weights, len(known.features))
        power = 2.0 if over == "variance" else 1.0
        variances = variances_of(known)
        self._means = known.means
        self._precisions = _diagonals(share * _inverse(known, variances, power))
        self._limits = _limits(known, variances, share, power, confidence) if reject else None

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


def _inverse(known: Known, variances: Array, power: float) -> Array:
    """Return one over a power of the variances, shape (K, F)."""
    with np.errstate(over="ignore"):  # told below
        found = variances**-power
    for k, i in np.argwhere(np.isinf(found)):
        raise DataError(
            known.where,
            f"{known.features[i]!r} of {known.names[k]!r} has a variance of {variances[k, i]:.3g},"
            " too small to divide by; leave it out, or take the step 'mahalanobis'",
        )
    return np.asarray(found)


def _diagonals(rows: Array) -> Array:
    """Return a diagonal matrix for each row, shape (K, F, F)."""
    return np.ascontiguousarray(rows[:, :, None] * np.eye(rows.shape[1]))


def _limits(known: Known, variances: Array, share: Array, power: float, confidence: float) -> Array:
    """Return the largest squared distance at which each object is accepted, shape (K,)."""
    typical = (share * variances ** (1 - power)).sum(axis=1)
    ratios = []
    for out in left_out(known):
        own = np.diagonal(out.scatters, axis1=1, axis2=2) / (out.n_left - 1)
        usable = (own > 0.0).all(axis=1)  # the one reading that differed may be the one left out
        off = (out.readings - out.means)[usable]
        own = own[usable]
        squares = (share * (off / own ** (0.5 * power)) ** 2).sum(axis=1)
        ratios.append(squares / (share * own ** (1 - power)).sum(axis=1))
    found = np.concatenate(ratios) if ratios else np.zeros(0)
    return np.asarray(typical * largest_accepted(found, confidence))
