"""Step ``gain``: readings divided by how strongly each element answers."""

from __future__ import annotations

import bz2
import gzip
import io
import lzma
import zlib
from pathlib import Path
from typing import Annotated, Any

import numpy as np
from numpy.typing import NDArray

from tactile_graph.errors import DataError, RuleError
from tactile_graph.files import is_plain
from tactile_graph.steps.rules import Grid, Quantity
from tactile_graph.text_files import decoded
from tactile_graph.wires import Image
from tactile_graph_filters.nan import finite, refuse_unbounded

MOST_BYTES = 16_000_000
"""Of a file of gains, or of the numbers in it: more than any pad has elements for."""
_UNPACKED: dict[str, Any] = {
    ".gz": gzip.open, ".bz2": bz2.open, ".xz": lzma.open, ".lzma": lzma.open,
}  # fmt: skip
_UNREADABLE = (OSError, ValueError, EOFError, zlib.error, lzma.LZMAError)


class Gain:
    """Return the readings divided by the gain of each element.

    Parameters
    ----------
    rows, columns : list of float, optional
        One factor a row, one a column.
    elements : list of list of float, or str, optional
        One factor an element: rows of numbers, or a ``.npy`` or comma-separated file of them.

    Raises
    ------
    ValueError
        If none is given, or a gain is negative or no number.
    DataError
        If the file cannot be read as a table of numbers, or holds more than 16 MB.

    Notes
    -----
    The gains multiply. An element with a gain of 0 tells nothing: it becomes invalid.
    """

    stateless = True

    def __init__(
        self,
        *,
        rows: list[float] | None = None,
        columns: list[float] | None = None,
        elements: list[list[float]] | str | None = None,
    ) -> None:
        if rows is None and columns is None and elements is None:
            raise ValueError("at least one of rows, columns and elements must be given")
        if isinstance(elements, str):
            table: NDArray[np.float64] = _read(Path(elements))
        else:
            table = _table("elements", [[1.0]] if elements is None else elements)
        down = _table("rows", [[gain] for gain in rows] if rows else [[1.0]])
        across = _table("columns", [columns] if columns else [[1.0]])
        shapes = {down.shape[0], table.shape[0]} - {1}, {across.shape[1], table.shape[1]} - {1}
        if any(len(sizes) > 1 for sizes in shapes):
            raise ValueError(
                f"{down.shape[0]} rows and {across.shape[1]} columns of gains do not fit"
                f" {table.shape[0]} x {table.shape[1]} elements"
            )
        self._gain = table * down * across
        self._needs = tuple(next(iter(sizes), 0) for sizes in shapes)
        self._dead = self._gain == 0.0
        self._has_dead = bool(self._dead.any())
        self._divisor = np.where(self._dead, 1.0, self._gain)

    def __call__(
        self, image: Image
    ) -> Annotated[Image, Quantity.like("image"), Grid.like("image")]:
        """Return the evened image.

        Raises
        ------
        RuleError
            If the image has another number of rows or columns than there are gains.
        DataError
            If a valid cell holds NaN or infinity.
        Degenerate
            If a reading over its gain is too large for a number.
        """
        for needed, got, what in zip(self._needs, image.shape, ("rows", "columns"), strict=True):
            if needed not in (0, got):
                raise RuleError(f"there are gains for {needed} {what}, got an image with {got}")
        values, valid = image.values / self._divisor, image.valid
        if self._has_dead:
            alive = np.broadcast_to(~self._dead, image.shape)
            valid = alive.copy() if valid is None else valid & alive
        if valid is not None:
            values[~valid] = 0.0
        if not finite(values):
            refuse_unbounded(image, "a reading over its gain")
        return image.with_values(values, valid=valid)


def _table(name: str, rows: list[list[float]]) -> NDArray[np.float64]:
    if len({len(row) for row in rows}) != 1 or not rows[0]:
        raise ValueError(f"{name}: must be equally long rows of gains")
    table = np.array(rows, np.float64)
    if not (np.isfinite(table) & (table >= 0.0)).all():
        row, column = np.argwhere(~(np.isfinite(table) & (table >= 0.0)))[0].tolist()
        raise ValueError(f"{name}: a gain must be 0 or more, got {table[row, column]}")
    return table


def _read(path: Path) -> NDArray[np.float64]:
    if not is_plain(path):
        raise DataError(str(path), "is no plain file; save what it gives as a file first")
    try:
        if path.suffix == ".npy":
            table: NDArray[Any] = np.lib.format.open_memmap(path, "r")
        else:
            table = np.loadtxt(io.StringIO(_text(path), newline=None), delimiter=",", ndmin=2)
        if table.nbytes > MOST_BYTES:
            raise ValueError(_too_much(table.nbytes))
    except _UNREADABLE as error:
        raise DataError(str(path), f"must hold a table of gains: {error}") from error
    return _table(str(path), np.atleast_2d(table).tolist())


def _text(path: Path) -> str:
    with _UNPACKED.get(path.suffix, open)(path, "rb") as file:
        data: bytes = file.read(MOST_BYTES + 1)
    if len(data) > MOST_BYTES:
        raise ValueError(_too_much(len(data)))
    return decoded(data)


def _too_much(n_bytes: int) -> str:
    return f"{n_bytes / 1e6:,.0f} MB or more, allowed are {MOST_BYTES / 1e6:g}"
