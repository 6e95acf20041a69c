"""``RecordingWriter``: how frames become a file of one kind."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from pathlib import Path
from typing import NamedTuple

from tactile_graph.wires import Frame

OWN_SHAPES = "truth of plugins' own shapes"
"""What a recording loses that has a place for the truth, but only of shapes that all know."""


class RecordingWriter(NamedTuple):
    """How frames become a recording of one kind.

    Attributes
    ----------
    write : callable
        Writes the frames to a path, so that they are there whole or not at all; a file that is
        there, as by ``--overwrite``, is replaced at once at the end, a folder is never there.
        Returns how many there were. The third argument says in a line where they come from.
        Raises `DataError` for frames that have no place in it, `UsageError` if it cannot write.
    loses : tuple of str
        What of a frame has no place in it: ``"truth"``, ``"device time"``, ``"gaps"``,
        ``"doubts"``, ``"labels"``, ``"own numbers"``; `OWN_SHAPES` where other truth has: of a
        frame with such a shape none is written.
    write_untold : callable, optional
        As ``write``, of frames whose pitch of 1 cm nobody said: who reads the file has to be told
        that it is assumed. `write` if there is none.
    """

    write: Callable[[Path, Iterator[Frame], str], int]
    loses: tuple[str, ...] = ()
    write_untold: Callable[[Path, Iterator[Frame], str], int] | None = None
