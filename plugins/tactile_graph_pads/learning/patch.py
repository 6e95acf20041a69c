"""What the readings around a contact look like, as numbers that a place is corrected by."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
Flags = NDArray[np.bool_]
STEPS = 15
"""Of the centre towards where the readings around it lie: it has come to rest long before."""
N_PLACE = 10
FEW = 16
"""Centres that are compared with every cell; of more the near ones are looked up."""
CUT = 4.0
"""Standard deviations at which smoothing is cut off."""


@dataclass(frozen=True)
class PatchKind:
    """How a patch is taken.

    Parameters
    ----------
    reach : int
        Points on each side of the middle one.
    step_cells : float
        Distance of the points; readings are smoothed over it where it is more than a cell.
    power : float
        Of the readings, once they add up to 1: less than 1 lets weak ones count.
    window_cells : float
        Width of the Gaussian window whose centre of readings the patch lies on; 0 where it lies
        on the contact's own centre.
    """

    reach: int
    step_cells: float = 1.0
    power: float = 1.0
    window_cells: float = 0.0

    @property
    def size(self) -> int:
        """Points of a patch."""
        return (2 * self.reach + 1) ** 2

    @property
    def smoothing_cells(self) -> float:
        """Standard deviation of the smoothing over a step; 0 where that is a cell or less."""
        return 0.5 * float(np.sqrt(self.step_cells**2 - 1.0)) if self.step_cells > 1.0 else 0.0

    @property
    def margin(self) -> int:
        """Cells around what is a contact's own that smoothing carries it into, and one more."""
        return int(CUT * self.smoothing_cells + 0.5) + 1


def patches(values: Array, good: Flags, centres: Array, kind: PatchKind) -> tuple[Array, Array]:
    """Return the patch of each contact of a frame, and the centre it lies on.

    Parameters
    ----------
    values : ndarray, shape (rows, columns)
        Readings above the offset.
    good : ndarray of bool, same shape
        Elsewhere a reading is taken from the good elements beside it.
    centres : ndarray, shape (k, 2)
        Of all contacts in the frame, (column, row) in cells from the first cell's middle.
    kind : PatchKind

    Returns
    -------
    (ndarray, ndarray)
        Shapes (k, kind.size) and (k, 2). A cell that lies nearer to another contact counts as 0.
    """
    from scipy.ndimage import find_objects

    out, middles = np.zeros((len(centres), kind.size)), np.array(centres, np.float64)
    at = np.mgrid[: values.shape[0], : values.shape[1]].astype(np.float64)
    owner = _owners(at, middles)
    known = np.where(good, values, 0.0)
    # A contact owns a part of the pad, beyond which nothing is told of it: only that is looked at.
    boxes = find_objects(owner + 1, len(centres))
    for k, box in enumerate(boxes):
        if box is None:  # another lies in the same place
            continue
        part = tuple(slice(max(0, s.start - kind.margin), s.stop + kind.margin) for s in box)
        own = owner[part] == k
        mine = np.where(own, known[part], 0.0)
        if kind.window_cells > 0.0:
            middles[k] = _windowed(mine, at[(slice(None), *part)], middles[k], kind.window_cells)
        corner = np.array([part[1].start, part[0].start], np.float64)
        out[k] = _patch(mine, np.where(own, good[part], True), middles[k] - corner, kind)
    return out, middles


def _owners(at: Array, centres: Array) -> NDArray[np.int64]:
    """Return for each cell which centre it is nearest to, of equally near ones the first.

    Parameters
    ----------
    at : ndarray, shape (2, rows, columns)
        Row and column of each cell.
    centres : ndarray, shape (k, 2)
        (column, row).
    """
    row, column = at
    if len(centres) <= FEW:
        far = np.stack([(column - x) ** 2 + (row - y) ** 2 for x, y in centres])
        return np.asarray(far.argmin(axis=0))
    from scipy.spatial import KDTree

    cells = np.column_stack([column.ravel(), row.ravel()])
    distances, which = KDTree(centres).query(cells, k=4)  # seldom are more than four as near
    near = np.asarray(distances)
    first = np.where(near == near[:, :1], which, len(centres)).min(axis=1)
    return np.asarray(first.reshape(row.shape))


def _windowed(values: Array, at: Array, start: Array, width: float) -> Array:
    """Return the centre of the readings in a Gaussian window around that very centre."""
    (row, column), centre = at, start
    positive = np.maximum(values, 0.0)
    for _ in range(STEPS):
        square = (column - centre[0]) ** 2 + (row - centre[1]) ** 2
        weight = positive * np.exp(-0.5 * square / width**2)
        total = float(weight.sum())
        if total <= 0.0:
            return start
        centre = np.array([(weight * column).sum(), (weight * row).sum()]) / total
    return centre


def _patch(values: Array, good: Flags, centre: Array, kind: PatchKind) -> Array:
    from scipy.ndimage import gaussian_filter, map_coordinates

    known = good.astype(np.float64)
    width = kind.smoothing_cells
    if width > 0.0:
        values = gaussian_filter(values, width, mode="constant", truncate=CUT)
        known = gaussian_filter(known, width, mode="nearest", truncate=CUT)
    offsets = kind.step_cells * np.arange(-kind.reach, kind.reach + 1)
    at = np.meshgrid(centre[1] + offsets, centre[0] + offsets, indexing="ij")
    read = map_coordinates(values, at, order=1, mode="constant", cval=0.0).ravel()
    share = map_coordinates(known, at, order=1, mode="constant", cval=1.0).ravel()
    read = np.where(share > 0.25, read / np.maximum(share, 0.25), 0.0)
    total = float(np.abs(read).sum())
    if total <= 0.0:
        return np.zeros(kind.size)
    return to_the_power(read / total, kind.power)


def to_the_power(shares: Array, power: float) -> Array:
    """Return shares of readings to a power, each with its sign."""
    return np.asarray(np.sign(shares) * np.abs(shares) ** power)


def place_terms(centres: Array, shape: tuple[int, int]) -> Array:
    """Return 1, x, y and the products of second and third order, for a place from -1 to 1.

    Parameters
    ----------
    centres : ndarray, shape (k, 2)
        In cells from the first cell's middle.
    shape : (int, int)
        Rows and columns of the pad.

    Returns
    -------
    ndarray, shape (k, 10)
    """
    half = 0.5 * np.array([shape[1] - 1.0, shape[0] - 1.0])
    x, y = ((centres - half) / np.maximum(half, 0.5)).T
    one = np.ones_like(x)
    return np.column_stack([one, x, y, x * x, x * y, y * y, x**3, x * x * y, x * y * y, y**3])
