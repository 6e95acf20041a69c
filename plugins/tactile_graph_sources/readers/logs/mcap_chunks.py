"""What the chunks of an MCAP log unpack to, looked at before any of it is unpacked.

MCAP specification, https://mcap.dev/spec, sections "Records" and "Chunk".
"""

from __future__ import annotations

from pathlib import Path
from typing import BinaryIO

from tactile_graph.errors import DataError
from tactile_graph_sources.readers.logs.mcap_records import (
    CHUNK,
    RECORD,
    SIZES,
    Lost,
    Summary,
    records_of,
)

LARGE, MOST_TIMES = 64_000_000, 100
"""Bytes in all that chunks may unpack to however small they are packed; and how many times."""


def check_chunks(path: Path) -> None:
    """Refuse a log that unpacks to far more than is in it.

    Raises
    ------
    DataError
    """
    most = max(LARGE, MOST_TIMES * path.stat().st_size)
    with path.open("rb") as file:
        unpacked = _unpacked_bytes(file, most)
    if unpacked > most:
        raise DataError(
            str(path),
            f"its chunks unpack to more than {most / 1e6:,.0f} MB; allowed are {MOST_TIMES} times "
            f"the file beyond {LARGE / 1e6:g} MB",
        )


def _unpacked_bytes(file: BinaryIO, most: int) -> int:
    """Return to how many bytes all chunks unpack, or more than is allowed as soon as that is so."""
    unpacked = 0
    for record in records_of(file, Summary(file)):
        if isinstance(record, Lost) or record.kind != CHUNK or record.held < SIZES.size + 8:
            continue
        file.seek(record.at + RECORD.size)
        unpacked += _of_chunk(file.read(record.held), most - unpacked)
        if unpacked > most:
            break
    return unpacked


def _of_chunk(data: bytes, most: int) -> int:
    """Return to how many bytes a chunk unpacks, by its own word and by what is packed."""
    _, _, said, _, length = SIZES.unpack_from(data)
    packing = data[SIZES.size : SIZES.size + length]
    packed = data[SIZES.size + length + 8 :]
    if packing == b"zstd":
        import zstandard

        try:
            return max(int(said), zstandard.frame_content_size(packed))
        except zstandard.ZstdError:  # who unpacks it says so
            return int(said)
    if packing == b"lz4" and said <= most:
        return max(int(said), _lz4_bytes(packed, most))
    return int(said)


def _lz4_bytes(packed: bytes, most: int) -> int:
    """Return the length of what is unpacked; LZ4 need not tell it beforehand."""
    import lz4.frame

    unpacker = lz4.frame.LZ4FrameDecompressor()
    n = 0
    try:
        n = len(unpacker.decompress(packed, max_length=1 << 20))
        while not unpacker.eof and not unpacker.needs_input and n <= most:
            n += len(unpacker.decompress(b"", max_length=1 << 20))
    except RuntimeError:  # who unpacks it says so
        pass
    return n
