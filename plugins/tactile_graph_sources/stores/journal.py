"""The journal of a store: a line for each block of frames, written when all else of it is.

It vouches for what is in the arrays, which themselves cannot tell a chunk that is gone from an
empty one, nor wrong metadata from right ones. Each line is a CRC-32 in hexadecimal, a space and
JSON. The first holds the attributes and the arrays' metadata; each other the numbers of its first
frame and of the one behind its last, the CRC-32 of their values, all but the values itself, and a
copy of the attributes: without them nobody knows what a value means.
"""

from __future__ import annotations

import base64
import json
import os
import zlib
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from itertools import pairwise
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from tactile_graph_sources.stores.layout import COLUMNS, JOURNAL

BINARY = getattr(os, "O_BINARY", 0)
"""Where there are two kinds of files, a journal is none of text, whose line ends become others."""

MOST_DAMAGED = 1_000
"""Lines that are told of."""
MOST_A_FRAME = 1 << 24
"""Bytes of a frame's times, marks and notes."""
_PACKED = ("time_s", "device_time_s", "gap", "doubtful", "notes_end")


class Columns(NamedTuple):
    """All of a block of frames but the values, an item a frame."""

    time_s: NDArray[np.float64]
    device_time_s: NDArray[np.float64]
    gap: NDArray[np.bool_]
    doubtful: NDArray[np.bool_]
    notes: tuple[bytes, ...]
    """JSON of label, truth and own number; empty where there is none of them."""

    @property
    def say_more(self) -> bool:
        """Whether more is said of any frame than its time, or of some their times only."""
        untimed = np.isnan(self.time_s)
        return bool(
            any(self.notes)
            or self.gap.any()
            or self.doubtful.any()
            or not np.isnan(self.device_time_s).all()
            or untimed.any() != untimed.all()
        )


class Block(NamedTuple):
    """Frames from ``low`` up to, not with, ``high``, and the CRC-32 of their values."""

    low: int
    high: int
    crc: int
    place: int
    """Of its line in the journal, in bytes."""
    lost: str = ""
    """Why there is nothing of them, since the store was mended."""
    started: str = ""
    """Wall clock at which a session began that went on with the store, in its first block."""


class Head(NamedTuple):
    """What holds for the whole store: its attributes, and its arrays' metadata by name.

    ``sure`` is false if the attributes were those of `METADATA` when the store was mended, with
    nothing left to vouch for them.
    """

    attributes: Mapping[str, Any]
    metadata: Mapping[str, Mapping[str, Any]]
    sure: bool = True


@dataclass(frozen=True)
class Journal:
    """A journal as it was read.

    ``attributes`` are those that a whole line vouches for, if any does; ``blocks`` are in order and
    do not overlap; ``damaged`` are the numbers of lines, from 1, that are not as they were written;
    ``cut_at`` is where a last line begins that was not finished.
    """

    path: Path
    there: bool
    head: Head | None
    attributes: Mapping[str, Any] | None
    blocks: tuple[Block, ...]
    damaged: tuple[int, ...]
    cut_at: int | None

    @property
    def n_frames(self) -> int:
        """How many frames it knows of."""
        return self.blocks[-1].high if self.blocks else 0

    @property
    def whole(self) -> bool:
        """Whether every line is as it was written, and none is between them but is gone."""
        return not self.damaged and not uncovered(self.blocks, self.n_frames)

    def columns(self, block: Block) -> Columns:
        """Return all of a block but its values."""
        with self.path.open("rb") as file:
            file.seek(block.place)
            data = _parsed(file.readline())
        if data is None:
            raise ValueError("its line in the journal has changed")
        return unpacked(data["columns"], block.high - block.low)


def crc_of(values: NDArray[np.float64]) -> int:
    """Return the CRC-32 of frames' values, their shape counted in: one of (N, rows, columns)."""
    whole = np.ascontiguousarray(values, dtype="<f8")
    if np.isnan(whole.min(initial=0.0)):
        whole = np.where(np.isnan(whole), np.nan, whole)  # NaN have many bit patterns
    return zlib.crc32(whole.data, zlib.crc32(repr(whole.shape[1:]).encode()))


def packed(columns: Columns) -> str:
    """Return columns as text."""
    ends = np.cumsum([len(n) for n in columns.notes])
    arrays = (*columns[:4], ends)
    raw = b"".join(
        np.asarray(a, dtype=COLUMNS[n][0]).tobytes() for n, a in zip(_PACKED, arrays, strict=True)
    )
    return base64.b64encode(zlib.compress(raw + b"".join(columns.notes), 1)).decode()


def unpacked(text: str, n: int) -> Columns:
    """Return columns from their text."""
    unpacker = zlib.decompressobj()
    raw = unpacker.decompress(base64.b64decode(text), n * MOST_A_FRAME)
    if not unpacker.eof:
        raise ValueError("they are cut off, or unpack to far too much")
    arrays: dict[str, Any] = {}
    at = 0
    for name in _PACKED:
        dtype = np.dtype(COLUMNS[name][0])
        arrays[name] = np.frombuffer(raw, dtype, n, at)
        at += n * dtype.itemsize
    ends = arrays.pop("notes_end")
    if not ends.any():
        return Columns(**arrays, notes=(b"",) * n)
    notes = tuple(raw[at + a : at + b] for a, b in pairwise([0, *ends.tolist()]))
    return Columns(**arrays, notes=notes)


