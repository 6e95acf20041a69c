"""Contacts of cells that somebody has already numbered."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from tactile_graph.wires import Image
from tactile_graph_filters.contacts.contacts import Contact, Contacts
from tactile_graph_filters.images.crop import widened


def contacts_of(
    labels: NDArray[np.int32], image: Image, min_cells: int = 1, margin: int = 0
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
        if np.count_nonzero(own) >= min_cells:
            found.append(_contact(k, (row[own], column[own]), image, labels, margin))
    return Contacts(tuple(found), len(found))


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
