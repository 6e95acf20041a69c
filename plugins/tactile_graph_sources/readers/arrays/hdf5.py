"""HDF5 files, MATLAB's of version 7.3 among them: one stack of matrices, its times beside it."""

from __future__ import annotations

import posixpath
from collections.abc import Iterator, Mapping
from functools import partial
from types import ModuleType
from typing import Any

import numpy as np

from tactile_graph.errors import DataError
from tactile_graph.wires import Frame
from tactile_graph_sources.readers.arrays import node_images
from tactile_graph_sources.readers.arrays.datasets import Held, Unread, frames_of
from tactile_graph_sources.readers.arrays.groups import Group, held_in, unread
from tactile_graph_sources.readers.arrays.matlab import frames_first
from tactile_graph_sources.readers.head import Head
from tactile_graph_sources.readers.reading import Reading
from tactile_graph_sources.readers.recording_format import RecordingFormat

_MARK = b"\x89HDF\r\n\x1a\n"
_MATLAB = b"MATLAB 7.3"
_REFERENCES = "references"
_ITEMS = "#refs#/"
"""Where it keeps what its cell arrays hold."""
LARGE, MOST_TIMES = 64_000_000, 200
"""Bytes that may be unpacked however few are written, and how many times these."""
MOST_ITEMS, DEEPEST = 2_000, 40


def recognises(head: Head) -> bool:
    """Return whether the file starts as HDF5 does, MATLAB's own words in front or not."""
    return head.raw.startswith(_MARK) or (
        head.raw.startswith(_MATLAB) and head.raw[512:].startswith(_MARK)
    )


def read(reading: Reading) -> Iterator[Frame]:
    """Yield the matrices of the only stack in the file, or of the one that ``sensor`` names.

    Raises
    ------
    DataError
        If h5py is not installed, the file is damaged, or no stack or several could be meant.
    """
    h5py = _h5py(reading)
    if _is_of_nodes(reading, h5py):
        with h5py.File(reading.path, "r") as file:
            names: list[str] = []
            file.visit(names.append)
            nodes = [n for n in names if f"{n}/values" in names]
            yield from node_images.read_node(reading, file, nodes)
        return
    held = _held(reading, h5py)
    if reading.head.raw.startswith(_MATLAB):
        # It counts the other way round.
        values = frames_first(reading, held.values.T, held.what, held.times)
        held = held._replace(values=values, known=True)
    yield from frames_of(reading, held)


def _h5py(reading: Reading) -> ModuleType:
    try:
        import h5py
    except ImportError:
        raise DataError(
            str(reading.path),
            "is HDF5, which needs the 'hdf5' extra: pip install \"tactile-graph[hdf5]\"",
        ) from None
    module: ModuleType = h5py
    return module


def _is_of_nodes(reading: Reading, h5py: ModuleType) -> bool:
    """Return whether a run wrote the file; one that is damaged is told by who reads it."""
    try:
        with h5py.File(reading.path, "r") as file:
            return bool(file.attrs.get("format") == node_images.FORMAT)
    except Exception:  # HDF5 has a dozen kinds of errors over damaged files
        return False


def _held(reading: Reading, h5py: ModuleType) -> Held:
    where = str(reading.path)
    try:
        with h5py.File(reading.path, "r") as file:
            sets, others = _datasets(where, h5py, file)
            numbers = {n: d for n, d in sets.items() if d.dtype.kind in "buif"}
            _refuse_cells(where, numbers, [n for n, u in others.items() if u.what == _REFERENCES])
            check = partial(_check_size, where)
            group = Group("dataset", sets, others, file, check, lambda d: d[()])
            return held_in(reading, group)
    except DataError:
        raise
    except Exception as error:  # HDF5 has a dozen kinds of errors over damaged files
        raise DataError(where, f"the HDF5 file cannot be read: {str(error)[:120]}") from error


