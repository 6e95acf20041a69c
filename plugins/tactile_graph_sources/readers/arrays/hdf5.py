"""HDF5 files, MATLAB's of version 7.3 among them: one stack of matrices, its times beside it."""

from __future__ import annotations

import posixpath
from collections.abc import Iterator, Mapping
from functools import partial
from types import ModuleType
from typing import Any

import numpy as np
from numpy.typing import NDArray

from tactile_graph.errors import DataError, without
from tactile_graph.wires import Frame
from tactile_graph_sources.readers.arrays import node_images
from tactile_graph_sources.readers.arrays.datasets import Held, Unread, frames_of
from tactile_graph_sources.readers.arrays.groups import (
    TEXT,
    Group,
    held_in,
    item_bytes,
    packing,
    unread,
)
from tactile_graph_sources.readers.arrays.matlab import of_matlab
from tactile_graph_sources.readers.arrays.never_written import never_written
from tactile_graph_sources.readers.arrays.packing import Packing
from tactile_graph_sources.readers.head import Head
from tactile_graph_sources.readers.reading import OF_TIMES, Reading
from tactile_graph_sources.readers.recording_format import RecordingFormat

_MARK = b"\x89HDF\r\n\x1a\n"
_MATLAB = b"MATLAB 7.3"
_ITEMS = "#refs#/"
"""Where it keeps what its cell arrays hold."""
LARGE, MOST_TIMES = 64_000_000, 200
"""Bytes that may be unpacked however few are written, and how many times these."""
MOST_ITEMS, MOST_CELLS, DEEPEST = 2_000, 30_000, 40


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
    reading.refuse_settings(*OF_TIMES)
    held = _held(reading, h5py)
    if reading.head.raw.startswith(_MATLAB):  # which counts the other way round
        turned = np.swapaxes(held.values, -1, -2) if held.known else held.values.T
        held = of_matlab(reading, held._replace(values=turned))
    yield from frames_of(reading, held)


def _h5py(reading: Reading) -> ModuleType:
    try:
        import h5py
    except ImportError as error:
        missing = "is HDF5, which needs the 'hdf5' extra: pip install \"tactile-graph[hdf5]\""
        raise DataError(str(reading.path), without("h5py", error, missing)) from error
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
            cells = {n: d for n, d in sets.items() if isinstance(d, _Cells)}
            check = partial(_check_size, where)

            def texts(name: str) -> list[str]:
                return _texts(h5py, name, file[name]) if others[name].what == TEXT else []

            load = partial(_loaded, reading)
            group = Group(
                "dataset", sets, others, file, check, load, texts, packing, frozenset(cells)
            )
            return held_in(reading, group)
    except DataError:
        raise
    except Exception as error:  # HDF5 has a dozen kinds of errors over damaged files
        raise DataError(where, f"the HDF5 file cannot be read: {str(error)[:120]}") from error


def _loaded(reading: Reading, dataset: Any, packing: Packing) -> NDArray[Any]:
    """Return the values of a dataset; NaN where nobody wrote any, which is told."""
    values: NDArray[Any] = packing.unpacked(dataset[()])
    left = None if isinstance(dataset, _Cells) else never_written(dataset)
    if left is None:
        return values
    reading.assume(left.told(dataset.name.lstrip("/")))
    return left.left_out_of(values)


class _Cells:
    """What a cell array of MATLAB refers to, matrices of one size, as one dataset."""

    def __init__(self, items: list[Any]) -> None:
        self.items = items
        self.dtype: np.dtype[Any] = np.result_type(*{d.dtype for d in items})
        self.shape: tuple[int, ...] = (len(items), *items[0].shape)
        self.ndim, self.size = len(self.shape), len(items) * items[0].size
        self.attrs: dict[str, Any] = {}

    def __getitem__(self, key: tuple[()]) -> NDArray[Any]:
        return np.stack([d[key] for d in self.items])


def _referred(h5py: ModuleType, dataset: Any) -> list[Any]:
    """Return what a dataset of references refers to; none where one leads nowhere.

    Nor in files without cells of MATLAB's: what others refer to is found by its own name.
    """
    file, found = dataset.file, []
    of_matlab = _ITEMS.strip("/") in file and dataset.shape is not None
    for reference in np.ravel(dataset[()]) if of_matlab and dataset.size <= MOST_CELLS else ():
        if not (isinstance(reference, h5py.Reference) and reference):
            return []
        try:
            found.append(file[reference])
        except (KeyError, RuntimeError, ValueError):
            return []
    return found


def _texts(h5py: ModuleType, name: str, dataset: Any) -> list[str]:
    """Return the texts of a dataset: its items, MATLAB's rows of letters or its cells of them.

    Raises
    ------
    DataError
        If they are far larger than what is written.
    """
    where, written = dataset.file.filename, dataset.file.id.get_filesize()
    if not h5py.check_ref_dtype(dataset.dtype):
        _check_size(where, {name: dataset}, written)
        return _letters(name, dataset)
    items = {f"{name}{{{k}}}": d for k, d in enumerate(_referred(h5py, dataset), 1)}
    _check_size(where, items, written)
    return [" ".join(_letters(*item)) for item in items.items()]


