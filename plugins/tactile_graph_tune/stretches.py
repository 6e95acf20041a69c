"""Where a recording may be cut so that frames on either side do not show the same scene."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from itertools import groupby

import numpy as np
from numpy.typing import NDArray

from tactile_graph.wires.frame import Frame

PIECES = 40
"""Stretches that a recording of independent frames is cut into."""
ALIKE = 0.5
"""Neighbours no farther apart than this share of what any two frames are show one scene."""
CHANGED = 0.75
"""The share from which frames show different scenes."""
MOST_SCENES, LEAST_SCENES = 4, 2
"""How long a stretch is where one scene flows into the next, as frames allow."""


def stretches_of(frames: Sequence[Frame]) -> NDArray[np.int64]:
    """Return a number for each stretch of frames that belong together.

    Each recording is cut into stretches of a fortieth of the frames, but not while an object
    lies still, and where one scene flows into the next only after several of them.

    Parameters
    ----------
    frames : sequence of Frame
        With their truth.
    """
    shortest = max(1, len(frames) // PIECES)
    return _numbered(_cuts(run, shortest) for run in _recordings(frames))


def pieces_of(frames: Sequence[Frame], n: int) -> NDArray[np.int64]:
    """Return a number for each stretch of an nth of the frames, whatever they show.

    Parameters
    ----------
    frames : sequence of Frame
    n : int
    """
    length = max(1, len(frames) // n)
    return _numbered(np.arange(len(run)) % length == 0 for run in _recordings(frames))


def _recordings(frames: Sequence[Frame]) -> Iterator[list[Frame]]:
    return (list(run) for _, run in groupby(frames, key=lambda f: f.label))


def _numbered(starts: Iterator[NDArray[np.bool_]]) -> NDArray[np.int64]:
    return np.cumsum(np.concatenate(list(starts))) - 1


def _cuts(run: Sequence[Frame], shortest: int) -> NDArray[np.bool_]:
    """Return with which frames of a recording a stretch begins."""
    alike, lasts = _scenes(run)
    enough = max(LEAST_SCENES * lasts, len(run) // 8)
    longest = shortest if lasts == 1 else max(shortest, min(MOST_SCENES * lasts, enough))
    found, start = np.zeros(len(run), np.bool_), 0
    for i in range(len(run)):
        length = i - start
        still = i > 0 and bool(run[i].truth) and repr(run[i].truth) == repr(run[i - 1].truth)
        if i == 0 or (not still and length >= (longest if alike[i] else shortest)):
            found[i], start = True, i
    return found


def _scenes(run: Sequence[Frame]) -> tuple[NDArray[np.bool_], int]:
    """Return which frames show what the one before does, and how many a scene lasts.

    As in a variogram, frames some way apart are held against what any two of the recording are.
    """
    n = len(run)
    alike = np.zeros(n, np.bool_)
    if n < 2 or len({f.image.shape for f in run}) > 1:
        return alike, 1
    values = np.stack([_level(f.image.filled()) for f in run])
    values -= values.mean(axis=0)
    size = np.sqrt((values**2).sum(axis=1))
    # Heavy presses count no more than others, and faint noise on an empty pad less.
    values /= np.maximum(size, np.sqrt(np.mean(size**2)) or 1.0)[:, None]
    any_two = 2.0 * float(values.var(axis=0).sum()) * n / (n - 1)
    apart = _apart(values, 1)
    alike[1:] = apart <= ALIKE * any_two
    lag = 1
    while lag < n and apart.mean() + apart.std() / np.sqrt(n - lag) <= CHANGED * any_two:
        lag += max(1, lag // 4)
        apart = _apart(values, lag)
    return alike, lag


def _level(values: NDArray[np.float64]) -> NDArray[np.float64]:
    return np.nan_to_num(np.asarray(values, np.float64).ravel(), posinf=0.0, neginf=0.0)


def _apart(values: NDArray[np.float64], lag: int) -> NDArray[np.float64]:
    """Return how far, squared, frames are from those some way before."""
    off: NDArray[np.float64] = ((values[lag:] - values[:-lag]) ** 2).sum(axis=1)
    return off
