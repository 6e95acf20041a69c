"""Numbers that come in any amount, kept as their mean, range and quantiles in little memory."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np
from numpy.typing import ArrayLike, NDArray

Reals = NDArray[np.float64]

EXACT = 4096
"""Up to so many numbers quantiles are exact."""
SCALE = 500.0
"""Beyond, numbers are merged into about as many means, the fewest at the ends: a t-digest."""
SMALL_SCALE = 100.0
"""How many means stay of numbers that are to take little memory."""


@dataclass
class Numbers:
    """What numbers came to so far.

    Up to `EXACT` of them all are kept. Beyond, quantiles are those of a merging t-digest (Dunning
    & Ertl 2019, scale function k1): their rank is right within about 0.3 % in the middle, and
    better towards both ends.
    """

    n: int = 0
    n_not_finite: int = 0
    total: float = 0.0
    least: float = np.inf
    most: float = -np.inf
    _means: Reals = field(default_factory=lambda: np.empty(0))
    _weights: Reals = field(default_factory=lambda: np.empty(0))
    _new: list[Reals] = field(default_factory=list)
    _n_new: int = 0

    def add(self, values: ArrayLike) -> None:
        """Take in numbers; infinities and NaN are counted alone."""
        given = np.asarray(values, dtype=np.float64)
        finite = given[np.isfinite(given)]
        self.n_not_finite += given.size - finite.size
        if not finite.size:
            return
        self.n += finite.size
        self.total += float(np.sum(finite))
        self.least = min(self.least, float(finite.min()))
        self.most = max(self.most, float(finite.max()))
        self._new.append(finite)
        self._n_new += finite.size
        if self._n_new > EXACT:
            self._merge()

    def take(self, other: Numbers) -> None:
        """Take in what others came to; they are used up."""
        self.n_not_finite += other.n_not_finite
        if not other._means.size:
            for values in other._new:
                self.add(values)
            return
        other._merge()
        self._merge()
        self.n += other.n
        self.total += other.total
        self.least, self.most = min(self.least, other.least), max(self.most, other.most)
        self._means = np.concatenate([self._means, other._means])
        self._weights = np.concatenate([self._weights, other._weights])
        self._new = [np.empty(0)]
        self._merge()

    def compress(self) -> None:
        """Keep a few means alone: ranks are then right within about 1 %."""
        if self.n > SMALL_SCALE:
            self._merge(SMALL_SCALE)

    @property
    def mean(self) -> float:
        """Their mean; NaN of none."""
        return self.total / self.n if self.n else np.nan

    def quantiles(self, shares: ArrayLike) -> Reals:
        """Return the quantiles at shares between 0 and 1; NaN of none.

        Parameters
        ----------
        shares : array_like of float64, shape (K,)

        Returns
        -------
        ndarray of float64, shape (K,)
        """
        wanted = np.asarray(shares, dtype=np.float64)
        if not self.n:
            return np.full(wanted.shape, np.nan)
        if not self._means.size:
            return np.asarray(np.quantile(np.concatenate(self._new), wanted))
        self._merge()
        middles = np.cumsum(self._weights) - 0.5 * self._weights
        at = np.concatenate([[0.0], middles, [self.n]])
        values = np.concatenate([[self.least], self._means, [self.most]])
        return np.asarray(np.interp(wanted * self.n, at, values))

    def _merge(self, scale: float = SCALE) -> None:
        """Merge what came since into means that each stand for about as much of the scale."""
        if not self._new:
            return
        means = np.concatenate([self._means, *self._new])
        weights = np.concatenate([self._weights, np.ones(self._n_new)])
        order = np.argsort(means, kind="stable")
        means, weights = means[order], weights[order]
        share = (np.cumsum(weights) - 0.5 * weights) / weights.sum()
        place = np.floor(scale / np.pi * (np.arcsin(2.0 * share - 1.0) + np.pi / 2))
        _, group = np.unique(place, return_inverse=True)
        self._weights = np.bincount(group, weights).astype(np.float64)
        self._means = np.bincount(group, weights * means) / self._weights
        self._new, self._n_new = [], 0