def _letters(name: str, dataset: Any) -> list[str]:
    if _class_of(dataset) == "char":
        return ["".join(map(chr, row)) for row in np.atleast_2d(dataset[()].T)]
    found: list[str] = []
    n_letters, written = 0, dataset.file.id.get_filesize()
    for part in _parts(dataset, written):
        found += [v.decode("utf-8", "replace") if isinstance(v, bytes) else str(v) for v in part]
        n_letters += sum(map(len, part))
        if n_letters > max(LARGE, MOST_TIMES * written):
            told = f"the texts of {name!r} unpack to more than {n_letters / 1e6:,.0f} MB, of which "
            raise DataError(dataset.file.filename, f"{told}{written / 1e6:,.1f} are written")
    return found


def _parts(dataset: Any, written: int) -> Iterator[list[Any]]:
    """Yield the items of a dataset of texts, few of those of which each may be the whole file."""
    most = max(MOST_TIMES, LARGE // written)
    if dataset.dtype.kind != "O" or dataset.size <= most:
        yield np.ravel(dataset[()]).tolist()
    elif dataset.size in dataset.shape:  # those in several rows are no times
        axes = (slice(None),) * dataset.shape.index(dataset.size)
        for start in range(0, dataset.size, most):
            yield np.ravel(dataset[(*axes, slice(start, start + most))]).tolist()


def _in_cells(h5py: ModuleType, dataset: Any) -> _Cells | Unread:
    """Return what a dataset of references refers to, or why that is not read."""
    name = dataset.name.rpartition("/")[2]
    items = _referred(h5py, dataset)
    if _ITEMS.strip("/") not in dataset.file:
        return Unread("references", "", dataset.shape)
    if items and all(isinstance(d, h5py.Dataset) and d.shape is not None for d in items):
        why = [_why_unread(h5py, d) for d in items]
        if all(w is not None and w.what == TEXT for w in why):
            return Unread(TEXT, "", dataset.shape)
        numbers = all(w is None and d.dtype.kind in "buif" for w, d in zip(why, items, strict=True))
        numbers = numbers and not any("MATLAB_empty" in d.attrs for d in items)  # their sizes
        if numbers and len({d.shape for d in items}) == 1:
            return _Cells(items)
    told = f"in MATLAB, make it a stack: {name} = cat(3, {name}{{:}})"
    return Unread("a cell array of unlike things", told, dataset.shape)


def _datasets(where: str, h5py: ModuleType, file: Any) -> tuple[dict[str, Any], dict[str, Unread]]:
    """Return the datasets of a file by name, and what is in it that is not read."""
    found: dict[str, Any] = {}
    others: dict[str, Unread] = {}
    names: set[str] = set()
    n = n_cells = 0

    def visit(name: str, item: Any) -> str | None:
        nonlocal n, n_cells
        if name.startswith(_ITEMS):
            n_cells += 1
            return f"more than {MOST_CELLS} cells" if n_cells > MOST_CELLS else None
        n += 1
        if n > MOST_ITEMS:
            return f"more than {MOST_ITEMS} groups and datasets"
        if name.count("/") > DEEPEST:
            return f"groups more than {DEEPEST} deep"
        names.add(name)
        if isinstance(item, h5py.Dataset):
            why = _why_unread(h5py, item)
            if h5py.check_ref_dtype(item.dtype):
                cells = _in_cells(h5py, item)
                if isinstance(cells, Unread):
                    others[name] = cells
                else:
                    found[name] = cells
            elif why is None:
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
        return Unread("references", "", dataset.shape)
    return unread(dataset.dtype, dataset.shape)


def _class_of(dataset: Any) -> str:
    """Return what MATLAB calls the type of a variable."""
    found = dataset.attrs.get("MATLAB_class", b"")
    return found.decode("latin-1") if isinstance(found, bytes) else str(found)


def _check_size(where: str, datasets: Mapping[str, Any], written: int | None = None) -> None:
    """Refuse datasets that lie elsewhere, or are together far larger than what is written.

    Of texts that is the whole file: those of even steps pack to next to nothing.
    """
    datasets = {
        f"{name}{{{k + 1}}}" if isinstance(d, _Cells) else name: one
        for name, d in datasets.items()
        for k, one in enumerate(d.items if isinstance(d, _Cells) else [d])
    }
    for name, dataset in datasets.items():
        if dataset.is_virtual or dataset.external:
            told = f"dataset {name!r} lies in other files; save its values in this one"
            raise DataError(where, told)
    bytes_ = sum(d.size * item_bytes(d.dtype) for d in datasets.values())
    packed = written or sum(d.id.get_storage_size() for d in datasets.values())
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
