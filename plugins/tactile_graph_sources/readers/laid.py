"""``Laid``: a recording of which any frames can be read without those before them."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from tactile_graph.steps.ranges import Irregular
from tactile_graph.wires.frame import Frame
from tactile_graph.wires.frame_stack import FrameStack
from tactile_graph_sources.readers.reading import Reading
from tactile_graph_sources.readers.words.filled import FILLS


class Laid(NamedTuple):
    """Where the frames of a recording lie; opened once, read by any range.

    Attributes
    ----------
    n_frames : int
    frames : callable
        ``frames(reading, low, high)`` yields those from ``low`` up to, not with, ``high``, made by
        `Reading` as the format's ``read`` makes them. It raises `Irregular` where it cannot give
        them so, and `DataError`.
    check : callable, optional
        Looks through all of it, once for all who read it, and raises `DataError` if it is damaged.
    together : int
        How many frames are best read together.
    """

    n_frames: int
    frames: Callable[[Reading, int, int], Iterator[Frame | FrameStack]]
    check: Callable[[], None] | None = None
    together: int = 1


def laid_in(
    reading: Reading,
    values: NDArray[Any],
    times_s: NDArray[Any] | None = None,
    *,
    factor: float = 1.0,
    **grid: Any,
) -> Laid | None:
    """Return how frames are read that lie in an array.

    Parameters
    ----------
    reading : Reading
        Told what is assumed of the grid.
    values : ndarray, shape (n, rows, columns)
    times_s : ndarray, shape (n,), optional
    factor, **grid
        As of `Reading.frames`.

    Returns
    -------
    Laid or None
        None where frames hang on those before them: if some have no time, a leap from the last
        that had one may lie anywhere; and where a frame's cells do not lie together in the file.

    Raises
    ------
    DataError
        If the grid cannot be true, or is not what the settings say.
    """
    untold = times_s is not None and not np.isfinite(times_s).all()
    if untold or not values.flags.c_contiguous:
        return None
    rows, columns = values.shape[1:]
    reading.grid((columns, rows) if reading.told.transpose else (rows, columns), **grid)
    is_own = reading.is_own

    def frames(reading: Reading, low: int, high: int) -> Iterator[Frame | FrameStack]:
        reading.is_own = is_own
        some = values[low:high]
        if not is_own:
            _refuse_filled(reading, some)
        times = None if times_s is None else times_s[low:high]
        yield from reading.frames(some, times, factor=factor, **grid)

    return Laid(len(values), frames)


def _refuse_filled(reading: Reading, values: NDArray[Any]) -> None:
    """Refuse frames of which a number may stand for no reading: what they lie among tells it."""
    if not values.size or values.dtype.kind not in "if":
        return
    least, most = float(np.fmin.reduce(values, None)), float(np.fmax.reduce(values, None))
    if least <= max(f for f in FILLS if f < 0.0) or most >= min(f for f in FILLS if f > 0.0):
        raise Irregular(f"{reading.path}: a number may stand for no reading")
