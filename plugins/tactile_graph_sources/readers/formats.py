"""The formats that are known, and which of them a file is, by its content alone."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Protocol

from tactile_graph.errors import DataError
from tactile_graph.wires import Frame
from tactile_graph_sources.readers import (
    capfingerid,
    emed,
    hdf5,
    json_stack,
    matlab,
    mcap_log,
    npy,
    npz,
    pictures,
    pliance,
    popu_bed,
    tekscan,
    xsensor,
)
from tactile_graph_sources.readers.head import Head
from tactile_graph_sources.readers.others import remedy_for, remedy_without_header
from tactile_graph_sources.readers.reading import Reading
from tactile_graph_sources.readers.tables import flat, long, stacked


class Reader(Protocol):
    """What a reader's module has."""

    NAME: str

    def recognises(self, head: Head) -> bool:
        """Return whether the file is of this format."""

    def read(self, reading: Reading) -> Iterator[Frame]:
        """Yield the file's frames."""


# The surest marks first; plain tables last, as any of the others could look like one.
READERS: tuple[Reader, ...] = (
    npy,
    pictures,
    npz,
    hdf5,
    matlab,
    mcap_log,
    popu_bed,
    xsensor,
    tekscan,
    pliance,
    emed,
    capfingerid,
    json_stack,
    long,
    stacked,
    flat,
)


def known() -> str:
    """Return the names of all formats, for messages."""
    return ", ".join(reader.NAME for reader in READERS)


def reader_of(head: Head) -> Reader:
    """Return the reader for a file.

    Raises
    ------
    DataError
        If the file is of no known format.
    """
    reader = next((r for r in READERS if r.recognises(head)), None)
    if reader is None:
        formats = f"{remedy_without_header(head)}formats that are read: {known()}"
        raise DataError(
            str(head.path), f"no recording: {head.found()}; {remedy_for(head) or formats}"
        )
    return reader
