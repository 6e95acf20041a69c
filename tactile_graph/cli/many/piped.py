"""Whole lines into a pipe, in pieces that its reader takes or does not."""

from __future__ import annotations

import io
import select
from typing import Any, BinaryIO, cast

from tactile_graph.cli.interrupt import reader_awaited
from tactile_graph.cli.output.writers import is_regular

PIECE = getattr(select, "PIPE_BUF", 512)
"""Bytes that a pipe takes as a whole or not at all."""


def piped(file: BinaryIO) -> BinaryIO:
    """Return a file as it is if it is a plain one; else what hands lines on to its reader.

    What ends a program waits there for as long as the reader takes something, and then comes
    between lines, but for those that are longer than a piece.
    """
    return file if is_regular(file) else cast(BinaryIO, _Piped(file))


class _Piped(io.RawIOBase):
    def __init__(self, file: BinaryIO) -> None:
        file.flush()
        self._raw = getattr(file, "raw", file)  # a buffer would keep what nobody takes

    def writable(self) -> bool:
        return True

    def write(self, data: Any) -> int:
        view, at = memoryview(data), 0
        while at < len(data):
            end = data.rfind(b"\n", at, at + PIECE) + 1 or at + PIECE
            with reader_awaited():
                at += self._raw.write(view[at:end]) or 0
        return at
