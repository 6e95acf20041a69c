"""The messages of an MCAP log in the order of the file, whatever of it is cut off or damaged.

MCAP specification, https://mcap.dev/spec, section "Records". The mcap library begins at the end of
a file, which a log that was cut off lacks, and believes every byte of it.
"""

from __future__ import annotations

import os
import struct
import zlib
from collections.abc import Iterator
from functools import cached_property
from io import BytesIO
from typing import Any, BinaryIO, NamedTuple

MAGIC = b"\x89MCAP0\r\n"
FOOTER, SCHEMA, CHANNEL, MESSAGE, CHUNK, CHUNK_INDEX, DATA_END = 2, 3, 4, 5, 6, 8, 15
RECORD = struct.Struct("<BQ")
"""What stands before each record: its kind, and the bytes that follow."""
SIZES = struct.Struct("<QQQII")
"""What a chunk begins with: first and last time, bytes unpacked, their CRC-32, a name's length."""
_FOOTER, _PLACE = struct.Struct("<QQI"), struct.Struct("<QQQQ")
_MESSAGE = struct.Struct("<HIQQ")
_BLOCK = 1 << 20
AT_END = "its end"
_NAMES = {SCHEMA: "a schema", CHANNEL: "a channel", MESSAGE: "a message", CHUNK: "a chunk"}


class Record(NamedTuple):
    """A record at a place of the file; of one that is cut off ``held`` is less than ``size``."""

    at: int
    kind: int
    size: int
    held: int

    @property
    def name(self) -> str:
        """What messages call it."""
        return _NAMES.get(self.kind, "a record")


class Lost(NamedTuple):
    """What cannot be read: where, what it is, and whether messages may be lost with it."""

    place: str
    what: str
    messages: bool = True

    @property
    def at_end(self) -> bool:
        """Whether all that stands before it is read."""
        return self.place == AT_END


class Message(NamedTuple):
    """A message as it was logged."""

    topic: str
    encoding: str
    schema: str
    time_ns: int
    data: bytes


class Summary:
    """What stands behind the data: where chunks are, and channels once more."""

    def __init__(self, file: BinaryIO) -> None:
        self.is_there = False
        """Whether the log was ended; it need not have an index."""
        self.chunks: list[int] = []
        self.channels = b""
        end = file.seek(0, os.SEEK_END)
        at = end - len(MAGIC) - _FOOTER.size - RECORD.size
        if at < len(MAGIC) or _read(file, end - len(MAGIC), len(MAGIC)) != MAGIC:
            return
        if RECORD.unpack(_read(file, at, RECORD.size)) != (FOOTER, _FOOTER.size):
            return
        self.is_there = True
        start, _, _ = _FOOTER.unpack(_read(file, at + RECORD.size, _FOOTER.size))
        if len(MAGIC) < start < at:
            self.channels = _read(file, start, at - start)
            self.chunks = sorted(_places(file, self.channels, start))


def _places(file: BinaryIO, index: bytes, end: int) -> Iterator[int]:
    """Yield where the chunks lie that an index names, if they do."""
    for kind, data, _ in _records_in(index):
        if kind == CHUNK_INDEX and len(data) >= _PLACE.size:
            _, _, place, length = _PLACE.unpack_from(data)
            named = (CHUNK, length - RECORD.size)
            if place < end and RECORD.unpack(_read(file, place, RECORD.size)) == named:
                yield place


def records_of(file: BinaryIO, summary: Summary) -> Iterator[Record | Lost]:
    """Yield the records before the end of the data.

    Where a length is damaged, it goes on at the next chunk that the index at the end names.
    """
    end, at = file.seek(0, os.SEEK_END), len(MAGIC)
    chunks = iter(summary.chunks)
    chunk = next(chunks, end)
    why = "it was never ended"
    while at + RECORD.size <= end:
        while chunk <= at:
            chunk = next(chunks, end)
        kind, size = RECORD.unpack(_read(file, at, RECORD.size))
        after = at + RECORD.size + size
        if kind and after <= chunk:
            yield Record(at, kind, size, size)
            if kind in (DATA_END, FOOTER):
                return
            at = after
        elif chunk < end:
            told = f"{chunk - at:,} bytes are damaged; it is read on behind them"
            yield Lost(f"byte {at}", told)
            at = chunk
        elif kind:
            yield Record(at, kind, size, end - at - RECORD.size)
            return
        else:
            why = f"zeros stand behind its {at:,} bytes"
            break
    yield Lost(AT_END, f"the log is cut off: {why}")


