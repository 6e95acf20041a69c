"""Step ``pick_contact``: the largest contact, or the nth, by itself."""

from __future__ import annotations

from typing import Annotated, Literal

from annotated_types import Ge

from tactile_graph.errors import Skip
from tactile_graph_filters.contacts.contacts import Contact, contacts_of


def pick_contact(
    contacts: list[Contact],
    *,
    rank: Annotated[int, Ge(1)] = 1,
    by: Literal["load", "area_cm2", "peak", "number"] = "load",
) -> Contact:
    """Return the contact of a rank: the one with most load, with second most, and so on.

    Parameters
    ----------
    contacts : list of Contact
    rank : int
        1 for the largest.
    by : str
        What they are ranked by, the largest first; by ``number`` they stay in their order.

    Returns
    -------
    Contact
        A port that takes a mask or an image takes it as such.

    Raises
    ------
    Skip
        If there are fewer contacts.
    DataError
        If the area or a place of a contact is not finite.
    """
    if len(contacts) < rank:
        raise Skip(f"there are {len(contacts)} contacts, none of rank {rank}")
    contacts = list(contacts_of(contacts).contacts)
    if by == "number":
        return contacts[rank - 1]
    ranked = sorted(contacts, key=lambda contact: (-getattr(contact, by), contact.number))
    return ranked[rank - 1]
