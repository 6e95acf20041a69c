"""Step ``sharpen_contacts``: contacts cut off at a share of their own peak, between the cells."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from functools import lru_cache
from typing import Annotated

import numpy as np
from annotated_types import Ge, Gt, Le, Lt
from numpy.typing import NDArray

from tactile_graph_filters.contacts.contacts import Contact, Contacts, contacts_of


def sharpen_contacts(
    contacts: Sequence[Contact],
    *,
    share: Annotated[float, Gt(0), Lt(1)] = 0.69,
    finer: Annotated[int, Ge(1), Le(64)] = 8,
) -> Contacts:
    """Return each contact with area and centre of what reaches a share of its own peak.

    For sensors that blur, such as capacitive ones, where a fixed level makes strong contacts
    wide: between the cell centres the readings are interpolated, and the area is that of the
    fine cells above ``share`` of the peak.

    Parameters
    ----------
    contacts : sequence of Contact
    share : float
        At which share of the peak a contact ends. 0.69 makes the median area right for fingers
        on a capacitive panel.
    finer : int
        How many fine cells a cell has along each side.

    Returns
    -------
    Contacts
        ``area_cm2``, centroid and centre are those of the fine cells, the centre weighted by
        what exceeds the share; cells, load and peak stay as they were. Contacts without a
        reading above 0 stay as they are.

    Raises
    ------
    DataError
        If the area or a place of a contact is not finite.
    """
    return contacts_of([_sharpened(c, share, finer) for c in contacts])


def _sharpened(contact: Contact, share: float, finer: int) -> Contact:
    if contact.peak <= 0.0:
        return contact
    image = contact.image
    down, right = _between(image.rows, finer), _between(image.columns, finer)
    excess = down @ np.maximum(image.values, 0.0) @ right.T - share * contact.peak
    above = excess > 0.0
    if not above.any():  # the peak's cell centre lies between fine cells
        return contact
    weights = np.where(above, excess, 0.0)
    (x, y), (pitch_x, pitch_y) = image.origin_cm, image.pitch_cm
    column, row = _centre(weights, finer)
    middle_column, middle_row = _centre(above.astype(np.float64), finer)
    return replace(
        contact,
        area_cm2=float(np.count_nonzero(above)) / finer**2 * image.cell_area_cm2,
        x_cm=x + column * pitch_x,
        y_cm=y + row * pitch_y,
        centroid_x_cm=x + middle_column * pitch_x,
        centroid_y_cm=y + middle_row * pitch_y,
    )


def _centre(weights: NDArray[np.float64], finer: int) -> tuple[float, float]:
    """Return the mean (column, row) in cells from the image's corner."""
    total = float(weights.sum())
    rows, columns = weights.shape
    column = float(weights.sum(axis=0) @ (np.arange(columns) + 0.5)) / total
    row = float(weights.sum(axis=1) @ (np.arange(rows) + 0.5)) / total
    return column / finer, row / finer


@lru_cache(maxsize=256)
def _between(n: int, finer: int) -> NDArray[np.float64]:
    """Return the weights of linear interpolation between ``n`` cell centres, 0 outside.

    Shape (n * finer, n).
    """
    at = (np.arange(n * finer) + 0.5) / finer - 0.5
    weights: NDArray[np.float64] = np.maximum(0.0, 1.0 - np.abs(at[:, None] - np.arange(n)))
    weights.setflags(write=False)
    return weights
