"""How texts that people give are encoded."""

from __future__ import annotations

from codecs import BOM_UTF16_BE, BOM_UTF16_LE
from pathlib import Path
from typing import TextIO


def encoding_of(start: bytes) -> str:
    """Return a text file's encoding: UTF-8, or UTF-16 where a byte-order mark says so.

    Spreadsheets save "Unicode text" so, and Windows' PowerShell what is sent to a file.

    Parameters
    ----------
    start : bytes
        The first two of it, or more.
    """
    return "utf-16" if start[:2] in (BOM_UTF16_LE, BOM_UTF16_BE) else "utf-8-sig"


def decoded(data: bytes) -> str:
    """Return the text that a file holds.

    Raises
    ------
    UnicodeDecodeError
        If it is not encoded as `encoding_of` tells.
    """
    return data.decode(encoding_of(data))


def encoding_with_mark(start: bytes) -> str:
    """Return a text file's encoding as `encoding_of` does, of a text that keeps its mark."""
    if start[:2] == BOM_UTF16_LE:
        return "utf-16-le"
    return "utf-16-be" if start[:2] == BOM_UTF16_BE else "utf-8"


def with_mark(data: bytes) -> str:
    """Return the text that a file holds with its byte-order mark, to be written as it was.

    Raises
    ------
    UnicodeDecodeError
        If it is not encoded as `encoding_with_mark` tells.
    """
    return data.decode(encoding_with_mark(data))


def open_text(path: Path, newline: str | None = None) -> TextIO:
    """Open a text file to read from, encoded as `encoding_of` tells.

    Parameters
    ----------
    path : Path
    newline : str, optional
        As of `open`.
    """
    with path.open("rb") as file:
        start = file.read(2)
    return path.open(encoding=encoding_of(start), newline=newline)
