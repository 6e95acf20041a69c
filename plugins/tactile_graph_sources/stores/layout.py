"""What lies in a store: a Zarr 3 group of arrays of one row a frame, and a journal beside them.

``values`` (N, rows, columns; NaN where a cell is invalid), ``time_s``, ``device_time_s`` (NaN where
there is none), ``gap``, ``doubtful``, ``notes_end`` and ``number``; each chunk carries a CRC-32C.
``notes`` holds JSON (label, truth, own number), of which a frame's ends at ``notes_end``. What
holds for all frames are the group's attributes; ``started`` is the wall clock at the first frame,
and ``sessions`` says so of each session where the store was gone on with. ``number`` is written
last of a chunk: rows it does not reach do not count. The `journal` then says what was written.
"""

from __future__ import annotations

import json
from collections.abc import Mapping
from pathlib import Path
from types import ModuleType
from typing import Any

import numpy as np

from tactile_graph.errors import DataError, UsageError, without
from tactile_graph.quantities import unknown_quantity

FORMAT = "tactile-graph recording"
VERSION = 3
READ = (1, 2, 3)
"""Version 1 had no ``doubtful`` and no checksums, version 2 no journal."""
JOURNALED = 3
"""The version from which on a journal vouches for what is in a store."""
JOURNAL = "frames.journal"
METADATA = "zarr.json"
COLUMNS: dict[str, tuple[str, float]] = {
    "values": ("float64", np.nan),
    "time_s": ("float64", np.nan),
    "device_time_s": ("float64", np.nan),
    "gap": ("bool", False),
    "doubtful": ("bool", False),
    "notes_end": ("int64", 0),
    "number": ("int64", -1),
}
NOTES = "notes"
PITCH_ASSUMED = "pitch_assumed"
"""The attribute of a store whose ``pitch_cm`` nobody said."""
MOST_TOGETHER = 256
"""Frames that are written at once at most, where a chunk is smaller and more wait.

The first of a store are a chunk at most: without a number and a journal nothing tells of more.
"""
Metadata = Mapping[str, Any]


def load_zarr() -> ModuleType:
    """Return Zarr; it comes with an extra, and only stores need it."""
    try:
        import zarr
    except ImportError as error:
        missing = "Zarr stores need the 'zarr' extra: pip install \"tactile-graph[zarr]\""
        raise UsageError(without("zarr", error, missing)) from error
    module: ModuleType = zarr
    return module


def is_store(path: str | Path) -> bool:
    """Return whether a path is a Zarr 3 group, as far as its files tell; imports no Zarr."""
    return any((Path(path) / name).is_file() for name in (METADATA, JOURNAL))


def names_of(version: object) -> tuple[str, ...]:
    """Return the arrays that a store of a version has."""
    return tuple(n for n in (*COLUMNS, NOTES) if n != "doubtful" or version != 1)


def check_attributes(path: Path, attributes: Mapping[str, Any]) -> None:
    """Refuse what is no recording, or one whose attributes cannot be true.

    Raises
    ------
    DataError
    """
    if attributes.get("format") != FORMAT:
        raise DataError(str(path), f"is a Zarr store, but not a recording ({FORMAT})")
    version = attributes.get("version")
    if version not in READ:
        allowed = f"{', '.join(map(str, READ[:-1]))} and {READ[-1]}"
        raise DataError(str(path), f"is a recording of version {version}, {allowed} can be read")
    if unknown := unknown_quantity([str(attributes.get("quantity"))]):
        raise DataError(str(path), unknown)
    for name in ("pitch_cm", "origin_cm"):
        try:
            x, y = attributes[name]
            right = all(np.isfinite([float(x), float(y)]))
        except (KeyError, TypeError, ValueError):
            right = False
        if not right:
            raise DataError(str(path), f"{name} must be two numbers, got {attributes.get(name)!r}")


# -- metadata --------------------------------------------------------------------------------


