"""``Ranges``: what a source says that can give any of its frames without those before them."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import NamedTuple

from tactile_graph.steps.injected import Report
from tactile_graph.wires.frame import Frame
from tactile_graph.wires.frame_stack import FrameStack


class Irregular(Exception):  # noqa: N818 -- what the frames are
    """Frames that only who reads all before them can give: one is damaged, or left out."""


class Ranges(NamedTuple):
    """Frames that can be read in any order, by several processes at once.

    A source offers them by an attribute ``ranges``: a function that takes the source's settings, by
    name, and returns them, or None where these recordings cannot be read so. Each worker calls it
    for itself.

    Attributes
    ----------
    recordings : tuple of int
        How many frames each recording holds, in order.
    read : callable
        ``read(low, high)`` yields the frames from ``low`` up to, not with, ``high``, as the source
        itself would have given them. It raises `Irregular` where it cannot be sure to.
    together : int
        How many frames are best read together: those of a chunk.
    read_in_stacks : callable, optional
        As ``read``; it may yield a `FrameStack` for many frames.
    tell : callable, optional
        ``tell(report)`` tells a `Report` what the source would tell of its recordings as a whole,
        and looks through them once for all who read them: it raises `Irregular` if one is damaged.
    """

    recordings: tuple[int, ...]
    read: Callable[[int, int], Iterator[Frame]]
    together: int = 1
    read_in_stacks: Callable[[int, int], Iterator[Frame | FrameStack]] | None = None
    tell: Callable[[Report], None] | None = None

    @property
    def n_frames(self) -> int:
        """How many frames there are."""
        return sum(self.recordings)