def messages_of(file: BinaryIO) -> Iterator[Message | Lost]:
    """Yield the messages, and what is lost between them.

    What is in a chunk whose checksum is wrong is left out as a whole: nobody knows which of its
    values are right.
    """
    summary = Summary(file)
    channels = _Channels(summary.channels)
    unchecked = lost = False
    for record in records_of(file, summary):
        if isinstance(record, Lost):
            lost = True
            yield record
        elif record.held < record.size:
            lost = True
            yield from _cut_off(file, record, channels, summary)
        elif record.kind == CHUNK:
            try:
                data = _unpacked(_read(file, record.at + RECORD.size, record.size))
            except Exception as error:  # two libraries have a dozen kinds over damaged chunks
                lost = True
                told = f"a chunk of {record.size:,} bytes is left out: {str(error)[:80]}"
                yield Lost(f"byte {record.at}", told)
                continue
            yield from channels.messages_in(data, record.at)
        elif record.kind in (SCHEMA, CHANNEL, MESSAGE):
            unchecked = True
            data = _read(file, record.at, RECORD.size + record.size)
            yield from channels.messages_in(data, record.at)
        elif record.kind == DATA_END and unchecked and not _is_right(file, record):
            told = "the checksum of the log is wrong: some values may be"
            yield Lost(AT_END, told, messages=False)
    if not summary.is_there and not lost:
        told = "the index of the log is cut off or damaged; all messages before it are read"
        yield Lost(AT_END, told, messages=False)


def _cut_off(
    file: BinaryIO, record: Record, channels: _Channels, summary: Summary
) -> Iterator[Message | Lost]:
    """Yield what is there of the last record, and that the rest is not."""
    if record.kind == CHUNK:
        begun = _begun(_read(file, record.at + RECORD.size, record.held))
        for found in channels.messages_in(begun, record.at):
            if isinstance(found, Message):
                yield found
    if summary.is_there:
        told = "it is damaged from here on; nothing behind it is read"
        yield Lost(f"byte {record.at}", told)
    else:
        there = f"{record.held:,} of its {record.size:,} bytes are there"
        told = f"the log is cut off within {record.name}: {there}"
        yield Lost(AT_END, told)


class _Channels:
    """The channels that are known so far; of one that is lost the index may know."""

    def __init__(self, index: bytes) -> None:
        from mcap.data_stream import ReadDataStream
        from mcap.records import Channel, Schema

        self._readers: dict[int, Any] = {SCHEMA: Schema.read, CHANNEL: Channel.read}
        self._stream = ReadDataStream
        self._index = index
        self._told: dict[tuple[int, bytes], bytes] = {}
        self._known: dict[int, tuple[str, str, str] | None] = {}

    def messages_in(self, data: bytes, at: int) -> Iterator[Message | Lost]:
        """Yield the messages of the records that follow one another, at a place of the file."""
        place, unknown, end = f"byte {at}", 0, 0
        for kind, record, after in _records_in(data):
            end = after
            if kind == MESSAGE and len(record) >= _MESSAGE.size:
                number, _, time_ns, _ = _MESSAGE.unpack_from(record)
                if number not in self._known:
                    self._known[number] = self._found(number)
                channel = self._known[number]
                if channel is None:
                    unknown += 1
                else:
                    yield Message(*channel, time_ns, record[_MESSAGE.size :])
            elif kind == MESSAGE:
                yield Lost(place, "a message is too short to be one")
            elif kind in self._readers:
                self._told[kind, record[:2]] = record
        if unknown:
            yield Lost(place, f"{unknown} messages are of a channel that nothing describes")
        if end < len(data):
            yield Lost(place, f"the last {len(data) - end:,} bytes of a chunk are damaged")

    @cached_property
    def _in_index(self) -> dict[tuple[int, bytes], bytes]:
        return {
            (kind, r[:2]): r for kind, r, _ in _records_in(self._index) if kind in self._readers
        }

    def _found(self, number: int) -> tuple[str, str, str] | None:
        """Return topic, encoding and schema of a channel; None where nothing describes it."""
        channel = self._read(CHANNEL, number)
        if channel is None:
            return None
        schema = self._read(SCHEMA, channel.schema_id) if channel.schema_id else None
        return channel.topic, channel.message_encoding, "" if schema is None else schema.name

    def _read(self, kind: int, number: int) -> Any:
        """Return a channel or a schema, of the data or of the index."""
        key = (kind, struct.pack("<H", number))
        for record in (self._told.get(key), self._in_index.get(key)):
            if record is not None:
                try:
                    return self._readers[kind](self._stream(BytesIO(record)))
                except Exception:  # the library believes every length, and has a dozen kinds
                    continue
        return None


