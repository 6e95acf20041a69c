"""``Presses``: frames with one object each, as reliefs are learned from them and fitted to them."""

from __future__ import annotations

from collections.abc import Iterable
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
NOTHING = 0.012
"""Readings below this share of full scale are none."""
FAINT = 0.02
"""And those below this share of the highest."""
MARGIN = 3
"""Cells around a footprint that are looked at."""
EDGE = 0.05
"""Share of the highest reading that the pad's edge must read for a press to be cut by it."""


class Presses(NamedTuple):
    """Presses of one object.

    Parameters
    ----------
    values : ndarray, shape (n, rows, columns)
        Readings of full scale above zero; 0 where there is none.
    good : ndarray of bool, shape (n, rows, columns)
        Where there is a reading.
    boxes : ndarray of int, shape (n, 4)
        Row, column, rows and columns of what is looked at.
    centres : ndarray, shape (n, 2)
        x and y of the load, in cells.
    """

    values: Array
    good: NDArray[np.bool_]
    boxes: NDArray[np.int64]
    centres: Array

    @classmethod
    def of(cls, images: Iterable[Array], full_scale: float) -> Presses:
        """Return images, readings in any unit, as presses.

        Parameters
        ----------
        images : iterable of ndarray, shape (rows, columns)
            NaN where there is no reading.
        full_scale : float

        Raises
        ------
        ValueError
            If nothing touches the pad in one of them.
        """
        found = [_press(image, full_scale) for image in images]
        values, good, boxes, centres = zip(*found, strict=True)
        return cls(np.array(values), np.array(good), np.array(boxes), np.array(centres))

    def chosen(self, which: NDArray[np.bool_] | slice) -> Presses:
        """Return some of them."""
        return Presses(self.values[which], self.good[which], self.boxes[which], self.centres[which])

    def n_cells(self) -> NDArray[np.int64]:
        """Return how many cells of each are looked at."""
        return np.asarray(self.boxes[:, 2] * self.boxes[:, 3])

    def totals(self) -> Array:
        """Return the sum of each."""
        return np.asarray(np.maximum(self.values, 0.0).sum(axis=(1, 2)))

    def away(self) -> Array:
        """Return the readings beside what is looked at, of all of them."""
        beside = self.good.copy()
        for some, (i, j, m, n) in zip(beside, self.boxes.tolist(), strict=True):
            some[i : i + m, j : j + n] = False
        return np.asarray(self.values[beside])

    def cut(self, share: float = EDGE) -> NDArray[np.bool_]:
        """Return which reach the edge of the pad, by a share of their highest reading."""
        v = self.values
        rim = np.maximum.reduce(
            [v[:, 0].max(1), v[:, -1].max(1), v[:, :, 0].max(1), v[:, :, -1].max(1)]
        )
        return np.asarray(rim > share * v.max(axis=(1, 2)))


def _press(image: Array, full_scale: float) -> tuple[Array, NDArray[np.bool_], list[int], Array]:
    good = np.isfinite(image)
    some = image[good]
    if not some.size:
        raise ValueError("no cell has a reading")
    zero = np.median(some[some <= np.quantile(some, 0.6)])
    above = np.where(good, (image - zero) / full_scale, 0.0)
    foot = above > max(FAINT * above.max(), NOTHING)
    i, j = np.nonzero(foot)
    if not i.size:
        raise ValueError(f"nothing reads more than {100 * NOTHING:g} % of full scale")
    low = np.maximum([i.min() - MARGIN, j.min() - MARGIN], 0)
    high = np.minimum([i.max() + MARGIN + 1, j.max() + MARGIN + 1], image.shape)
    share = above[foot] / above[foot].sum()
    centre = np.array([((j + 0.5) * share).sum(), ((i + 0.5) * share).sum()])
    return above, good, [*map(int, (*low, *(high - low)))], centre
