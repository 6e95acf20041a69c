"""``Statistics``: mean and covariance of readings, kept up to date as readings come."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class Statistics:
    """First and second order statistics of n readings of F features.

    Parameters
    ----------
    n : int
    mean : ndarray, shape (F,)
    scatter : ndarray, shape (F, F)
        Sum over the readings of the products of deviations from the mean.
    """

    n: int
    mean: Array
    scatter: Array

    @classmethod
    def none(cls, n_features: int) -> Statistics:
        """Return the statistics of no reading.

        Parameters
        ----------
        n_features : int
        """
        return cls(0, np.zeros(n_features), np.zeros((n_features, n_features)))

    @classmethod
    def of(cls, readings: Array) -> Statistics:
        """Return the statistics of readings, shape (n, F).

        Parameters
        ----------
        readings : ndarray, shape (n, F)
        """
        n, n_features = readings.shape
        if n == 0:
            return cls.none(n_features)
        mean = readings.mean(axis=0)
        off = readings - mean
        return cls(n, mean, off.T @ off)

    @property
    def covariance(self) -> Array:
        """Unbiased covariance, shape (F, F); 0 for fewer than two readings."""
        return self.scatter / max(self.n - 1, 1)

    def joined(self, other: Statistics) -> Statistics:
        """Return the statistics of both sets of readings together.

        Parameters
        ----------
        other : Statistics

        Notes
        -----
        Chan, Golub and LeVeque, 1983, doi:10.1080/00031305.1983.10483115: no sum of squares is
        formed, so nothing cancels where the mean is large against the spread.
        """
        n = self.n + other.n
        if n == 0:
            return self
        off = other.mean - self.mean
        mean = self.mean + off * (other.n / n)
        scatter = self.scatter + other.scatter + np.outer(off, off) * (self.n * other.n / n)
        return Statistics(n, mean, scatter)
