"""Elements and lines that stay silent under objects: the dead ones, and how many are void."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
Flags = NDArray[np.bool_]
SILENT = 0.9
"""Share of its chances that a dead element lets pass at least; the rest is noise."""
BY_CHANCE = 1e-3
"""Probability that any element or line of a pad is called dead though it lives."""
LEAST_VOIDS = 0.1
REACHES = ((1, 1), (1, 2), (2, 1))
"""How far on either side a touched element may lie: gaps of one and of two elements."""


class Silence(NamedTuple):
    """How often each element could have read something, and did not; (rows, columns) each.

    ``voids`` is the share of silent chances among the living.
    """

    chances: Array
    silent: Array
    dead: Flags
    dead_rows: tuple[int, ...]
    dead_columns: tuple[int, ...]
    voids: float


def silence(touched: Flags, pressed: Flags, good: Flags) -> Silence:
    """Return which elements and lines never answer though their neighbours do.

    Parameters
    ----------
    touched : ndarray of bool, shape (frames, rows, columns)
        Which elements read more than noise.
    pressed : ndarray of bool, same shape
        Which read far more than that, so that what lies between them should read something.
    good : ndarray of bool, shape (rows, columns)
        Those that are judged.

    Notes
    -----
    An element has a chance in a frame where elements on both sides of it, in its row or in its
    column, are pressed, whatever it does itself. With a share v of voids, k chances pass in silence
    by chance with the probability v**k. Dead is what has at least a share `SILENT` of silent
    chances, and v**k below `BY_CHANCE` over the number of elements. A line is dead where its
    elements together are. Elements at the rim have chances along the rim only: a dead line there
    stays unseen.
    """
    chance = between(pressed)
    chances = chance.sum(axis=0).astype(np.float64)
    silent = (chance & ~touched).sum(axis=0).astype(np.float64)
    voids = _voids(chances, silent, good)
    shape = good.shape
    all_rows = _dead_lines(chances * good, silent * good, voids, 1)
    all_columns = _dead_lines(chances * good, silent * good, voids, 0)
    dead = good & _dead(chances, silent, voids, good.size)
    rows = tuple(int(r) for r in np.flatnonzero(all_rows))
    columns = tuple(int(c) for c in np.flatnonzero(all_columns))
    dead |= good & (np.broadcast_to(all_rows[:, None], shape) | all_columns[None, :])
    living = good & ~dead
    share = float(silent[living].sum() / max(chances[living].sum(), 1.0))
    return Silence(chances, silent, dead, rows, columns, share)


def between(on: Flags) -> Flags:
    """Return which elements lie between such of their row or column, at most two away."""
    found = np.zeros_like(on)
    for axis in (1, 2):
        for before, after in REACHES:
            found |= _moved(on, before, axis) & _moved(on, -after, axis)
    return found


def _moved(on: Flags, by: int, axis: int) -> Flags:
    moved = np.zeros_like(on)
    to: list[slice] = [slice(None)] * 3
    of: list[slice] = [slice(None)] * 3
    to[axis], of[axis] = (
        (slice(by, None), slice(None, -by)) if by > 0 else (slice(None, by), slice(-by, None))
    )
    moved[tuple(to)] = on[tuple(of)]
    return moved


def _voids(chances: Array, silent: Array, good: Flags) -> float:
    """Return the share of silent chances of the elements that answer at all."""
    answering = good & (chances >= 3.0) & (silent < SILENT * chances)
    if not answering.any():
        return LEAST_VOIDS
    return max(float(silent[answering].sum() / chances[answering].sum()), LEAST_VOIDS)


def _dead(chances: Array, silent: Array, voids: float, n: int) -> Flags:
    unlikely = chances * np.log(voids) < np.log(BY_CHANCE / n)
    return np.asarray(unlikely & (silent >= SILENT * chances))


def _dead_lines(chances: Array, silent: Array, voids: float, axis: int) -> Flags:
    of_line, passed = chances.sum(axis=axis), silent.sum(axis=axis)
    heard = (chances > 0.0).sum(axis=axis) >= 3  # one or two dead elements are no dead line
    return np.asarray(heard & _dead(of_line, passed, voids, len(of_line)))
