"""Step ``lean_contacts``: centres moved away from what leans over a contact without touching."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import Annotated

import numpy as np
from annotated_types import Ge, Gt
from numpy.typing import NDArray
from pydantic import AllowInfNan

from tactile_graph.errors import RuleError
from tactile_graph.wires import Image
from tactile_graph_filters.contacts.contacts import Contact, Contacts, contacts_of

Reals = NDArray[np.float64]


def lean_contacts(
    image: Image,
    contacts: Sequence[Contact],
    *,
    lean: Annotated[float, Ge(0), AllowInfNan(False)] = 0.35,
    reach_cells: Annotated[float, Gt(0)] = 3.2,
) -> Contacts:
    """Return each contact with its centres moved against the skewness of the readings around it.

    For sensors that also see what hovers, such as capacitive ones: a finger comes in at a slant,
    and the part of it above the glass draws the centre along. It shows as a tail of low readings
    on one side.

    Parameters
    ----------
    image : Image
        Readings, the low ones around the contacts among them.
    contacts : sequence of Contact
        On the same grid.
    lean : float
        How far to move, in units of the readings' skewness (see below); 0 moves nothing. 0.35
        is what fingers on a capacitive panel ask for.
    reach_cells : float
        How far around a contact its tail is looked for. A cell belongs to the nearest contact.

    Returns
    -------
    Contacts
        Both centres moved; everything else as it was. A contact without readings above 0
        stays as it is.

    Raises
    ------
    RuleError
        If a contact reaches over the image.
    DataError
        If the area or a place of a contact is not finite.

    Notes
    -----
    With the readings above 0 as weights and d the distance vector from their centre, the
    skewness is the length vector mean(d |d|^2) / mean(|d|^2): what is left of Mardia's third
    moments (1970, 10.1093/biomet/57.3.519) when they are summed to one vector. It turns with
    the finger, is 0 for whatever is symmetric, and does not depend on how strong a contact is.
    """
    moved = tuple(contacts)
    if not moved:
        return Contacts((), 0)
    shift_x, shift_y = -lean * _skewness(image, _owners(image, moved, reach_cells), len(moved))
    return contacts_of(
        replace(
            c,
            x_cm=c.x_cm + x,
            y_cm=c.y_cm + y,
            centroid_x_cm=c.centroid_x_cm + x,
            centroid_y_cm=c.centroid_y_cm + y,
        )
        for c, x, y in zip(moved, shift_x.tolist(), shift_y.tolist(), strict=True)
    )


def _owners(image: Image, contacts: Sequence[Contact], reach_cells: float) -> NDArray[np.int64]:
    """Return which contact each cell belongs to, counted from 0; -1 where none is in reach."""
    from scipy import ndimage

    owner = np.full(image.shape, -1, np.int64)
    for number, contact in enumerate(contacts):
        top, bottom, left, right = contact.box
        if bottom > image.shape[0] or right > image.shape[1]:
            raise RuleError(f"contact {contact.number} reaches over the image of {image.shape}")
        owner[top:bottom, left:right][contact.mask.values] = number
    far, (row, column) = ndimage.distance_transform_edt(owner < 0, return_indices=True)
    nearest: NDArray[np.int64] = np.where(far <= reach_cells, owner[row, column], -1)
    return nearest


def _skewness(image: Image, owner: NDArray[np.int64], n: int) -> Reals:
    """Return the skewness of the readings of each owner, in cm, shape (2, n)."""
    known = np.isfinite(image.values) if image.valid is None else image.valid
    row, column = np.nonzero((owner >= 0) & known & (image.values > 0.0))
    mine, weight = owner[row, column], image.values[row, column]

    def sums(values: Reals) -> Reals:
        return np.asarray(np.bincount(mine, weight * values, minlength=n), np.float64)

    total = sums(np.ones(weight.shape))
    total[total <= 0.0] = 1.0
    x, y = image.x_cm[column], image.y_cm[row]
    x, y = x - (sums(x) / total)[mine], y - (sums(y) / total)[mine]
    square = x * x + y * y
    spread = sums(square)
    spread[spread <= 0.0] = 1.0  # a single cell leans nowhere
    return np.stack([sums(x * square), sums(y * square)]) / spread
