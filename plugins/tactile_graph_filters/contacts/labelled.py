"""Contacts of cells that somebody has already numbered."""

from __future__ import annotations

from math import inf

import numpy as np
from numpy.typing import NDArray

from tactile_graph.wires import Image
from tactile_graph_filters.contacts.contacts import Contact, Contacts
from tactile_graph_filters.contacts.labels import label
from tactile_graph_filters.images.crop import widened

APART = 2
"""Cells within which pieces may be one object's, torn apart by voids."""


def contacts_of(
    labels: NDArray[np.int32],
    image: Image,
    min_cells: int = 1,
    margin: int = 0,
    min_alone: float = inf,
) -> Contacts:
    """Return a contact for each number, in reading order of their first cells.

    Parameters
    ----------
    labels : ndarray of int32, shape (rows, columns)
        0 where no contact is; other numbers in any order. Nobody else may hold on to it.
    image : Image
        Readings on the same grid.
    min_cells : int
        Smaller contacts are left out.
    margin : int
        How many more cells each contact's own image and mask have on each side.
    min_alone : float
        Smaller contacts of so many cells are kept, too, if these lie side by side and no other
        contact's within two cells.

    Returns
    -------
    Contacts
    """
    row, column = np.nonzero(labels)
    old, first, number = np.unique(labels[row, column], return_index=True, return_inverse=True)
    order = np.argsort(first)
    rank = np.empty(old.size, np.int32)
    rank[order] = np.arange(1, old.size + 1)
    ranked = rank[number]
    labels[row, column] = ranked
    labels.setflags(write=False)
    found = []
    for k in range(1, old.size + 1):
        own = ranked == k
        n = np.count_nonzero(own)
        if n >= min_cells or (n >= min_alone and _alone(labels, row[own], column[own])):
            found.append(_contact(k, (row[own], column[own]), image, labels, margin))
    return Contacts(tuple(found), len(found))


def _alone(labels: NDArray[np.int32], row: NDArray[np.intp], column: NDArray[np.intp]) -> bool:
    """Return whether a contact's cells lie side by side, and no other's within two cells."""
    top, left = max(int(row.min()) - APART, 0), max(int(column.min()) - APART, 0)
    near = labels[top : int(row.max()) + APART + 1, left : int(column.max()) + APART + 1]
    if np.count_nonzero(near) > row.size:
        return False
    return len(label(near.astype(np.float64), near > 0, True, np.empty(near.shape, np.int32))) == 1


def _contact(
    number: int,
    cells: tuple[NDArray[np.intp], NDArray[np.intp]],
    image: Image,
    labels: NDArray[np.int32],
    margin: int,
) -> Contact:
    (row, column), load = cells, image.values[cells]
    (x, y), (pitch_x, pitch_y) = image.origin_cm, image.pitch_cm
    pressed = np.maximum(load, 0.0)
    weights = pressed if pressed.any() else np.ones(load.shape)
    total = float(weights.sum())
    box = (int(row.min()), int(row.max()) + 1, int(column.min()), int(column.max()) + 1)
    return Contact(
        number,
        row.size,
        row.size * image.cell_area_cm2,
        float(load.sum()),
        float(load.max()),
        x + (float(column @ weights) / total + 0.5) * pitch_x,
        y + (float(row @ weights) / total + 0.5) * pitch_y,
        x + (float(column.mean()) + 0.5) * pitch_x,
        y + (float(row.mean()) + 0.5) * pitch_y,
        widened(box, margin, image.shape),
        image,
        labels,
    )
