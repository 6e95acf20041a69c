"""From cells in wire order to an image: order, transposition, flips, maps and valid range."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from tactile_graph_sources.devices.preset import Geometry


class Placement:
    """The geometry as one table: which wire cell each image cell takes its value from.

    Parameters
    ----------
    geometry : Geometry
    missing : bool
        Whether NaN stands for a cell without a value; otherwise a frame with it is refused.
    """

    def __init__(self, geometry: Geometry, missing: bool = False) -> None:
        self.geometry = geometry
        self.missing = missing
        self.table = _table(geometry)
        self.shape = self.table.shape
        flat = self.table.reshape(-1)
        self._same = bool((flat == np.arange(flat.size)).all())
        self.range = geometry.valid_range

    def in_range(self, cells: NDArray[Any]) -> NDArray[np.bool_]:
        """Return which frames, shape (k, n), hold nothing but allowed values."""
        good = np.ones(len(cells), dtype=np.bool_)
        if cells.dtype.kind == "f" and not self.missing:
            good &= np.isfinite(cells).all(axis=1)
        if self.range is not None:
            low, high = self.range
            if self.missing:  # of NaN neither is true
                good &= ~((cells < low) | (cells > high)).any(axis=1)
            else:
                good &= (cells.min(axis=1) >= low) & (cells.max(axis=1) <= high)
        return good

    def images(self, cells: NDArray[Any]) -> NDArray[np.float64]:
        """Return the frames, shape (k, n), as images, shape (k, rows, columns)."""
        placed = cells if self._same else cells[:, self.table.reshape(-1)]
        values = placed.astype(np.float64).reshape(len(cells), *self.shape)
        if self.geometry.invert_from is not None:
            np.subtract(self.geometry.invert_from, values, out=values)
        return values


def _table(g: Geometry) -> NDArray[np.int64]:
    """Return the wire index of each image cell, shape (rows, columns) of the image."""
    wire = np.arange(g.n_cells)
    grid = (
        wire.reshape(g.rows, g.columns)
        if g.order == "rows"
        else (wire.reshape(g.columns, g.rows).T)
    )
    if g.row_map is not None:  # row_map[i] is where the i-th row on the wire lies
        grid = grid[np.argsort(g.row_map)]
    if g.column_map is not None:
        grid = grid[:, np.argsort(g.column_map)]
    if g.transpose:
        grid = grid.T
    if g.flip in ("rows", "both"):
        grid = grid[::-1]
    if g.flip in ("columns", "both"):
        grid = grid[:, ::-1]
    return np.ascontiguousarray(grid)