def _refuse_cells(where: str, numbers: Mapping[str, Any], others: list[str]) -> None:
    """Refuse a file that holds nothing but the items of one of MATLAB's cell arrays."""
    named = [n for n in others if not n.startswith(_ITEMS)]
    if named and numbers and all(n.startswith(_ITEMS) for n in numbers):
        name = named[0]
        told = f"{name!r} is a cell array; in MATLAB, make it a stack: {name} = cat(3, {name}{{:}})"
        raise DataError(where, told)


def _datasets(where: str, h5py: ModuleType, file: Any) -> tuple[dict[str, Any], dict[str, Unread]]:
    """Return the datasets of a file by name, and what is in it that is not read."""
    found: dict[str, Any] = {}
    others: dict[str, Unread] = {}
    names: set[str] = set()
    n = 0

    def visit(name: str, item: Any) -> str | None:
        nonlocal n
        n += 1
        if n > MOST_ITEMS:
            return f"more than {MOST_ITEMS} groups and datasets"
        if name.count("/") > DEEPEST:
            return f"groups more than {DEEPEST} deep"
        names.add(name)
        if isinstance(item, h5py.Dataset):
            why = _why_unread(h5py, item)
            if why is None:
                found[name] = item
            else:
                others[name] = why
        return None

    def follow(name: str, link: Any) -> None:
        if isinstance(link, h5py.ExternalLink):
            told = f"a link to {link.path!r} in the file {link.filename!r}, which is not opened"
            others[name] = Unread(told, "give that file, or save its values in this one")
        elif isinstance(link, h5py.SoftLink):  # its end is not asked for: it may be another file's
            target = posixpath.normpath(posixpath.join("/", posixpath.dirname(name), link.path))
            if target[1:] not in names:
                others[name] = Unread(f"a link to {link.path!r}, where there is nothing to read")

    too_much = file.visititems(visit)
    if too_much is not None:
        raise DataError(where, f"it holds {too_much}")
    file.visititems_links(follow)
    return found, others


def _why_unread(h5py: ModuleType, dataset: Any) -> Unread | None:
    """Return why a dataset is not read; None where it may be."""
    if dataset.shape is None:
        return Unread("empty")
    if h5py.check_string_dtype(dataset.dtype) or _class_of(dataset) == "char":
        return unread(np.dtype("S1"), dataset.shape)
    if h5py.check_ref_dtype(dataset.dtype):
        return Unread(_REFERENCES, "", dataset.shape)
    return unread(dataset.dtype, dataset.shape)


def _class_of(dataset: Any) -> str:
    """Return what MATLAB calls the type of a variable."""
    found = dataset.attrs.get("MATLAB_class", b"")
    return found.decode("latin-1") if isinstance(found, bytes) else str(found)


def _check_size(where: str, datasets: Mapping[str, Any]) -> None:
    """Refuse datasets that lie elsewhere, or are together far larger than what is written."""
    for name, dataset in datasets.items():
        if dataset.is_virtual or dataset.external:
            told = f"dataset {name!r} lies in other files; save its values in this one"
            raise DataError(where, told)
    bytes_ = sum(d.size * d.dtype.itemsize for d in datasets.values())
    packed = sum(d.id.get_storage_size() for d in datasets.values())
    if bytes_ > max(LARGE, MOST_TIMES * packed):
        which = f"dataset{'s' if len(datasets) > 1 else ''} {', '.join(map(repr, [*datasets][:3]))}"
        more = f" and {len(datasets) - 3} more" if len(datasets) > 3 else ""
        raise DataError(
            where,
            f"{which}{more} unpack{'s' if len(datasets) == 1 else ''} to {bytes_ / 1e6:,.0f} MB, "
            f"of which {packed / 1e6:,.1f} are written; allowed are {MOST_TIMES} times that "
            f"beyond {LARGE / 1e6:g} MB",
        )


FORMAT = RecordingFormat("HDF5 (.h5, .hdf5, MATLAB 7.3 .mat)", recognises, read)
