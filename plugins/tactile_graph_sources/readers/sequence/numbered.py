"""Folders of files that differ in the numbers of their names alone: one recording, in parts."""

from __future__ import annotations

import errno
import os
from collections.abc import Iterator
from pathlib import Path

from tactile_graph.errors import DataError
from tactile_graph.files import sha256_of
from tactile_graph.wires import Frame
from tactile_graph_sources.readers.choosing.formats import format_of
from tactile_graph_sources.readers.head import Head
from tactile_graph_sources.readers.reading import Reading
from tactile_graph_sources.readers.recording_format import RecordingFormat
from tactile_graph_sources.readers.sequence.by_number import are_numbered, in_order
from tactile_graph_sources.readers.words.told import Told


def files_in(folder: Path) -> list[str]:
    """Return the names of a folder's files by their numbers; none where other files lie in it."""
    names = [p.name for p in folder.iterdir() if not p.name.startswith(".")]
    alike = are_numbered(names) and all((folder / name).is_file() for name in names)
    return in_order(names) if alike else []


def recognises(head: Head) -> bool:
    """Return whether the folder's files are so named, and the first of them is a recording."""
    names = files_in(head.path)
    if not names:
        return False
    _refuse_shut(head.path, names[:1])
    try:
        format_of(Head.of(head.path / names[0], Told()))
    except DataError:
        return False
    return True


def read(reading: Reading) -> Iterator[Frame]:
    """Yield the frames of each file, one or many; a file without a whole one is left out.

    Raises
    ------
    DataError
        If a file is of no known format, or its frames are of another size than those before.
    """
    folder, names = reading.path, files_in(reading.path)
    kind = format_of(Head.of(folder / names[0], reading.told)).name
    reading.recognised(f"{len(names)} files in the order of their numbers, the first a {kind}")
    yield from of_files(reading, names)


def of_files(reading: Reading, names: list[str]) -> Iterator[Frame]:
    """Yield the frames of files of a folder one after the other; raises what `read` raises."""
    folder = reading.path
    _refuse_shut(folder, names)  # before the work
    first: dict[str, tuple[str, tuple[int, ...]]] = {}
    single = True
    for name in names:
        path, n = folder / name, reading.index
        head = Head.of(path, reading.told)
        reading.report.digest(str(path), sha256_of(path))
        part = reading.of_part(head)
        for frame in format_of(head).read(part):
            before, shape = first.setdefault(frame.label, (name, frame.image.shape))
            if frame.image.shape != shape:
                rows, columns = frame.image.shape
                raise DataError(
                    str(path),
                    f"has frames of {rows} x {columns} cells, {before} of {shape[0]} x {shape[1]}; "
                    "the frames of a recording are of one size: keep those of each size in a "
                    "folder of their own",
                )
            yield frame
        part.check_unchanged()
        reading.index, reading.place = part.index, part.place
        single &= part.index <= n + 1
        if part.index == n and not part.first_damage:
            # Where files hold several frames each, nobody knows how many this one should.
            reading.damaged(name, "it holds no whole frame", n_frames=int(single))


def _refuse_shut(folder: Path, names: list[str]) -> None:
    shut = next((folder / name for name in names if not os.access(folder / name, os.R_OK)), None)
    if shut is not None:
        raise DataError(str(shut), f"cannot be read: {os.strerror(errno.EACCES)}")


FOLDER = RecordingFormat("folder of numbered files", recognises, read, plain=True, of_folders=True)
