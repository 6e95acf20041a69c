"""Arrays that grow by a row a frame, in an HDF5 file or a Zarr store."""

from __future__ import annotations

import io
from pathlib import Path
from typing import Any, NamedTuple, Protocol

import numpy as np

from tactile_graph.errors import UsageError, without


class Cells(NamedTuple):
    """How an array is kept: the type of its cells, what stands where none was written, and how
    many rows go into a chunk.
    """

    dtype: str
    fill: float
    chunk: int


class Growing:
    """An array that grows by a row a frame, written a chunk at a time.

    Parameters
    ----------
    array : object
        Of h5py or Zarr, without rows.
    chunk : int
    n_before : int
        How many rows that hold the fill value come first.
    """

    def __init__(self, array: Any, chunk: int, n_before: int = 0) -> None:
        self._array = array
        self._chunk = chunk
        self._held: list[Any] = []
        self._n_written = n_before

    def add(self, row: Any) -> None:
        """Take a row."""
        self._held.append(row)
        if (self._n_written + len(self._held)) % self._chunk == 0:
            self.flush()

    def flush(self) -> None:
        """Write the rows that are held."""
        end = self._n_written + len(self._held)
        self._array.resize((end, *self._array.shape[1:]))
        if self._held:
            self._array[self._n_written :] = np.array(self._held)
        self._held, self._n_written = [], end


class Container(Protocol):
    """A file of named arrays, each with attributes."""

    def array(self, name: str, row: tuple[int, ...], cells: Cells, about: dict[str, Any]) -> Any:
        """Return a new array without rows, in groups by the slashes of its name."""

    def check(self) -> None:
        """Raise what the system refused to write so far, as an OSError."""

    def close(self) -> None:
        """Let go of the file; raises as `check` does."""


class _Patient(io.FileIO):
    """A file for HDF5, whose library crashes when it closes one that it could not write.

    It is told that all went well; ``refused`` is the first error.
    """

    refused: OSError | None = None

    def write(self, data: Any, /) -> int:
        """Write all of the data, or nothing more."""
        left = memoryview(data).cast("B")
        size = len(left)
        try:
            while left and self.refused is None:
                left = left[super().write(left) :]
        except OSError as error:
            self.refused = error
        return size

    def truncate(self, size: int | None = None, /) -> int:
        """Make it as long as told."""
        try:
            return super().truncate(size)
        except OSError as error:
            self.refused = self.refused or error
            return size or 0


class Hdf5:
    """An HDF5 file.

    Raises
    ------
    UsageError
        If h5py is not installed.
    """

    def __init__(self, path: Path, about: dict[str, Any]) -> None:
        try:
            import h5py
        except ImportError as error:
            missing = 'HDF5 files need h5py: pip install "tactile-graph[hdf5]"'
            raise UsageError(without("h5py", error, missing)) from error
        self._written = _Patient(path, "w+")
        self._file = h5py.File(self._written, "w")
        self._file.attrs.update(about)

    def array(self, name: str, row: tuple[int, ...], cells: Cells, about: dict[str, Any]) -> Any:
        """Return a new array without rows."""
        made = self._file.create_dataset(
            name, (0, *row), cells.dtype, chunks=(cells.chunk, *row), maxshape=(None, *row),
            fillvalue=cells.fill, compression="gzip", compression_opts=1, shuffle=True,
        )  # fmt: skip
        made.attrs.update(about)
        return made

    def check(self) -> None:
        """Raise what the system refused to write so far."""
        if self._written.refused is not None:
            raise self._written.refused

    def close(self) -> None:
        """Let go of the file."""
        self._file.close()
        self._written.close()
        self.check()


class Zarr:
    """A Zarr store, version 3.

    Raises
    ------
    UsageError
        If Zarr is not installed.
    """

    def __init__(self, path: Path, about: dict[str, Any]) -> None:
        try:
            import zarr
        except ImportError as error:
            missing = 'Zarr stores need zarr: pip install "tactile-graph[zarr]"'
            raise UsageError(without("zarr", error, missing)) from error
        self._group: Any = zarr.create_group(str(path), attributes=about)

    def array(self, name: str, row: tuple[int, ...], cells: Cells, about: dict[str, Any]) -> Any:
        """Return a new array without rows."""
        return self._group.create_array(
            name, shape=(0, *row), chunks=(cells.chunk, *row), dtype=cells.dtype,
            fill_value=cells.fill, attributes=about,
        )  # fmt: skip

    def check(self) -> None:
        """Do nothing: Zarr raises by itself."""

    def close(self) -> None:
        """Do nothing: every chunk is a file of its own."""