def _records_in(data: bytes) -> Iterator[tuple[int, bytes, int]]:
    """Yield kind and content of the records that follow one another, and where each ends."""
    at = 0
    while at + RECORD.size <= len(data):
        kind, size = RECORD.unpack_from(data, at)
        start, at = at + RECORD.size, at + RECORD.size + size
        if not kind or at > len(data):
            return
        yield kind, data[start:at], at


def _parts(data: bytes) -> tuple[int, int, str, bytes, int]:
    """Return what a chunk unpacks to, its CRC, how it is packed, what is there of it, its length.

    Raises
    ------
    ValueError
    """
    if len(data) < SIZES.size:
        raise ValueError("its head is cut off")
    _, _, size, crc, length = SIZES.unpack_from(data)
    start = SIZES.size + length
    if length > 64 or len(data) < start + 8:
        raise ValueError("its head is damaged")
    (n,) = struct.unpack_from("<Q", data, start)
    packing = data[SIZES.size : start].decode("ascii", "backslashreplace")
    return size, crc, packing, data[start + 8 : start + 8 + n], n


def _unpacked(data: bytes) -> bytes:
    """Return the records of a whole chunk.

    Raises
    ------
    Exception
        If it is damaged, of any kind.
    """
    size, crc, packing, packed, n = _parts(data)
    if len(packed) < n:
        raise ValueError("its length is damaged")
    unpacked = _opened(packing, packed, size)
    if len(unpacked) != size or crc not in (0, zlib.crc32(unpacked)):
        raise ValueError("its checksum is wrong")
    return unpacked


def _begun(data: bytes) -> bytes:
    """Return the records of a chunk that is cut off, as far as they can be unpacked."""
    try:
        size, crc, packing, packed, n = _parts(data)
        found = _opened(packing, packed, size)
    except Exception:  # who asks says that it is cut off
        return b""
    damaged = len(packed) == n and crc not in (0, zlib.crc32(found))
    return b"" if damaged else found


def _opened(packing: str, packed: bytes, most: int) -> bytes:
    """Return what is packed, as far as it goes, and no more than ``most`` bytes."""
    if not packing or not most:
        return packed[:most]
    if packing == "zstd":
        import zstandard

        with zstandard.ZstdDecompressor().stream_reader(packed) as stream:
            return bytes(stream.read(most))
    if packing == "lz4":
        import lz4.frame

        return bytes(lz4.frame.LZ4FrameDecompressor().decompress(packed, max_length=most))
    raise ValueError(f"it is packed by {packing[:20]!r}; zstd and lz4 are read")


def _is_right(file: BinaryIO, end: Record) -> bool:
    """Return whether the data before their end are what their checksum says, where there is one."""
    (told,) = struct.unpack("<I", _read(file, end.at + RECORD.size, 4))
    if not told:
        return True
    crc, left = 0, end.at
    file.seek(0)
    while left > 0 and (block := file.read(min(_BLOCK, left))):
        crc, left = zlib.crc32(block, crc), left - len(block)
    return bool(crc == told)


def _read(file: BinaryIO, at: int, size: int) -> bytes:
    file.seek(at)
    return file.read(size)
