"""``Head``: the first bytes and lines of a file, by which its format is recognised."""

from __future__ import annotations

import re
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING

from tactile_graph_sources.readers.unchanged import Seen
from tactile_graph_sources.readers.words.told import Told

if TYPE_CHECKING:
    from tactile_graph_sources.readers.tables.labelled import Labels
    from tactile_graph_sources.readers.tables.layout import Layout

SAMPLE = 1 << 20
MOST_LINES = 100_000
"""Lines by which a table is recognised; a sample has more where they are under ten bytes long."""
_UTF16 = (b"\xff\xfe", b"\xfe\xff")
_ZEROS_IN = 200
_LOOKED_AT, MOST_GARBAGE = 4096, 0.02
"""Bytes that tell a text, and the share of them that a device may have garbled at its start."""
_ZEROS = re.compile(rb"\0+")
_GARBAGE = re.compile(rb"[^\t\r\n\f -~]")
_TAR_AT, _TAR = 257, b"ustar"
_PLAIN = re.compile(rb"[\t\r\n -~]+")


@dataclass
class Head:
    """The start of a file and what the settings say about it."""

    path: Path
    raw: bytes
    told: Told
    seen: Seen | None = None

    @classmethod
    def of(cls, path: Path, told: Told) -> Head:
        """Read the start of a file."""
        with path.open("rb") as file:
            seen = Seen.of(file)
            return cls(path, file.read(SAMPLE), told, seen)

    @property
    def whole(self) -> bool:
        """Whether this is all there is."""
        return len(self.raw) < SAMPLE

    @property
    def encoding(self) -> str:
        """Encoding by the byte-order mark, or by where its zeros lie; else UTF-8."""
        if self.raw[:2] in _UTF16:
            return "utf-16"
        start = self.raw[:_ZEROS_IN]
        if len(start) > 8 and not any(start[1::2]) and _PLAIN.fullmatch(start[::2]):
            return "utf-16-le"
        if len(start) > 8 and not any(start[::2]) and _PLAIN.fullmatch(start[1::2]):
            return "utf-16-be"
        return "utf-8-sig"

    @cached_property
    def lines(self) -> list[str]:
        """The first lines of a text; empty for a binary file."""
        if not self.encoding.startswith("utf-16") and not self._is_text:
            return []
        text = self.raw.decode(self.encoding, "backslashreplace")
        lines = text.replace("\r\n", "\n").replace("\r", "\n").split("\n")
        return lines if self.whole else lines[:-1]

    @property
    def _is_text(self) -> bool:
        """Whether the file starts as a text does, in which a few zeros may stand.

        Serial devices send them where they are reset, and a disk that lost its power writes runs.
        """
        start = self.raw[:_LOOKED_AT]
        if b"\0" not in start:
            return True
        if self.raw[_TAR_AT:].startswith(_TAR):  # texts, each behind a head with zeros
            return False
        runs, rest = len(_ZEROS.findall(start)), _ZEROS.sub(b"", start)
        garbage = runs + len(_GARBAGE.findall(rest))
        return (b"\n" in rest or b"\r" in rest) and garbage <= MOST_GARBAGE * len(rest)

    @cached_property
    def layout(self) -> Layout | None:
        """How the numbers lie in a plain table; None where it is no table."""
        from tactile_graph_sources.readers.tables.decide import layout_of

        labels, lines = self.labels, self.lines[:MOST_LINES]
        whole = self.whole and len(lines) == len(self.lines)
        if labels is None:
            return layout_of(lines, self.told, whole)
        return layout_of([labels.plain(line) for line in lines], self.told, whole, labels.names)

    @cached_property
    def labels(self) -> Labels | None:
        """How lines of a text are written that hold names beside their numbers."""
        from tactile_graph_sources.readers.tables.labelled import labels_of

        return labels_of(self.lines)

    def first(self, n: int = 60) -> list[str]:
        """Return the first ``n`` lines that are not blank."""
        return [line for line in self.lines[: 4 * n] if line.strip(" ,;\t\f")][:n]

    def found(self) -> str:
        """Return in words what the file starts with, for messages."""
        if not self.raw:
            return "an empty file"
        if not self.lines:
            return f"binary data starting {self.raw[:8]!r}"
        first = self.first(1)
        return f"text starting {first[0].strip()[:60]!r}" if first else "only blank lines"
