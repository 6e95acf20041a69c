"""Chunks of arrays that are not there: HDF5 and Zarr read them as a fill value, mostly zeros.

HDF5 leaves out only what nobody wrote, as of a recorder that made room beforehand and was killed.
Zarr also leaves out what holds nothing but the fill value: nobody can tell that from what is lost.
"""

from __future__ import annotations

import math
import os
from itertools import product
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

_NOT_ALLOCATED = 0
"""HDF5's own number for a dataset without any place in the file."""


class NeverWritten(NamedTuple):
    """Which cells of an array nobody wrote, of how many of its chunks."""

    cells: NDArray[np.bool_]
    n_chunks: int
    n_all: int

    def told(self, name: str) -> str:
        """Return what is said of recordings with them."""
        chunks = f"{self.n_chunks} of {self.n_all} chunks of dataset {name!r} never written"
        if self.n_all == 1:
            chunks = f"dataset {name!r} never written"
        text = f"{chunks}, whose values are taken for missing"
        n_whole = int(np.count_nonzero(self.cells.reshape(len(self.cells), -1).all(axis=1)))
        return f"{text} (all of {n_whole} of the {len(self.cells)} along its first axis)"

    def left_out_of(self, values: NDArray[Any]) -> NDArray[Any]:
        """Return values with NaN where nobody wrote any, dates with NaT."""
        dated = values.dtype.kind in "mM"
        found = values.astype(values.dtype if dated or values.dtype.kind == "f" else np.float64)
        found[self.cells] = "NaT" if dated else np.nan
        return found


def never_written(dataset: Any) -> NeverWritten | None:
    """Return which cells of a dataset of h5py nobody wrote; None where all are there.

    What was made in one piece is there as a whole or not at all.
    """
    if not dataset.size or not dataset.ndim:
        return None
    if dataset.chunks is None:
        if dataset.id.get_space_status() != _NOT_ALLOCATED:
            return None
        return NeverWritten(np.ones(dataset.shape, bool), 1, 1)
    grid = _grid(dataset.shape, dataset.chunks)
    if dataset.id.get_num_chunks() >= math.prod(grid):
        return None
    missing = np.ones(grid, bool)

    def is_there(chunk: Any) -> None:
        place = zip(chunk.chunk_offset, dataset.chunks, strict=True)
        missing[tuple(at // size for at, size in place)] = False

    dataset.id.chunk_iter(is_there)
    cells = missing
    for axis, (n, size) in enumerate(zip(dataset.shape, dataset.chunks, strict=True)):
        cells = np.repeat(cells, min(size, n), axis=axis)
        cells = cells[(slice(None),) * axis + (slice(n),)]
    return NeverWritten(cells, int(np.count_nonzero(missing)), missing.size)


def said_of_gone(name: str, array: Any, pieces: tuple[int, ...]) -> str:
    """Return what is said of recordings with an array of Zarr that lacks files; "" where none does.

    Parameters
    ----------
    name : str
    array : zarr.Array
        In a folder.
    pieces : tuple of int
        The shape of what is in a file.
    """
    if not array.size or not array.ndim:
        return ""
    folder = os.path.join(array.store_path.store.root, array.store_path.path)
    key_of = array.metadata.encode_chunk_key
    there = os.path.exists
    grid = _grid(array.shape, pieces)
    gone = [at for at in product(*map(range, grid)) if not there(os.path.join(folder, key_of(at)))]
    if not gone:
        return ""
    first = [k * size for k, size in zip(gone[0], pieces, strict=True)]
    return (
        f"{len(gone)} of {math.prod(grid)} chunks of array {name!r} not there, from {first} on: "
        f"read as its fill value, {array.fill_value}, be they lost, or left out for holding "
        "nothing else"
    )


def _grid(shape: tuple[int, ...], pieces: tuple[int, ...]) -> tuple[int, ...]:
    return tuple(-(-n // max(size, 1)) for n, size in zip(shape, pieces, strict=True))