def head_line(head: Head) -> bytes:
    """Return the first line."""
    unsure = {} if head.sure else {"unsure": True}
    return _line({"attributes": head.attributes, "arrays": head.metadata, **unsure})


def block_line(
    low: int,
    values: NDArray[np.float64],
    columns: Columns,
    attributes: Mapping[str, Any] | None,
    started: str = "",
) -> bytes:
    """Return the line of a block of frames; ``attributes`` are None where nothing vouches."""
    data = {"rows": [low, low + len(values)], "values": crc_of(values), "columns": packed(columns)}
    begun = {"started": started} if started else {}
    return _line({**data, **begun, **({} if attributes is None else {"attributes": attributes})})


def lost_line(low: int, high: int, why: str) -> bytes:
    """Return the line of frames that are lost."""
    return _line({"rows": [low, high], "values": 0, "lost": why})


def append(path: Path, line: bytes) -> None:
    """Add a line to the journal of a store, or nothing, and wait until it is on the disc."""
    file = os.open(path / JOURNAL, os.O_WRONLY | os.O_APPEND | BINARY)
    try:
        end = os.fstat(file).st_size
        try:
            while line:  # a full disc may take a part
                line = line[os.write(file, line) :]
            os.fsync(file)
        except BaseException:  # or the next line would be taken for the end of a part of this one
            os.ftruncate(file, end)
            raise
    finally:
        os.close(file)


def _line(data: Mapping[str, Any]) -> bytes:
    text = json.dumps(data, separators=(",", ":")).encode()
    return b"%08x %s\n" % (zlib.crc32(text), text)


def _parsed(line: bytes) -> dict[str, Any] | None:
    """Return what a line says; None if it is not as it was written."""
    if (
        not line.endswith(b"\n")
        or line[8:9] != b" "
        or line[:8] != b"%08x" % zlib.crc32(line[9:-1])
    ):
        return None
    try:
        data = json.loads(line[9:-1])
    except (ValueError, RecursionError):  # nobody wrote that, its checksum aside
        return None
    return data if isinstance(data, dict) else None


def read_journal(path: Path) -> Journal:
    """Return the journal of a store, whatever became of it; one that is gone is empty."""
    file = path / JOURNAL
    head: Head | None = None
    attributes: Mapping[str, Any] | None = None
    found: dict[int, Block] = {}
    damaged: list[int] = []
    place, cut_at = 0, None
    if not file.is_file():
        return Journal(file, False, None, None, (), (), None)
    with file.open("rb") as lines:
        for number, line in enumerate(lines, 1):
            data: dict[str, Any] = _parsed(line) or {}
            block = _block(data, place, attributes) if number > 1 else None
            if number == 1 and "arrays" in data:
                head = Head(data["attributes"], data["arrays"], not data.get("unsure"))
                attributes = head.attributes if head.sure else None
            elif block is not None:
                # A block that an interrupt caught at its end was written twice: the last counts.
                found[block.low] = block
                attributes = attributes or data.get("attributes")
            elif number > 1 and not line.endswith(b"\n"):
                cut_at = place
            elif len(damaged) < MOST_DAMAGED:
                damaged.append(number)
            place += len(line)
    blocks = _in_order(found.values())
    return Journal(file, True, head, attributes, blocks, tuple(damaged), cut_at)


def _block(
    data: Mapping[str, Any], place: int, attributes: Mapping[str, Any] | None
) -> Block | None:
    """Return the block that a line tells of; None if nobody could have written it to this store."""
    rows: Any = data.get("rows")
    lost = data.get("lost", "")
    whole = isinstance(rows, list) and len(rows) == 2 and all(type(n) is int for n in rows)
    if not whole or not 0 <= rows[0] < rows[1] or type(data.get("values")) is not int:
        return None
    own = data.get("attributes", attributes)
    if (own != attributes and attributes is not None) or not isinstance(own, dict | None):
        return None
    started = data.get("started", "")
    if not isinstance(lost, str) or not isinstance(started, str):
        return None
    return Block(rows[0], rows[1], data["values"], place, lost, started)


def _in_order(blocks: Iterable[Block]) -> tuple[Block, ...]:
    """Return the blocks by their frames, without any that overlaps one before it."""
    kept: list[Block] = []
    for block in sorted(blocks):
        if not kept or block.low >= kept[-1].high:
            kept.append(block)
    return tuple(kept)


def uncovered(blocks: Sequence[Block], n: int) -> list[tuple[int, int]]:
    """Return the spans of frames up to ``n`` that no block holds."""
    edges = [0, *(e for b in blocks for e in (b.low, b.high)), n]
    return [(a, b) for a, b in zip(edges[::2], edges[1::2], strict=True) if a < b]
