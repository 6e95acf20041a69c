"""One run at a time writes an output, whether it is one process or has workers.

One process locks the output itself, whose lines it writes as they come, so that nothing is left
beside it. Workers lock the journal beside it: the output gets its name only when it is whole. Each
looks for the other after it has its own lock, so that of two that begin at once one is refused.
"""

from __future__ import annotations

import os
from io import FileIO
from pathlib import Path

from tactile_graph.cli.interrupt import reader_awaited
from tactile_graph.errors import UsageError
from tactile_graph.files import is_plain, said
from tactile_graph.locks import is_locked, locked

BYTE = 2**31 - 2
"""Which is locked of an output, where files are locked by bytes: behind what anybody reads of it,
and as far as Windows counts."""


def journal_of(output: str) -> Path:
    """Return the hidden file beside an output that workers lock."""
    place = Path(output)
    return place.with_name(f".{place.name}.journal")


def opened_alone(output: str) -> FileIO:
    """Return an output, empty and open for writing, which no other run writes until it is closed.

    It is unbuffered: a line goes out in one piece, and a killed run leaves whole lines. A pipe or a
    device is opened as it is. On a file system without locks every run is taken for the only one.

    Raises
    ------
    UsageError
        If another run is writing it, or it cannot be written.
    """
    if not is_plain(output):
        with said(output), reader_awaited():
            return FileIO(output, "w")
    file = held_alone(output)
    with said(output):
        os.ftruncate(file.fileno(), 0)
    return file


def held_alone(output: str) -> FileIO:
    """Return an output, opened as it is, which no other run writes until it is closed.

    Raises
    ------
    UsageError
        As of `opened_alone`.
    """
    if is_locked(journal_of(output)):  # before the file is made
        raise refused(output)
    with said(output):
        file = FileIO(output, "a")
        if not _alone(file) or is_locked(journal_of(output)):
            file.close()
            raise refused(output)
        return file


def refuse_if_written(output: str) -> None:
    """Refuse an output that a run of one process writes.

    Raises
    ------
    UsageError
    """
    if is_plain(output) and is_locked(output, BYTE):
        raise refused(output)


def refused(output: str) -> UsageError:
    """Return what is said of an output that another run is writing."""
    return UsageError(f"-o {output}: another run is writing it, or another program has locked it")


def _alone(file: FileIO) -> bool:
    try:
        return locked(file, BYTE)
    except OSError:
        return True