def metadata_file(path: Path, name: str) -> Path:
    """Return the file that says what an array is; the group's own for an empty name."""
    return path / name / METADATA


def read_metadata(path: Path, name: str) -> dict[str, Any] | None:
    """Return what the metadata of an array says; None if it cannot be read."""
    try:
        data = json.loads(metadata_file(path, name).read_bytes())
    except (OSError, ValueError, RecursionError):
        return None
    return data if isinstance(data, dict) else None


def written_rows(data: Metadata | None) -> int | None:
    """Return how many rows an array's metadata says it has; None if it does not."""
    shape = (data or {}).get("shape")
    n = shape[0] if isinstance(shape, list) and shape else None
    return n if isinstance(n, int) and n >= 0 else None


def same_metadata(path: Path, name: str, told: Metadata) -> bool:
    """Return whether an array's metadata on disc says what was told, the number of rows aside."""
    data = read_metadata(path, name)
    n = written_rows(data)
    if data is None or n is None:
        return False
    if data == with_rows(told, n):
        return True
    try:  # another version of Zarr may put the same in other words
        mine, its = (array_of(path, name, d, n).metadata.to_dict() for d in (told, data))
    except Exception:  # what is damaged makes Zarr raise a dozen kinds
        return False
    return bool(mine == its)


def with_rows(data: Metadata, n: int) -> dict[str, Any]:
    """Return an array's metadata for so many rows."""
    return {**data, "shape": [n, *data["shape"][1:]]}


def array_of(path: Path, name: str, data: Metadata, n: int, mode: str = "r") -> Any:
    """Return the Zarr array of so many rows that metadata describe, whatever its own file says."""
    zarr = load_zarr()
    store = zarr.storage.LocalStore(path, read_only=mode == "r")
    return zarr.Array.from_dict(zarr.storage.StorePath(store, name), with_rows(data, n))


def unfinished(chunk: int, n_frames: int) -> int:
    """Return how many frames a writer that is cut short behind others has begun at most."""
    return max(chunk, MOST_TOGETHER) if n_frames else chunk


def chunk_file(array: Any, name: str, row: int) -> str:
    """Return the file of the chunk that holds a row of an array, as a path within the store."""
    place = (row // array.chunks[0], *(0 for _ in array.shape[1:]))
    return f"{name}/{array.metadata.encode_chunk_key(place)}"


def own_attributes(path: Path) -> dict[str, Any]:
    """Return the group's attributes as Zarr has them, where no journal tells them.

    Raises
    ------
    DataError
    """
    zarr = load_zarr()
    try:
        return dict(zarr.open_group(str(path), mode="r").attrs)
    except Exception as error:  # a damaged store makes Zarr raise a dozen kinds
        raise DataError(str(path), f"is no Zarr store that opens: {error}") from error


def own_metadata(path: Path, attributes: Mapping[str, Any]) -> dict[str, Metadata]:
    """Return the arrays' metadata as Zarr has them, where no journal tells them.

    Raises
    ------
    DataError
    """
    told: dict[str, Metadata] = {}
    for name in names_of(attributes["version"]):
        data = read_metadata(path, name)
        if data is None and not metadata_file(path, name).exists():
            raise DataError(str(path), f"its array {name!r} is gone")
        if data is None or written_rows(data) is None:
            raise DataError(str(path), f"{name}/{METADATA} is damaged")
        told[name] = data
        _check_array(path, name, data, attributes.get("shape"))
    return told


def _check_array(path: Path, name: str, data: Metadata, grid: object) -> None:
    """Refuse an array of another shape than it can have, whose rows might fill the memory."""
    try:
        array = array_of(path, name, data, 0)
        right = min(array.chunks) > 0 and list(array.shape[1:]) == (
            grid if name == "values" else []
        )
    except Exception:  # what is damaged makes Zarr raise a dozen kinds
        right = False
    if not right:
        raise DataError(str(path), f"{name}/{METADATA} is damaged")
