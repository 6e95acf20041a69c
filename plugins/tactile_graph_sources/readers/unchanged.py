"""Whether a file is, once it was read, the one it was when that began."""

from __future__ import annotations

import os
from pathlib import Path
from typing import BinaryIO, NamedTuple

from tactile_graph.errors import DataError
from tactile_graph.steps import Report

_LOOKED_AT = 4096
"""Bytes at the start, and at what was the end, by which a file that grew is known."""


class Seen(NamedTuple):
    """What a file was like when its reading began."""

    size: int
    changed_ns: int
    start: bytes
    end: bytes

    @classmethod
    def of(cls, file: BinaryIO) -> Seen:
        """Return it of a file that is open; leaves it at its start."""
        now = os.fstat(file.fileno())
        ends = _ends(file, now.st_size)
        file.seek(0)
        return cls(now.st_size, now.st_mtime_ns, *ends)

    def check(self, path: Path, report: Report) -> None:
        """Refuse what was read of a file that was written meanwhile; one that only grew is told.

        Raises
        ------
        DataError
        """
        try:
            now = os.stat(path)
            if (now.st_size, now.st_mtime_ns) == (self.size, self.changed_ns):
                return
            with path.open("rb") as file:
                same = now.st_size > self.size and _ends(file, self.size) == (self.start, self.end)
        except OSError:  # removed, which takes nothing from who has it open
            return
        if not same:
            told = "changed while it was read: frames of before and after may be mixed, or missing"
            raise DataError(str(path), f"{told}; read it once it is written, or a copy")
        report.trouble(str(path), "grew while it was read: what was added may be left out")


def _ends(file: BinaryIO, size: int) -> tuple[bytes, bytes]:
    file.seek(0)
    start = file.read(min(_LOOKED_AT, size))
    file.seek(max(0, size - _LOOKED_AT))
    return start, file.read(min(_LOOKED_AT, size))
