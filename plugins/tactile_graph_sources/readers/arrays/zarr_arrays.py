"""Zarr arrays of other programs and groups of them, formats 2 and 3: one stack of matrices.

Groups are read as HDF5 files are; a stack is read from the disk piece by piece.
"""

from __future__ import annotations

import math
import warnings
from collections.abc import Iterable, Iterator, Mapping
from functools import partial
from itertools import islice
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from tactile_graph.errors import DataError
from tactile_graph.wires import Frame
from tactile_graph_sources.readers.arrays import node_images
from tactile_graph_sources.readers.arrays.datasets import Held, Unread, frames_of
from tactile_graph_sources.readers.arrays.groups import (
    TEXT,
    Group,
    attributes_of,
    held_in,
    item_bytes,
    packing,
    unread,
)
from tactile_graph_sources.readers.arrays.never_written import said_of_gone
from tactile_graph_sources.readers.arrays.packing import Packing, packing_of
from tactile_graph_sources.readers.head import Head
from tactile_graph_sources.readers.reading import OF_TIMES, Reading
from tactile_graph_sources.readers.recording_format import RecordingFormat
from tactile_graph_sources.stores.layout import FORMAT as OURS
from tactile_graph_sources.stores.layout import JOURNAL, METADATA, load_zarr, read_metadata

_OLD = (".zarray", ".zgroup")
"""What the metadata of format 2 are called."""
LARGE, MOST_TIMES = 64_000_000, 200
"""Bytes that may be unpacked however few are written, and how many times these."""
FEW_PIECES = 10_000
"""Pieces that an array may have; one of more has at least a byte for each."""
MOST_ITEMS, DEEPEST = 2_000, 40
_CODECS = {
    "bytes", "transpose", "sharding_indexed", "crc32c", "crc32", "adler32", "fletcher32", "gzip",
    "zlib", "bz2", "lzma", "blosc", "zstd", "lz4", "shuffle", "delta", "fixedscaleoffset",
    "quantize", "bitround", "packbits", "astype",
}  # fmt: skip
"""Nothing that could run a program, as a pickle does."""


def recognises(head: Head) -> bool:
    """Return whether the folder is an array or a group of Zarr, and no store of ours."""
    if (head.path / JOURNAL).exists():
        return False
    if any((head.path / name).is_file() for name in _OLD):
        return True
    data = read_metadata(head.path, "") if (head.path / METADATA).is_file() else None
    if data is None or data.get("node_type") not in ("array", "group"):
        return False
    attributes = data.get("attributes")
    ours = attributes.get("format") if isinstance(attributes, dict) else None
    return ours not in (OURS, node_images.FORMAT)


def read(reading: Reading) -> Iterator[Frame]:
    """Yield the matrices of the only stack in the store, or of the one that ``sensor`` names.

    Raises
    ------
    DataError
        If the store is damaged, or no stack or several could be meant.
    UsageError
        If Zarr is not installed.
    """
    reading.refuse_settings(*OF_TIMES)
    zarr = load_zarr()
    where = str(reading.path)
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")  # about what other readers of Zarr may not know
            held = _held(reading, zarr)
        yield from frames_of(reading, held)
    except DataError:
        raise
    except Exception as error:  # a damaged store makes Zarr raise a dozen kinds
        raise DataError(where, f"the Zarr store cannot be read: {str(error)[:120]}") from error


def _held(reading: Reading, zarr: Any) -> Held:
    where = str(reading.path)
    root = zarr.open(str(reading.path), mode="r")
    whole = None if isinstance(root, zarr.Array) else root
    if whole is None:
        members: Iterable[tuple[str, Any]] = [(_bare_name(reading.path), root)]
    else:
        members = islice(whole.members(max_depth=DEEPEST), MOST_ITEMS + 1)
    arrays: dict[str, Any] = {}
    others: dict[str, Unread] = {}
    for n, (name, item) in enumerate(members, 1):
        if n > MOST_ITEMS:
            raise DataError(where, f"it holds more than {MOST_ITEMS} groups and arrays")
        if isinstance(item, zarr.Array):
            why = _why_unread(item)
            if why is None:
                arrays[name] = item
            else:
                others[name] = why
    check = partial(_check_size, where)

    def texts(name: str) -> list[str]:
        if others[name].what != TEXT or whole is None:
            return []
        _check_size(where, {name: whole[name]}, sum(a.nbytes_stored() for a in arrays.values()))
        found = np.ravel(whole[name][()]).tolist()
        return [t.decode("utf-8", "replace") if isinstance(t, bytes) else str(t) for t in found]

    load = partial(_loaded, reading)
    group = Group("array", arrays, others, whole, check, load, texts, _packing)
    return held_in(reading, group)


