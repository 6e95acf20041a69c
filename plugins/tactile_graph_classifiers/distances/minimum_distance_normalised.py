"""Step ``minimum_distance_normalised``: least distance, each feature over its largest one."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated, Any

import numpy as np
from annotated_types import Gt, Lt, MinLen
from numpy.typing import NDArray

from tactile_graph_classifiers.database.known import Known
from tactile_graph_classifiers.distances.classifier import (
    DEFAULT_FEATURES,
    Lookup,
    share_of_features,
)
from tactile_graph_classifiers.distances.identity import Identity
from tactile_graph_classifiers.distances.left_out import LeftOut, largest_accepted, left_out
from tactile_graph_classifiers.distances.nearest import nearest_normalised
from tactile_graph_classifiers.distances.variances import borrowed_variances_of, variances_of
from tactile_graph_classifiers.measuring.measurements import Measurements

Array = NDArray[np.float64]
FARTHEST = 0.75
"""Share of the largest squared distance there can be that a limit is at most. Strangers far away
come near that distance, an object's own readings hardly ever."""


class MinimumDistanceNormalised:
    """Return which known object a reading is nearest to, as the thesis modified the distance.

    Parameters
    ----------
    database : Path or mapping, optional
        The object database, or an export of one; the sample of the thesis' objects if not given.
        It is read once, when the pipeline is loaded.
    features : list of str
        Which features to compare.
    weights : list of float, optional
        Weighs the features' terms against each other.
    keep_variance : bool
        Whether a difference is first divided by the object's variance: equations 4.9 and 4.10 do,
        the text beside them leaves it out.
    reject : bool
        Whether a reading too far from every object is unknown; it takes at least two objects.
    confidence : float
        Share of a known object's readings to be accepted.

    Raises
    ------
    ValueError
        If it is to reject and there is only one object: every distance is then the same.
    DataError
        If it is to reject and no object has two readings.

    Notes
    -----
    Thesis section 4.4.1. Each feature's distance is divided by the largest one to any known
    object, so the answer depends on which others are known, and no distance is larger than the
    root of the sum of the weights. What is accepted is learned as for `minimum_distance`, but never
    so much that a stranger far off in every feature is known; where objects differ little for how
    they vary, one far off in some of the features may be: take `mahalanobis` there. An object of
    one reading borrows the variance of the others.
    """

    stateless = True

    def __init__(
        self,
        *,
        database: Path | dict[str, Any] | None = None,
        features: Annotated[list[str], MinLen(1)] = DEFAULT_FEATURES,
        weights: list[float] | None = None,
        keep_variance: bool = False,
        reject: bool = True,
        confidence: Annotated[float, Gt(0), Lt(1)] = 0.99,
    ) -> None:
        self._lookup = Lookup(database, features)
        self.takes, self.takes_by, self.takes_hint = self._lookup.taken
        known = self._lookup.known
        if reject and len(known.objects) < 2:
            raise ValueError(
                f"reject: with {known.names[0]!r} alone every distance is the same after"
                " normalising; learn another object, or set it to false"
            )
        self._share = share_of_features(weights, len(known.features))
        self._means = known.means
        self._scales = variances_of(known) if keep_variance else np.ones(known.means.shape)
        self._keep_variance = keep_variance
        self._limits = self._learned(known, confidence) if reject else None

    def __call__(self, features: Measurements) -> Identity:
        """Return the nearest object, the runner-up and their margin.

        Raises
        ------
        DataError
            If a feature was not measured or is not finite, or the reading is in another unit.
        """
        vector = self._lookup.vector(features)
        two = nearest_normalised(vector, self._means, self._scales, self._share)
        return self._lookup.identity(two, self._limits)

    # -- what is accepted --------------------------------------------------------------------

    def _learned(self, known: Known, confidence: float) -> Array:
        """Return the largest squared distance at which each object is accepted, shape (K,)."""
        variances = borrowed_variances_of(known)
        typical = np.array(
            [self._typical(k, m, v) for k, (m, v) in enumerate(zip(known.means, variances,
                                                                   strict=True))]
        )  # fmt: skip
        ratios = [self._ratios(out) for out in left_out(known)]
        found = np.concatenate(ratios) if ratios else np.zeros(0)
        learned = typical * largest_accepted(found, confidence)
        return np.asarray(np.minimum(learned, FARTHEST * self._share.sum()))

    def _largest(self, number: int, reading: Array) -> Array:
        """Return what each feature is divided by for a reading of an object, shape (F,)."""
        others = np.arange(len(self._means)) != number
        largest = (((reading - self._means) / self._scales) ** 2)[others].max(axis=0)
        return np.where(largest > 0.0, largest, 1.0)

    def _typical(self, number: int, mean: Array, variance: Array) -> float:
        """Return the squared distance to be expected between an object and its readings."""
        parts = variance / self._scales[number] ** 2
        return float(self._share @ (parts / self._largest(number, mean)))

    def _ratios(self, out: LeftOut) -> Array:
        """Return each reading's squared distance to its object, over the one to be expected."""
        ratios = []
        for reading, mean, scatter in zip(out.readings, out.means, out.scatters, strict=True):
            variance = np.diagonal(scatter) / (out.n_left - 1)
            scale = variance if self._keep_variance else np.ones(mean.shape)
            if not (scale > 0.0).all():
                continue
            typical = self._share @ (variance / scale**2 / self._largest(out.object, mean))
            parts = ((reading - mean) / scale) ** 2
            largest = np.maximum(self._largest(out.object, reading), parts)
            if typical > 0.0:
                ratios.append(float(self._share @ (parts / largest) / typical))
        return np.array(ratios, dtype=np.float64)
