"""Variances of each object's features, where a distance divides by them."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from tactile_graph.errors import DataError
from tactile_graph_classifiers.database.known import Known

Array = NDArray[np.float64]


def variances_of(known: Known) -> Array:
    """Return the variance of each feature of each object, shape (K, F).

    Parameters
    ----------
    known : Known

    Raises
    ------
    DataError
        If an object has a single reading, or a feature that never varied.
    """
    variances = np.diagonal(known.covariances, axis1=1, axis2=2)
    for it, row in zip(known.objects, variances, strict=True):
        if it.statistics.n < 2:
            raise DataError(
                known.where,
                f"{it.name!r} has {it.statistics.n} reading: a variance needs at least 2;"
                " learn more, or take the step 'mahalanobis'",
            )
        for name, variance in zip(known.features, row, strict=True):
            if not variance > 0.0:
                raise DataError(
                    known.where,
                    f"{name!r} is the same in all {it.statistics.n} readings of {it.name!r}, and"
                    " this distance divides by its variance; leave it out, or take the step"
                    " 'mahalanobis'",
                )
    return np.ascontiguousarray(variances)


def borrowed_variances_of(known: Known) -> Array:
    """Return the same, whatever varies; an object of one reading borrows from the others.

    Its variance is what theirs makes of a further reading.

    Parameters
    ----------
    known : Known

    Raises
    ------
    DataError
        If no object has two readings.
    """
    variances = np.diagonal(known.covariances, axis1=1, axis2=2)
    single = known.counts < 2
    if single.all():
        raise known.nothing_varies()
    common = np.diagonal(known.scatters.sum(axis=0)) / (known.counts[~single] - 1.0).sum()
    return np.where(single[:, None], 2.0 * common, variances)