def _packing(where: str, name: str, array: Any) -> Packing:
    """Return how an array is packed; xarray writes the number for no value as that of Zarr 2.

    Zarr's own 0, which others leave there, stands for no missing value.
    """
    said = attributes_of(array)
    fill = array.fill_value if array.metadata.zarr_format == 2 else None
    if "_FillValue" in said or "_ARRAY_DIMENSIONS" not in said or not fill:
        return packing(where, name, array)
    return packing_of(where, name, array.dtype, {**said, "_FillValue": fill})


def _bare_name(path: Path) -> str:
    return path.resolve().name.removesuffix(".zarr")


def _why_unread(array: Any) -> Unread | None:
    """Return why an array is not read; None where it may be."""
    if why := unread(np.dtype(array.dtype), array.shape):
        return why
    strange = sorted({*_codecs_of(array.metadata.to_dict())} - _CODECS)
    if strange:
        return Unread(f"packed by {', '.join(strange)}", "save it packed by zstd", array.shape)
    return None


def _codecs_of(data: Any) -> Iterator[str]:
    """Yield what the pieces of an array are packed by, as its metadata say, in either format."""
    packed = [data.get("compressor"), *(data.get("filters") or ()), *(data.get("codecs") or ())]
    for codec in packed:
        if codec is None:
            continue
        found = codec if isinstance(codec, Mapping) else codec.get_config()
        yield str(found.get("id", found.get("name"))).removeprefix("numcodecs.").lower()
        inner = found.get("configuration") or {}
        for within in ("codecs", "index_codecs"):
            yield from _codecs_of({"codecs": inner.get(within)})


def _pieces(array: Any) -> tuple[int, ...]:
    """Return the shape of what is unpacked together."""
    shape: tuple[int, ...] = getattr(array, "shards", None) or array.chunks
    return shape


def _check_size(where: str, arrays: Mapping[str, Any], beside: int = 0) -> None:
    """Refuse arrays that are together far larger than what is written, of them and beside them.

    Texts of even steps pack to next to nothing, so that what is written beside them counts.
    """
    unpacked, packed, pieces = 0, beside, 0
    for array in arrays.values():
        along = [-(-n // max(c, 1)) for n, c in zip(array.shape, _pieces(array), strict=True)]
        pieces += math.prod(
            -(-n // max(c, 1)) for n, c in zip(array.shape, array.chunks, strict=True)
        )
        whole = math.prod(n * c for n, c in zip(along, _pieces(array), strict=True))
        unpacked += whole * item_bytes(np.dtype(array.dtype))
        packed += array.nbytes_stored()
    which = f"array{'s' if len(arrays) > 1 else ''} {', '.join(map(repr, [*arrays][:3]))}"
    if unpacked > max(LARGE, MOST_TIMES * packed):
        raise DataError(
            where,
            f"{which} would unpack to {unpacked / 1e6:,.0f} MB, of which {packed / 1e6:,.1f} are "
            f"written; allowed are {MOST_TIMES} times that beyond {LARGE / 1e6:g} MB",
        )
    if pieces > FEW_PIECES + packed:
        raise DataError(
            where,
            f"{which} would be of {pieces:,} pieces, of which {packed:,} bytes are written; save "
            "it in larger ones",
        )


class _OnDisk:
    """A stack of which a few pieces at a time are in memory, as an array to whoever slices it."""

    def __init__(self, array: Any, packing: Packing) -> None:
        self._array = array
        self._unpacked = packing.unpacked
        self.shape: tuple[int, ...] = tuple(array.shape)
        self.dtype: np.dtype[Any] = np.dtype(array.dtype if packing == Packing() else np.float64)
        self.ndim = len(self.shape)
        self._step = _pieces(array)[0]
        self._start = 0
        self._read: NDArray[Any] | None = None

    def __len__(self) -> int:
        return self.shape[0]

    def __array__(self, dtype: Any = None, copy: bool | None = None) -> NDArray[Any]:
        return np.asarray(self._unpacked(np.asarray(self._array[()])), dtype)

    def __getitem__(self, key: Any) -> NDArray[Any]:
        first, rest = (key[0], key[1:]) if isinstance(key, tuple) else (key, ())
        if not isinstance(first, slice):
            found: NDArray[Any] = self[(slice(first, first + 1), *rest)][0]
            return found
        low, high, _ = first.indices(len(self))
        read = self._read
        if read is None or not self._start <= low <= high <= self._start + len(read):
            self._start = low // self._step * self._step
            end = min(len(self), -(-high // self._step) * self._step)
            read = self._unpacked(np.asarray(self._array[self._start : end]))
            self._read = read
        return read[(slice(low - self._start, high - self._start), *rest)]


def _loaded(reading: Reading, array: Any, packing: Packing) -> Any:
    if told := said_of_gone(array.basename or _bare_name(reading.path), array, _pieces(array)):
        reading.heed(told)  # by its writer, as a rule: no assumption
    if array.ndim == 3:
        return _OnDisk(array, packing)
    return packing.unpacked(np.asarray(array[()]))


FORMAT = RecordingFormat("Zarr of another program", recognises, read, of_folders=True)
