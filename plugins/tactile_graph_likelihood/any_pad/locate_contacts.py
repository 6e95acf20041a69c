"""``locate_contacts``: one object for each contact, on any pad."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Annotated, NamedTuple

import numpy as np
from annotated_types import Len

from tactile_graph.errors import Degenerate
from tactile_graph_filters.contacts.contacts import Contact
from tactile_graph_likelihood.any_pad.choose import Locate, Name
from tactile_graph_likelihood.any_pad.locate import ANY_PAD, AnyPadSettings
from tactile_graph_likelihood.any_pad.observation.observed import NearlySquare
from tactile_graph_likelihood.any_pad.uncertainty.ghosts import tells_of_ghosts
from tactile_graph_likelihood.single.likely import Likely
from tactile_graph_likelihood.single.readings import Readings


class LocatedContacts(NamedTuple):
    """The outlines of contacts, those of most cells first, and how many there are."""

    shapes: tuple[Likely, ...]
    names: tuple[str, ...]
    count: int  # type: ignore[assignment]  # hides tuple.count, which nobody asks a record for


class LocateContacts:
    """Return an outline for each contact of a footprint, on a pad that need not be as it is told.

    Parameters
    ----------
    shapes : list
        The shapes to choose from for each, equally likely beforehand.
    settings : LocateSettings

    Notes
    -----
    Cells of other contacts say nothing of a contact; what shows beyond all of them may be a stray.
    A contact that no shape explains is left out. None fits where rows and columns of several seem
    to make ghosts, as on a matrix without isolation. See `locate_disc` for what is estimated.
    """

    stateless = True
    notice = staticmethod(tells_of_ghosts)

    def __init__(
        self,
        *,
        shapes: Annotated[list[Name], Len(1)] = ["disc", "ellipse", "rectangle"],  # noqa: B006
        settings: AnyPadSettings = ANY_PAD,
    ) -> None:
        self._locate = Locate(shapes=shapes, settings=settings)

    def __call__(self, image: NearlySquare, contacts: Sequence[Contact]) -> LocatedContacts:
        """Return the outlines.

        Parameters
        ----------
        image : Image
            All readings, that rise with load, in any quantity.
        contacts : sequence of Contact
            On the same grid.

        Raises
        ------
        RuleError
            If the image's cells are not nearly square, or a pad was learned, of another shape,
            pitch or quantity.
        Degenerate
            If nothing rises above the noise.
        """
        readings = self._locate.readings(image)
        owner = np.zeros(readings.states.shape, np.int64)
        for k, contact in enumerate(contacts, 1):
            top, bottom, left, right = contact.box
            owner[top:bottom, left:right][contact.mask.values] = k
        found = []
        for k in sorted(range(len(contacts)), key=lambda k: -contacts[k].n_cells):
            try:
                found.append(self._locate.chosen(alone(readings, owner, k + 1)))
            except Degenerate:
                continue
        found = self._locate.placed(image, found)
        shapes, names = tuple(f.shape for f in found), tuple(f.name for f in found)
        return LocatedContacts(shapes, names, len(found))


def alone(readings: Readings, owner: np.ndarray, number: int) -> Readings:
    """Return readings in which other contacts' cells say nothing.

    Raises
    ------
    Degenerate
        If none of the contact's own shows.
    """
    others = (owner > 0) & (owner != number)
    its = readings.without(others)
    if not its.touched:
        raise Degenerate(f"contact {number}: no reading rises above the noise")
    return its
