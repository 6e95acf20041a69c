"""``RecordingFormat``: how files of one format are recognised and read."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import NamedTuple

from tactile_graph.wires import Frame
from tactile_graph_sources.readers.head import Head
from tactile_graph_sources.readers.laid import Laid
from tactile_graph_sources.readers.reading import Reading


class RecordingFormat(NamedTuple):
    """How recordings of one format are recognised, by content, and read.

    Attributes
    ----------
    name : str
        As people call it: ``novel emed .lst``.
    recognises : callable
        Whether a file is of this format, by its first bytes and lines.
    read : callable
        Yields the frames of a file, made by `Reading.frame`, which knows what the settings say;
        what is damaged is left out and noted by `Reading.damaged`. Raises `DataError`.
    plain : bool
        Whether it has no mark of its own, so that files of any other may look like one of it:
        it is asked after all that have.
    of_folders : bool
        Whether such a recording is a folder.
    laid : callable, optional
        Returns how any frames of a file are read without those before them, so that several
        processes share its frames; None where they cannot be. Raises `DataError` where ``read``
        would. What it tells the reading's report is what ``read`` tells of the file as a whole.
    """

    name: str
    recognises: Callable[[Head], bool]
    read: Callable[[Reading], Iterator[Frame]]
    plain: bool = False
    of_folders: bool = False
    laid: Callable[[Reading], Laid | None] | None = None
