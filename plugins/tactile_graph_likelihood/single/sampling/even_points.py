"""Points of Student's t that fill space evenly, however many of them are used."""

from __future__ import annotations

import numpy as np

from tactile_graph_likelihood.geometry.outlines import Values
from tactile_graph_likelihood.single.sampling.importance import FREEDOM

SHIFTS = 32
FIRST = 128  # points by which a shift is judged


def even_points(count: int, unknowns: int, seed: int) -> Values:
    """Return points of a standard Student's t of 8 degrees of freedom, shape (count, unknowns).

    Parameters
    ----------
    count : int
        How many; an even number.
    unknowns : int
        Dimensions.
    seed : int
        Shifts the sequence: same seed, same points. Of 32 shifts the one is taken whose first
        points come nearest to the covariance.

    Notes
    -----
    An additive sequence whose steps along the axes are the roots of the first primes, which have
    no whole relation with each other (R. D. Richtmyer 1951, The evaluation of definite integrals
    and a quasi-Monte Carlo method). One axis more than there are unknowns stretches the normal
    points.
    Each point is followed by its mirror image, so that what is odd about the middle averages out.
    """
    axes = unknowns + 1
    steps = np.sqrt(_primes(axes))
    shifts = np.random.default_rng(seed).random((SHIFTS, axes))
    shift = min(shifts, key=lambda one: _off(_mapped(_even(steps, one, FIRST))))
    return _mapped(_even(steps, shift, count))


def _even(steps: Values, shift: Values, count: int) -> Values:
    """Return half as many even points of the unit cube, shape (count / 2, axes)."""
    even = (shift + np.arange(1, count // 2 + 1)[:, None] * steps) % 1.0
    return np.asarray(np.clip(even, 1e-9, 1.0 - 1e-9))


def _mapped(even: Values) -> Values:
    """Return points of Student's t and their mirror images, in turn."""
    from scipy.special import gammaincinv, ndtri

    stretch = np.sqrt(0.5 * FREEDOM / gammaincinv(0.5 * FREEDOM, even[:, -1]))
    one_side = ndtri(even[:, :-1]) * stretch[:, None]
    return np.stack([one_side, -one_side], axis=1).reshape(2 * len(even), -1)


def _off(points: Values) -> float:
    """Return how far the first points' covariances are from a Student's t's."""
    unit = FREEDOM / (FREEDOM - 2.0) * np.eye(points.shape[1])
    off = 0.0
    for count in range(32, len(points) + 1, 32):
        first = points[:count]
        off += count * float((((first.T @ first) / count - unit) ** 2).sum())
    return off


def _primes(count: int) -> Values:
    found: list[int] = []
    number = 2
    while len(found) < count:
        if all(number % p for p in found):
            found.append(number)
        number += 1
    return np.array(found, dtype=np.float64)
