"""Canonical variates: the directions in which known objects differ most for how they vary."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
RESOLUTION = 1e-3
"""Share of a feature's deviation over all readings below which a spread is not believed."""
ROUNDING = 1e-12
"""Share of a feature's size below which its deviation is that of rounding."""
SMALL = 200_000
"""So many multiplications OpenBLAS leaves to one thread: its own limit is 262,144."""
FEW_ROWS = 24
"""A matrix of no more is inverted as a whole."""


class WithLogarithms(NamedTuple):
    """The way from features to features and the logarithms of those that are always above 0.

    Parameters
    ----------
    positive : ndarray of int
        Where the latter stand.
    least : ndarray, shape (len(positive),)
        What a reading below is taken for.
    """

    positive: NDArray[np.intp]
    least: Array

    @classmethod
    def of(cls, readings: Array) -> WithLogarithms:
        """Return the way for features of which these, shape (n, F), are examples."""
        lowest = readings.min(axis=0)
        positive = np.flatnonzero(lowest > 0.0)
        return cls(positive, np.maximum(0.1 * lowest[positive], np.finfo(np.float64).tiny))

    def __call__(self, readings: Array) -> Array:
        """Return readings with logarithms, shape (n, T)."""
        logarithms = np.log(np.maximum(readings[:, self.positive], self.least))
        return np.hstack([readings, logarithms])


class Space(NamedTuple):
    """Coordinates in which readings of one object vary alike in every direction.

    Parameters
    ----------
    whitening : ndarray, shape (T, T)
        From features to coordinates.
    variates : ndarray, shape (T, V)
        From coordinates to canonical variates, most telling first; at right angles, of length 1.
    """

    whitening: Array
    variates: Array

    @classmethod
    def of(cls, rows: Array, labels: NDArray[np.intp], shrinkage: float) -> Space:
        """Return the space that readings of known objects span.

        Parameters
        ----------
        rows : ndarray, shape (n, T)
        labels : ndarray of int, shape (n,)
            Which object each is of, from 0 without a gap.
        shrinkage : float
            Share of a common variance in the covariance of scaled features, above 0.

        Notes
        -----
        R. A. Fisher, 1936, doi:10.1111/j.1469-1809.1936.tb02137.x; shrunk as by Ledoit and Wolf,
        2004, doi:10.1016/S0047-259X(03)00096-4.
        """
        means = means_of(rows, labels)
        off = rows - means[labels]
        freedom = max(len(rows) - len(means), 1)
        total = rows.std(axis=0)
        varies = total > ROUNDING * np.abs(rows).max(axis=0)
        floor = np.where(varies, RESOLUTION * total, np.maximum(1.0, np.abs(rows[0])))
        scale = np.maximum(np.sqrt((off * off).sum(axis=0) / freedom), floor)
        off = off / scale
        covariance = (1.0 - shrinkage) / freedom * product(off.T, off)
        covariance[np.diag_indices_from(covariance)] += shrinkage
        whitening = (inverse_root(covariance) / scale).T
        middle = means @ whitening
        _, sizes, variates = np.linalg.svd(middle - middle.mean(axis=0), full_matrices=False)
        return cls(whitening, variates[sizes > 1e-9 * max(float(sizes[0]), 1e-300)].T)


def product(left: Array, right: Array) -> Array:
    """Return ``left @ right``, made in pieces that BLAS leaves to one thread each.

    Threads of OpenBLAS that are done with their share keep their cores busy with waiting for the
    next, and where others need these cores all wait for each other: many times the work itself.

    Parameters
    ----------
    left : ndarray, shape (m, k)
    right : ndarray, shape (k, n)
    """
    m, k, n = *left.shape, right.shape[1]
    if m * k * n <= SMALL or n > SMALL:
        return np.asarray(left @ right)
    rows = min(m, max(1, SMALL // (n * min(k, 32))))
    step = max(1, SMALL // (n * rows))
    out = np.zeros((m, n))
    for i in range(0, m, rows):
        for j in range(0, k, step):
            out[i : i + rows] += left[i : i + rows, j : j + step] @ right[j : j + step]
    return out


def inverse_root(matrix: Array) -> Array:
    """Return the inverse of the lower triangular root of a positive matrix, half by half.

    Parameters
    ----------
    matrix : ndarray, shape (T, T)
        Symmetric.
    """
    n = len(matrix)
    if n <= FEW_ROWS:
        root = np.asarray(np.linalg.cholesky(matrix), np.float64)
        return solved(root, np.eye(n))
    h = n // 2
    first = inverse_root(matrix[:h, :h])
    beside = product(first, matrix[:h, h:])
    last = inverse_root(matrix[h:, h:] - product(beside.T, beside))
    out = np.zeros((n, n))
    out[:h, :h], out[h:, h:] = first, last
    out[h:, :h] = -product(product(last, beside.T), first)
    return out


def solved(root: Array, wanted: Array) -> Array:
    """Return what a lower triangular matrix makes ``wanted`` of, row by row from the first.

    By NumPy alone: SciPy brings threads of its own for linear algebra, and where the two take
    turns each waits for cores that the other's hold. As exact as SciPy's, which an LU
    decomposition is not.

    Parameters
    ----------
    root : ndarray, shape (T, T)
        None of its diagonal is 0.
    wanted : ndarray, shape (T, n)
    """
    found = wanted.copy()
    for k, row in enumerate(root):
        found[k] = (found[k] - row[:k] @ found[:k]) / row[k]
    return found


def means_of(rows: Array, labels: NDArray[np.intp]) -> Array:
    """Return the mean of each object's rows, shape (K, T)."""
    belongs = (labels == np.arange(int(labels.max()) + 1)[:, None]).astype(np.float64)
    return product(belongs, rows) / np.bincount(labels)[:, None]
