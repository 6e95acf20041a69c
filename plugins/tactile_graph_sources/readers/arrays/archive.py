"""Zip archives, opened after a look at how many members they can have; members in place."""

from __future__ import annotations

import os
import struct
import zipfile
import zlib
from pathlib import Path
from typing import BinaryIO

import numpy as np
from numpy.typing import NDArray

from tactile_graph.errors import DataError

MOST_DIRECTORY = 2_000_000
"""Bytes of the list of members: some 20,000 of them, read in a quarter of a second."""
_END, _END_64 = b"PK\5\6", b"PK\6\6"
_LONGEST_END = 65_536 + 22
_LOCAL_HEAD = 30
"""Bytes before a member's name, of which the last four say how long that and its extras are."""


def opened(path: Path) -> zipfile.ZipFile:
    """Return an archive, open.

    Raises
    ------
    DataError
        If it is damaged, or its list of members is longer than `MOST_DIRECTORY`.
    """
    try:
        with path.open("rb") as file:
            size = _directory_size(file)
        if size <= MOST_DIRECTORY:
            return zipfile.ZipFile(path)
    except Exception as error:  # a damaged archive makes zipfile raise a dozen kinds
        raise DataError(str(path), f"the archive is damaged: {error}") from error
    raise DataError(
        str(path),
        f"its list of members has {size / 1e6:.1f} MB; allowed are {MOST_DIRECTORY / 1e6:g}",
    )


def _directory_size(file: BinaryIO) -> int:
    """Return how long an archive says its list of members is; 0 if it says nothing."""
    whole = file.seek(0, os.SEEK_END)
    file.seek(max(0, whole - _LONGEST_END - 76))
    tail = file.read()
    at = tail.rfind(_END)
    if at < 0 or len(tail) < at + 22:
        return 0
    size = int(struct.unpack_from("<I", tail, at + 12)[0])
    at_64 = tail.rfind(_END_64, 0, at)
    if at_64 >= 0 and len(tail) >= at_64 + 56:
        size = max(size if size != 0xFFFFFFFF else 0, *struct.unpack_from("<Q", tail, at_64 + 40))
    return size


def mapped(path: str, member: zipfile.ZipInfo, check: bool = True) -> NDArray[np.uint8]:
    """Return the bytes of a member that is stored as it is, mapped, not read.

    Parameters
    ----------
    path : str
    member : ZipInfo
    check : bool
        Whether all of them are held against the archive's checksum.

    Raises
    ------
    BadZipFile
        If they are not those that the archive's checksum is of.
    """
    with open(path, "rb") as file:
        file.seek(member.header_offset)
        n_name, n_extra = struct.unpack_from("<HH", file.read(_LOCAL_HEAD), _LOCAL_HEAD - 4)
    begin = member.header_offset + _LOCAL_HEAD + n_name + n_extra
    held = np.asarray(np.memmap(path, np.uint8, "r", begin, (member.file_size,)))
    if check and zlib.crc32(held.data) != member.CRC:
        raise zipfile.BadZipFile(f"Bad CRC-32 for file {member.filename!r}")
    return held
