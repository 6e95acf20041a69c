"""Frames sent along with portions of them, whose length grows until a worker takes a while."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import chain

import numpy as np

from tactile_graph.many.portion import Portion, packed
from tactile_graph.wires.frame import Frame
from tactile_graph.wires.frame_stack import FrameStack

GOAL_S = 0.5
"""How long a worker should take over a portion: long beside the way to it, short for people."""
FIRST, MOST = 16, 4096
GROWTH = 4
"""Times that a portion may be longer than the one before."""
MOST_BYTES = 4_000_000
"""Of the frames that are sent with a portion."""


class PortionSize:
    """How many frames a portion should hold.

    Parameters
    ----------
    most : int, optional

    Attributes
    ----------
    n_frames : int
    """

    def __init__(self, most: int = MOST) -> None:
        self.n_frames = FIRST
        self._most = most

    def took(self, n_frames: int, seconds: float) -> None:
        """Learn from how long a portion took how long the next ones should be."""
        if n_frames > 0 and seconds > 0.0:
            wanted = int(GOAL_S * n_frames / seconds)
            self.n_frames = max(1, min(wanted, GROWTH * max(n_frames, FIRST), self._most))


def sent(
    frames: Iterator[Frame | FrameStack], low: int, size: PortionSize, n_before: int = 0
) -> Iterator[Portion]:
    """Yield portions with the frames in them.

    Parameters
    ----------
    frames : iterator of Frame or FrameStack
        Stacks are sent as such; with ``n_before`` there are none.
    low : int
        Place in the source of the first of them.
    size : PortionSize
        Asked anew for each portion.
    n_before : int
        How many of the frames before a portion are sent with it.
    """
    before: list[Frame | FrameStack] = []
    rest: FrameStack | None = None
    while True:
        taken, rest, n = _taken(frames if rest is None else chain([rest], frames), size.n_frames)
        if not n:
            return
        yield Portion(low, low + n, packed(before + taken), n_before=len(before))
        low += n
        before = (before + taken)[-n_before:] if n_before else []


def _taken(
    frames: Iterator[Frame | FrameStack], most: int
) -> tuple[list[Frame | FrameStack], FrameStack | None, int]:
    """Return the next frames, what is left of the stack they end in, and how many they are."""
    taken: list[Frame | FrameStack] = []
    rest, n, n_bytes = None, 0, 0
    while n < most and n_bytes < MOST_BYTES and (given := next(frames, None)) is not None:
        if isinstance(given, FrameStack):
            left = most - n
            if len(given) > left:
                rest = given.take(np.arange(left, len(given)))
                given = given.take(np.arange(left))
            n, n_bytes = n + len(given), n_bytes + given.images.values.nbytes
        else:
            n, n_bytes = n + 1, n_bytes + given.image.values.nbytes
        taken.append(given)
    return taken, rest, n
