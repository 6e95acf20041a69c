"""Images and masks of nodes that ``tactile-graph run -o images.h5`` or ``images.zarr`` wrote."""

from __future__ import annotations

import json
import math
from collections.abc import Iterator, Mapping
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np

from tactile_graph.errors import DataError, did_you_mean, one_of
from tactile_graph.quantities import is_quantity
from tactile_graph.wires import Frame
from tactile_graph_sources.readers.choice import SeveralSensorsError
from tactile_graph_sources.readers.reading import Reading
from tactile_graph_sources.readers.recording_format import RecordingFormat
from tactile_graph_sources.stores.layout import load_zarr

FORMAT = "tactile-graph node images"
"""What such files say of themselves."""
_METADATA = "zarr.json"
_BLOCK = 256
MOST_CELLS, MOST_PIECES = 4_000_000, 1_000
LARGE, MOST_TIMES = 64_000_000, 200
"""Bytes that may be unpacked however few are written, and how many times these."""
_PLACE = ("kind", "quantity", "pitch_cm", "origin_cm")


def is_store_of_images(path: Path) -> bool:
    """Return whether a folder is a Zarr store of such images; imports no Zarr."""
    try:
        data = json.loads((path / _METADATA).read_bytes())
        return bool(data["attributes"]["format"] == FORMAT)
    except (OSError, ValueError, KeyError, TypeError, RecursionError):
        return False


def read_store(reading: Reading) -> Iterator[Frame]:
    """Yield the frames of one node of a Zarr store.

    Raises
    ------
    DataError
        As `read_node`, and if the store is damaged.
    UsageError
        If Zarr is not installed.
    """
    zarr = load_zarr()
    try:
        group: Any = zarr.open_group(str(reading.path), mode="r")
        names = [n for n, _ in group.members(max_depth=None) if f"{n}/values" in group]
    except Exception as error:  # a damaged store makes Zarr raise a dozen kinds
        raise DataError(str(reading.path), f"is no Zarr store that opens: {error}") from error
    yield from read_node(reading, group, names)


def read_node(reading: Reading, group: Any, names: list[str]) -> Iterator[Frame]:
    """Yield the images of the only node in a file, or of the one that ``sensor`` names.

    Where the node had no value there is no frame, and the next one follows a gap.

    Parameters
    ----------
    reading : Reading
    group : h5py.File or zarr.Group
    names : list of str
        The nodes that have images; those of embedded pipelines are called ``outer/inner``.

    Raises
    ------
    DataError
        If several nodes could be meant, there is none of that name or without an image, or the
        file is damaged.
    """
    reading.pass_settings()
    where = str(reading.path)
    node = _chosen(reading, group, names)
    try:
        values = group[node]["values"]
        _check_sizes(where, node, values, group[node]["outcome"], group["time_s"])
        outcomes = np.asarray(group[node]["outcome"][:])
        times, about = np.asarray(group["time_s"][:], np.float64), dict(values.attrs)
        place = _place(where, node, about)
        if not (values.ndim == 3 and values.shape[0] == len(outcomes) == len(times)):
            raise DataError(where, f"node {node!r}: as many images, outcomes and times it has not")
        reading.is_own = True
        reading.told.agree(where, *values.shape[1:])
        reading.recognised(f"it says so; node {node!r}, {about['kind']}s")
        reading.report.expect(int(np.count_nonzero(outcomes == 0)))
        missed = False
        n_block = max(1, min(_BLOCK, MOST_CELLS // max(1, values.shape[1] * values.shape[2])))
        for start in range(0, values.shape[0], n_block):
            block = np.asarray(values[start : start + n_block], np.float64)
            for k, matrix in enumerate(block, start):
                if outcomes[k] != 0:
                    reading.report.count(f"frames in which {node!r} has no value")
                    missed = True
                    continue
                if about["kind"] == "mask":
                    matrix = np.where(matrix > 1, np.nan, matrix)
                time_s = float(times[k]) if np.isfinite(times[k]) else None
                frame = reading.frame(matrix, time_s=time_s, **place)
                yield replace(frame, gap=True) if missed and k else frame
                missed = False
    except DataError:
        raise
    except Exception as error:  # HDF5 and Zarr have a dozen kinds of errors over damaged files
        text = f"node {node!r} cannot be read: {str(error)[:120]}"
        raise DataError(where, text) from error


def _check_sizes(where: str, node: str, values: Any, *columns: Any) -> None:
    """Refuse what asks for far more memory than a run of so many frames writes."""
    cells = math.prod(values.shape[1:])
    if cells > MOST_CELLS:
        told = f"node {node!r}: images of {cells:,} cells; allowed are {MOST_CELLS:,}"
        raise DataError(where, told)
    pieces = math.prod(-(-n // c) for n, c in zip(values.shape, values.chunks or (), strict=False))
    if pieces > MOST_PIECES * values.shape[0]:
        told = f"node {node!r}: each image is in more than {MOST_PIECES:,} pieces"
        raise DataError(where, told)
    unpacked = sum(c.size * c.dtype.itemsize for c in columns)
    packed = sum(map(_written_bytes, columns))
    if unpacked > max(LARGE, MOST_TIMES * packed):
        raise DataError(
            where,
            f"node {node!r}: outcomes and times unpack to {unpacked / 1e6:,.0f} MB, of which "
            f"{packed / 1e6:,.1f} are written; allowed are {MOST_TIMES} times that beyond "
            f"{LARGE / 1e6:g} MB",
        )


def _written_bytes(array: Any) -> int:
    """Return how many bytes of an array, of h5py or Zarr, are on the disc."""
    return int(array.id.get_storage_size() if hasattr(array, "id") else array.nbytes_stored())


def _chosen(reading: Reading, group: Any, names: list[str]) -> str:
    where, asked = str(reading.path), reading.told.sensor.removesuffix("/values")
    whole = sorted(names)
    if asked:
        if asked not in whole:
            near = did_you_mean(asked, whole)
            raise DataError(where, f"no image of a node {asked!r}, there are {one_of(whole)}{near}")
        reading.sensors[asked] = None
        return asked
    if len(whole) == 1:
        return whole[0]
    if not whole:
        raise DataError(where, "no node in it ever had an image")
    told = f"holds the images of several nodes: {one_of(whole)}; name one with sensor"
    raise SeveralSensorsError(where, told, whole)


def _place(where: str, node: str, about: Mapping[str, Any]) -> dict[str, Any]:
    """Return pitch, place and quantity of a node's images."""
    missing = [name for name in _PLACE if name not in about]
    if missing or not is_quantity(str(about.get("quantity"))):
        lost = missing[0] if missing else "a quantity that is known"
        raise DataError(where, f"node {node!r}: its attributes do not say {lost}")
    (x, y), (left, top) = about["pitch_cm"], about["origin_cm"]
    return {
        "pitch_cm": (float(x), float(y)),
        "origin_cm": (float(left), float(top)),
        "quantity": str(about["quantity"]),
    }


STORE = RecordingFormat(
    "images of nodes, as runs write them (.h5, .zarr)",
    lambda head: is_store_of_images(head.path),
    read_store,
    of_folders=True,
)
