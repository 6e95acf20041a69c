"""All readings of known objects, as a discriminant learns from them."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from tactile_graph.errors import DataError
from tactile_graph_classifiers.database.known import Known

Array = NDArray[np.float64]
Labels = NDArray[np.intp]
Packed = tuple[str, tuple[int, ...], bytes]
RUNS = 10
"""Into how many runs of successive readings an object's are cut."""


class Examples(NamedTuple):
    """All readings of known objects.

    Parameters
    ----------
    readings : ndarray, shape (n, F)
    labels : ndarray of int, shape (n,)
        Which object each is of.
    runs : ndarray of int, shape (n,)
        Which run of its object's readings; -1 where an object has only one reading.
    """

    readings: Array
    labels: Labels
    runs: Labels

    @classmethod
    def of(cls, known: Known) -> Examples:
        """Return the readings of all objects.

        Raises
        ------
        DataError
            If no object has two readings, or one none.
        """
        counts = [len(it.readings) for it in known.objects]
        if min(counts) < 1:
            raise DataError(known.where, f"{known.names[counts.index(0)]!r} has no readings")
        if max(counts) < 2:
            raise known.nothing_varies()
        labels = np.repeat(np.arange(len(counts)), counts)
        return cls(np.concatenate([o.readings for o in known.objects]), labels,
                   runs_of(counts, 1))  # fmt: skip

    def chosen(self, kept: NDArray[np.bool_]) -> Examples:
        """Return those kept, the objects numbered anew."""
        _, labels = np.unique(self.labels[kept], return_inverse=True)
        return Examples(self.readings[kept], labels.astype(np.intp), self.runs[kept])

    def packed(self) -> list[Packed]:
        """Return what results of the same examples are remembered by."""
        return [(part.dtype.str, part.shape, part.tobytes()) for part in self]

    @classmethod
    def unpacked(cls, parts: Sequence[Packed]) -> Examples:
        """Return the examples that were packed."""
        return cls(*[np.frombuffer(raw, dtype).reshape(shape) for dtype, shape, raw in parts])

    def most_presses(self) -> int:
        """Return how many presses of one object can be judged together by what was learned.

        So many that most objects, some of their readings left out, keep three quarters.
        """
        counts = np.bincount(self.labels)
        return max(1, int(np.median(counts[counts > 1])) // 4)


def runs_of(counts: Sequence[int], n_presses: int) -> Labels:
    """Return which run of its object's each reading is in; -1 where there are no two runs.

    Parameters
    ----------
    counts : sequence of int
        Readings of each object.
    n_presses : int
        A run has at least so many.
    """
    numbers = [min(RUNS, n // n_presses) for n in counts]
    runs = [
        np.arange(n) * of // n if of > 1 else np.full(n, -1)
        for n, of in zip(counts, numbers, strict=True)
    ]
    return np.concatenate(runs).astype(np.intp)
