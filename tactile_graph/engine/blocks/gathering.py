"""Frames gathered into blocks while they come, without keeping one back that others wait for."""

from __future__ import annotations

import time
from collections.abc import Iterable, Iterator
from itertools import chain

import numpy as np

from tactile_graph.wires.frame import Frame
from tactile_graph.wires.frame_stack import MOST_BYTES, MOST_FRAMES, FrameStack, in_stacks

WORTH_BLOCKS = 2000
"""Frames from which on blocks are sooner done, kernels that are not on disk yet included."""
LONG = 200
"""Frames beyond which a run has machine code made before the first of them."""
FIRST, MOMENT_S = 16, 0.1
"""Frames of the first block, and how long one may take: who waits sees that something happens."""
SLOW_S, PATIENCE_S = 0.002, 0.02
"""A frame that took longer to come is handed on at once, with all before it; so are all after a
while, as a source that lives may fall silent."""


def is_long(n_frames: int | None) -> bool:
    """Return whether machine code is worth its start for so many frames; None if nobody knows."""
    return n_frames is None or n_frames > LONG


def gathered(frames: Iterable[Frame | FrameStack]) -> Iterator[FrameStack]:
    """Yield frames as stacks of such as are alike, in their order.

    What came before an error of the source is handed on before it is raised.
    """
    waiting: list[Frame] = []
    began = last = time.perf_counter()
    most = 1
    try:
        for frame in frames:
            if isinstance(frame, FrameStack):
                yield from in_stacks(waiting)
                waiting = []
                yield frame
                continue
            now = time.perf_counter()
            waiting.append(frame)
            if len(waiting) >= most or now - last > SLOW_S or now - began > PATIENCE_S:
                yield from in_stacks(waiting)
                waiting = []
                most = max(1, min(MOST_FRAMES, MOST_BYTES // max(frame.image.values.nbytes, 1)))
                began = time.perf_counter()
                now = began
            last = now
    except Exception:
        yield from in_stacks(waiting)
        raise
    yield from in_stacks(waiting)


def flat(frames: Iterable[Frame | FrameStack]) -> Iterator[Frame]:
    """Yield frames one after the other, those of stacks too."""
    for some in frames:
        if isinstance(some, FrameStack):
            yield from some
        else:
            yield some


class Taken:
    """Frames of which so many are taken at a time; a stack is parted where that ends within it.

    Parameters
    ----------
    frames : iterator of Frame or FrameStack
        None is asked for before it is taken; of a stack the others wait, or stay behind.
    """

    def __init__(self, frames: Iterator[Frame | FrameStack]) -> None:
        self._frames = frames
        self._rest: FrameStack | None = None

    @property
    def n_left(self) -> int:
        """How many frames of the last stack nobody has taken."""
        return 0 if self._rest is None else len(self._rest)

    def next(self, n: int | None) -> Iterator[Frame | FrameStack]:
        """Yield the next ``n`` frames, all that follow for None, as far as there are any."""
        if n is None:
            rest, self._rest = self._rest, None
            yield from self._frames if rest is None else chain([rest], self._frames)
            return
        while n > 0:
            some = next(self._frames, None) if self._rest is None else self._rest
            self._rest = None
            if some is None:
                return
            size = len(some) if isinstance(some, FrameStack) else 1
            if isinstance(some, FrameStack) and size > n:
                self._rest = some.take(np.arange(n, size))
                some = some.take(np.arange(n))
            n -= size
            yield some


class Share:
    """How many frames make a block that is done in a moment, by the time those before it took."""

    def __init__(self) -> None:
        self._n = FIRST

    def parts(self, stack: FrameStack) -> Iterator[FrameStack]:
        """Yield a stack in parts; the time until the next is asked for is that of a part."""
        start = 0
        while start < len(stack):
            n = min(self._n, len(stack) - start)
            began = time.perf_counter()
            yield stack if n == len(stack) else stack.take(np.arange(start, start + n))
            seconds = time.perf_counter() - began
            self._n = max(1, min(2 * self._n, int(n * MOMENT_S / max(seconds, 1e-9))))
            start += n
