"""Maximum and average errors, and between what they lie in groups as large as the thesis'."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

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
