"""Frames sent along with portions of them, whose length grows until a worker takes a while."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import islice

from tactile_graph.many.portion import Portion, packed
from tactile_graph.wires.frame import Frame

GOAL_S = 0.5
"""How long a worker should take over a portion: long beside the way to it, short for people."""
FIRST, MOST = 16, 4096
GROWTH = 4
"""Times that a portion may be longer than the one before."""
MOST_BYTES = 1_000_000
"""Of the frames that are sent with a portion."""


class PortionSize:
    """How many frames a portion should hold.

    Attributes
    ----------
    n_frames : int
    """

    def __init__(self) -> None:
        self.n_frames = FIRST

    def took(self, n_frames: int, seconds: float) -> None:
        """Learn from how long a portion took how long the next ones should be."""
        if n_frames > 0 and seconds > 0.0:
            wanted = int(GOAL_S * n_frames / seconds)
            self.n_frames = max(1, min(wanted, GROWTH * max(n_frames, FIRST), MOST))


def sent(
    frames: Iterator[Frame], low: int, size: PortionSize, n_before: int = 0
) -> Iterator[Portion]:
    """Yield portions with the frames in them.

    Parameters
    ----------
    frames : iterator of Frame
    low : int
        Place in the source of the first of them.
    size : PortionSize
        Asked anew for each portion.
    n_before : int
        How many of the frames before a portion are sent with it.
    """
    before: list[Frame] = []
    while taken := _taken(frames, size.n_frames):
        yield Portion(low, low + len(taken), packed(before + taken), n_before=len(before))
        low += len(taken)
        before = (before + taken)[-n_before:] if n_before else []


def _taken(frames: Iterator[Frame], most: int) -> list[Frame]:
    taken: list[Frame] = []
    n_bytes = 0
    for frame in islice(frames, most):
        taken.append(frame)
        n_bytes += frame.image.values.nbytes
        if n_bytes >= MOST_BYTES:
            break
    return taken
