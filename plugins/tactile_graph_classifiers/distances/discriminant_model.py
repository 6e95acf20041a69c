"""A quadratic discriminant in canonical variates, and the distance of what it does not know."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from tactile_graph_classifiers.database.choice import Manner
from tactile_graph_classifiers.distances.canonical import Space, WithLogarithms, means_of, product

Array = NDArray[np.float64]
Labels = NDArray[np.intp]


class Scores(NamedTuple):
    """What a discriminant says of readings.

    Parameters
    ----------
    unlikeliness : ndarray, shape (n, K)
        Minus twice the log likelihood, of each object, up to a constant.
    squares : ndarray, shape (n, K)
        Squared distance within the variates.
    beside : ndarray, shape (n, K)
        Squared distance beside them.
    """

    unlikeliness: Array
    squares: Array
    beside: Array

    def at(self, objects: Labels, beyond: float) -> Array:
        """Return each reading's squared distance to one object, shape (n,)."""
        rows = np.arange(len(objects))
        return np.asarray(self.squares[rows, objects] + beyond * self.beside[rows, objects])


class Discriminant(NamedTuple):
    """Known objects as a discriminant sees them.

    Parameters
    ----------
    space : Space
        Its variates are those used.
    means : ndarray, shape (K, T)
        In the coordinates of the space.
    roots : ndarray, shape (K, V, V)
        Of the inverse covariance in the variates: precision = root @ root.T.
    log_determinants : ndarray, shape (K,)
        Of the covariances.
    counts : ndarray of int, shape (K,)
        How many readings each mean was made of.
    """

    space: Space
    means: Array
    roots: Array
    log_determinants: Array
    counts: Labels

    def __call__(self, coordinates: Array, n_presses: int = 1) -> Scores:
        """Return the scores of readings in the space's coordinates, shape (n, T).

        Parameters
        ----------
        coordinates : ndarray, shape (n, T)
        n_presses : int
            How many readings of one object each of them is the mean of: the more, the less it
            varies.
        """
        off = (coordinates @ self.space.variates)[None] - (self.means @ self.space.variates)[
            :, None
        ]
        squares = np.square(off @ self.roots).sum(axis=2).T
        within = np.square(off).sum(axis=2).T
        beside = np.maximum(_squared_distances(coordinates, self.means) - within, 0.0)
        varies = 1.0 / n_presses + 1.0 / self.counts
        squares, beside = squares / varies, beside / varies
        n_variates = self.space.variates.shape[1]
        log_determinants = self.log_determinants + n_variates * np.log(varies)
        return Scores(squares + log_determinants, squares, beside)


def _squared_distances(rows: Array, means: Array) -> Array:
    """Return the squared distance of each row to each mean, shape (n, K)."""
    middle = means.mean(axis=0)  # which keeps the squares small that are taken from each other
    rows, means = rows - middle, means - middle
    mixed = np.square(rows).sum(axis=1)[:, None] - 2.0 * product(rows, means.T)
    return np.asarray(mixed + np.square(means).sum(axis=1))


class Learned(NamedTuple):
    """Readings of known objects in the coordinates of their space.

    Parameters
    ----------
    extend : WithLogarithms
    space : Space
    coordinates : ndarray, shape (n, T)
    labels : ndarray of int, shape (n,)
    """

    extend: WithLogarithms
    space: Space
    coordinates: Array
    labels: Labels

    @classmethod
    def of(cls, readings: Array, labels: Labels, shrinkage: float) -> Learned:
        """Return readings, shape (n, F), in coordinates made of them."""
        extend = WithLogarithms.of(readings)
        rows = extend(readings)
        space = Space.of(rows, labels, shrinkage)
        return cls(extend, space, product(rows, space.whitening), labels)

    def located(self, readings: Array) -> Array:
        """Return other readings, shape (n, F), in the same coordinates, shape (n, T)."""
        return product(self.extend(readings), self.space.whitening)

    def discriminant(self, manner: Manner) -> Discriminant:
        """Return the discriminant made in a manner of this shrinkage.

        Notes
        -----
        J. H. Friedman, Regularized discriminant analysis, 1989,
        doi:10.1080/01621459.1989.10478752. The covariance of all objects is 1 here.
        """
        variates = self.space.variates[:, : manner.variates]
        n_variates = variates.shape[1]
        means = means_of(self.coordinates, self.labels)
        off = (self.coordinates - means[self.labels]) @ variates
        counts = np.bincount(self.labels)
        covariances = np.empty((len(counts), n_variates, n_variates))
        for k, n in enumerate(counts):
            own = off[self.labels == k]
            prior = manner.prior_readings * np.eye(n_variates)
            covariances[k] = (own.T @ own + prior) / (n - 1.0 + manner.prior_readings)
        log_determinants = np.linalg.slogdet(covariances)[1]
        roots = np.linalg.cholesky(np.linalg.inv(covariances))
        space = Space(self.space.whitening, variates)
        return Discriminant(space, means, roots, log_determinants, counts)
