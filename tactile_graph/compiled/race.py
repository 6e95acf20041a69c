"""Which kernel one process compiles so that another, which needs them all, has to wait least."""

from __future__ import annotations

from collections.abc import Hashable, Mapping, Sequence
from typing import Any

TYPED_S = 0.2e-3
"""To type and lower a byte of Python's code; what several kernels share, a process does once."""

EMITTED_S = 0.04e-3
"""To optimise and emit a byte of all that a kernel takes in."""

STARTED_S = 2.0
"""To get the compiler ready."""

SLOWED = 0.25
"""By how much of our time the other process loses: two processors are often threads of one core."""

Sizes = Mapping[Any, int]


class Race:
    """Two processes at the same kernels: the other one in the order they are needed.

    Parameters
    ----------
    kernels : sequence of mapping
        For each kernel in that order, bytes of Python's code of each function it takes in.
    """

    def __init__(self, kernels: Sequence[Sizes]) -> None:
        self._kernels = kernels
        self._ours: set[int] = set()

    def next(self, elapsed_s: float) -> int | None:
        """Return the kernel to compile now, None if the other process gains by none.

        Parameters
        ----------
        elapsed_s : float
            Since the other process began with the first kernel, by its own count.
        """
        saved = {i: self._saved_s(i, elapsed_s) for i in range(len(self._kernels))}
        best = max((i for i in saved if i not in self._ours), key=saved.__getitem__, default=None)
        if best is None or saved[best] <= 0.0:
            return None
        self._ours.add(best)
        return best

    def _saved_s(self, i: int, elapsed_s: float) -> float:
        """Return by how much sooner the other process has kernel ``i`` if we begin with it now."""
        known: set[Hashable] = set()
        reached_s = STARTED_S - elapsed_s
        for j in range(i):
            if j not in self._ours:
                reached_s += _cost_s(self._kernels[j], known)
                known.update(self._kernels[j])
        if i == 0 or reached_s < 0.0:
            return 0.0  # it is at it, or has it
        mine = {f for j in self._ours for f in self._kernels[j]}
        done_s = _cost_s(self._kernels[i], mine) + (0.0 if self._ours else STARTED_S)
        alone_s = _cost_s(self._kernels[i], known)
        return alone_s - SLOWED * done_s - max(0.0, done_s - reached_s)


def _cost_s(sizes: Sizes, known: set[Hashable]) -> float:
    """Return how long a kernel takes a process that has made the functions ``known``."""
    typed = sum(n for function, n in sizes.items() if function not in known)
    return TYPED_S * typed + EMITTED_S * sum(sizes.values())
