"""``PlaceCorrection``: from a contact's surroundings to where it truly lies, and how surely."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from tactile_graph.errors import DataError
from tactile_graph.files import whole_file
from tactile_graph_pads.learning.patch import N_PLACE, PatchKind, patches, place_terms

Array = NDArray[np.float64]
Flags = NDArray[np.bool_]
KIND = ("reach", "step_cells", "power", "window_cells")
ARRAYS = ("mean_patch", "scale", "weights", "covariance", "std_cells")


class Corrected(NamedTuple):
    """Where contacts truly lie, (column, row) in cells from the first cell's middle, shape (k, 2),
    and the standard deviation of either, same shape."""

    centres: Array
    std_cells: Array


@dataclass(frozen=True, eq=False)
class PlaceCorrection:
    """A linear correction of places, with the deviation of its answers.

    Parameters
    ----------
    kind : PatchKind
    shape : (int, int)
        Rows and columns of the pad.
    mean_patch : ndarray, shape (p,)
        Taken off each patch.
    scale : float
        Each patch is divided by it.
    weights : ndarray, shape (10 + p, 2)
        Cells in x and y for each place term and each point of the patch.
    covariance : ndarray, shape (10 + p, 10 + p)
        Of the weights, for errors of variance 1.
    std_cells : ndarray, shape (2,)
        Error in x and y, as seen where it was not learned, of a patch like the mean one.

    Notes
    -----
    With the terms f of a contact the place is the patch's middle + f W, and its variance
    std² (1 + f C fᵀ): a contact unlike those it was learned from is told less surely.
    """

    kind: PatchKind
    shape: tuple[int, int]
    mean_patch: Array
    scale: float
    weights: Array
    covariance: Array
    std_cells: Array

    def correct(self, values: Array, good: Flags, centres: Array) -> Corrected:
        """Return where the contacts of a frame truly lie.

        Parameters
        ----------
        values : ndarray, shape (rows, columns)
            Readings above the offset.
        good : ndarray of bool, same shape
        centres : ndarray, shape (k, 2)
            Of all contacts of the frame, as `patches` takes them.
        """
        if not len(centres):
            return Corrected(np.zeros((0, 2)), np.zeros((0, 2)))
        taken, middles = patches(values, good, centres, self.kind)
        f = terms(taken, middles, self.shape, self.mean_patch, self.scale)
        grown = 1.0 + np.einsum("ij,jk,ik->i", f, self.covariance, f)
        return Corrected(middles + f @ self.weights, np.sqrt(grown)[:, None] * self.std_cells)


def terms(
    taken: Array, middles: Array, shape: tuple[int, int], mean_patch: Array, scale: float
) -> Array:
    """Return what the correction is linear in, shape (k, 10 + p)."""
    return np.hstack([place_terms(middles, shape), (taken - mean_patch) / scale])


def write_place(path: Path, place: PlaceCorrection) -> None:
    """Write a correction as a NumPy archive, whole or not at all."""
    arrays: dict[str, Any] = {name: np.float64(getattr(place.kind, name)) for name in KIND}
    arrays |= {name: getattr(place, name) for name in ARRAYS}
    with whole_file(path) as file:
        np.savez_compressed(file, shape=np.array(place.shape), **arrays)


def read_place(path: Path) -> PlaceCorrection:
    """Return the correction that a file holds.

    Raises
    ------
    DataError
        If it is not there, or not such a file.
    """
    try:
        with np.load(path, allow_pickle=False) as held:
            reach, step, power, window = (float(held[name]) for name in KIND)
            mean_patch, scale, weights, covariance, std = (
                np.asarray(held[name], np.float64) for name in ARRAYS
            )
            rows, columns = (int(n) for n in held["shape"])
    except Exception as error:  # a damaged archive makes zipfile and NumPy raise a dozen kinds
        raise DataError(str(path), f"the correction of place cannot be read: {error}") from error
    kind = PatchKind(int(reach), step, power, window)
    n = N_PLACE + kind.size
    sizes = (mean_patch.shape, weights.shape, covariance.shape, std.shape)
    if sizes != ((kind.size,), (n, 2), (n, n), (2,)):
        raise DataError(str(path), f"is no correction of place: its arrays have the shapes {sizes}")
    return PlaceCorrection(
        kind, (rows, columns), mean_patch, float(scale), weights, covariance, std
    )
