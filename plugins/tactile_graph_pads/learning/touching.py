"""Where objects touch: which readings show, and the contacts they make."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
Flags = NDArray[np.bool_]
SHOWS = 6.0
"""Standard deviations of noise from which a reading is one: once in a billion by chance."""
SAME = 0.7
"""Share of what two frames touch that both do, from which on they show one placement."""
MOST_FRAMES = 3000
LEAST_RIGHT = 0.5
"""Share of the frames that must be right for a level to be chosen by that."""
AT_ONCE = 256
"""Frames of which a second copy is held."""
LEVELS = 32
"""Levels tried between the noise and the median contact's peak."""


class Found(NamedTuple):
    """Contacts of one frame: centres (column, row) in cells from the first cell's middle, (k, 2),
    weighted by the readings; number of cells and peak, (k,)."""

    centres: Array
    cells: NDArray[np.int64]
    peaks: Array


def contacts_of(values: Array, level: float) -> Found:
    """Return the contacts of a frame: cells that reach a level and touch, corners counted.

    Parameters
    ----------
    values : ndarray, shape (rows, columns)
        Above the offset; 0 where an element is no good.
    level : float
    """
    from scipy import ndimage

    labels, n = ndimage.label(values >= level, structure=np.ones((3, 3)))
    row, column = np.nonzero(labels)
    number, weight = labels[row, column] - 1, values[row, column]
    cells = np.bincount(number, minlength=n)
    total = np.bincount(number, weight, n)
    x = np.bincount(number, weight * column, n) / np.where(total > 0.0, total, 1.0)
    y = np.bincount(number, weight * row, n) / np.where(total > 0.0, total, 1.0)
    peaks = np.zeros(n)
    np.maximum.at(peaks, number, weight)
    return Found(np.column_stack([x, y]), cells, peaks)


def placements(touched: Flags) -> NDArray[np.int64]:
    """Return the numbers of frames that show objects put down anew, not a placement seen before.

    Parameters
    ----------
    touched : ndarray of bool, shape (frames, rows, columns)

    Notes
    -----
    A placement has been seen if, of what either of two frames touches, both touch more than
    `SAME`. Frames of an object at rest say the same thing again and again: taken as many, they
    would make its own unevenness the pad's. At most `MOST_FRAMES` frames are looked at.
    """
    flat = touched.reshape(len(touched), -1)
    sizes = flat.sum(axis=1)
    looked = np.flatnonzero(sizes)
    looked = looked[:: max(1, -(-len(looked) // MOST_FRAMES))]
    kept = np.empty((len(looked), flat.shape[1]), np.float32)
    chosen: list[int] = []
    for n in looked.tolist():
        both = kept[: len(chosen)] @ flat[n].astype(np.float32)
        either = sizes[chosen] + sizes[n] - both
        if not (both > SAME * either).any():
            kept[len(chosen)] = flat[n]
            chosen.append(n)
    return np.array(chosen, np.int64)


def filled(values: Array, good: Flags) -> Array:
    """Return frames whose bad elements read as the good ones around them do on average.

    Parameters
    ----------
    values : ndarray, shape (frames, rows, columns)
    good : ndarray of bool, shape (rows, columns)
    """
    from scipy import ndimage

    out, known = np.where(good, values, 0.0), good.astype(np.float64)
    around = np.ones((3, 3))
    while known.any() and not known.all():
        number = ndimage.correlate(known, around, mode="constant")
        new = (known == 0.0) & (number > 0.0)
        for first in range(0, len(out), AT_ONCE):
            part = out[first : first + AT_ONCE]
            total = ndimage.correlate(part, around[None], mode="constant")
            part[:, new] = total[:, new] / number[new]
        known = np.maximum(known, new)
    return out


def least_level(noise: Array, step: float, values: Array) -> float:
    """Return the level from which a reading is more than noise.

    Parameters
    ----------
    noise : ndarray
        Standard deviation of each good element's readings.
    step : float
        Smallest difference of readings; a converter's own.
    values : ndarray
        Some readings above the offset: a thousandth of the largest is the level where neither
        noise nor step is known.

    Notes
    -----
    Where the noise is lost between two steps of the converter, one step is a reading; elements
    that rest between two steps flicker, and the level is above them too.
    """
    if noise.size:
        usual, highest = np.quantile(noise, [0.5, 0.99])
        level = max(SHOWS * usual, 0.5 * SHOWS * highest, 0.75 * step)
        if level > 0.0:
            return float(level)
    top = float(np.nanmax(values, initial=0.0))
    return 1e-3 * top if top > 0.0 else 1.0


def paired(found: Array, true: Array, gate: float) -> list[tuple[int, int]]:
    """Return pairs (found, true) that are each other's nearest, at most ``gate`` apart."""
    if not len(found) or not len(true):
        return []
    apart = np.hypot(*(found[:, None] - true[None]).transpose(2, 0, 1))
    nearest, back = apart.argmin(axis=1), apart.argmin(axis=0)
    return [(i, int(j)) for i, j in enumerate(nearest) if back[j] == i and apart[i, j] <= gate]


def best_level(frames: Sequence[Array], true: Sequence[Array], least: float) -> tuple[float, float]:
    """Return the level at which the contacts are counted right most often, and how often.

    Parameters
    ----------
    frames : sequence of ndarray, shape (rows, columns)
        Above the offset.
    true : sequence of ndarray, shape (k, 2)
        Centres of what lies there, in cells.
    least : float
        The lowest level to try.

    Returns
    -------
    (float, float)
        Level, and the share of frames that are right: as many contacts as objects, each the
        nearest to one. The lowest level unless others are better by more than chance; then the
        middle one, in the logarithm, of the longest run of equally good ones.
    """
    tops = [f.max() for f, t in zip(frames, true, strict=True) if len(t)]
    top = float(np.median(tops)) if tops else least
    levels = np.geomspace(least, max(top, 1.01 * least), LEVELS)
    told = list(zip(frames, true, strict=True))
    right = np.array([sum(_right(f, t, level) for f, t in told) for level in levels]) / len(told)
    best = float(right.max())
    within_chance = best - np.sqrt(best * (1.0 - best) / len(told))
    if right[0] >= within_chance or best < LEAST_RIGHT:
        return least, float(right[0])
    good = np.flatnonzero(right >= within_chance)
    run = max(np.split(good, np.flatnonzero(np.diff(good) > 1) + 1), key=len)
    return float(np.sqrt(levels[run[0]] * levels[run[-1]])), best


def _right(values: Array, true: Array, level: float) -> bool:
    found = contacts_of(values, level)
    if len(found.centres) != len(true):
        return False
    return len(paired(found.centres, true, np.inf)) == len(true)
