"""Step ``align_contacts``: contacts in the coordinates of another sensor."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from tactile_graph_filters.contacts import Contact, Contacts

Pair = tuple[float, float]


class AlignContacts:
    """Move the centres of contacts by a fixed affine map.

    What one sensor calls (3, 4) another, mounted by hand, calls (3.1, 3.9); the map is found
    once from places both have seen. Areas and images stay as they are.

    Parameters
    ----------
    shift_cm : (float, float)
        Added to x and to y.
    matrix : ((float, float), (float, float))
        Its first row gives x, its second y, each of the old (x, y).

    Raises
    ------
    ValueError
        If the matrix turns the pad into a line, or something is not finite.
    """

    stateless = True

    def __init__(
        self, *, shift_cm: Pair = (0.0, 0.0), matrix: tuple[Pair, Pair] = ((1.0, 0.0), (0.0, 1.0))
    ) -> None:
        (self._xx, self._xy), (self._yx, self._yy) = matrix
        self._x_cm, self._y_cm = shift_cm
        if not (np.isfinite(matrix).all() and np.isfinite(shift_cm).all()):
            raise ValueError(f"shift_cm and matrix must be finite, got {shift_cm} and {matrix}")
        if self._xx * self._yy == self._xy * self._yx:
            raise ValueError(f"matrix must not turn the pad into a line, got {matrix}")

    def __call__(self, contacts: Sequence[Contact]) -> Contacts:
        """Return the contacts with their centres moved."""
        found = tuple([self._moved(c) for c in contacts])
        return Contacts(found, len(found))

    def _moved(self, c: Contact) -> Contact:
        x_cm, y_cm = self._of(c.x_cm, c.y_cm)
        at_x_cm, at_y_cm = self._of(c.centroid_x_cm, c.centroid_y_cm)
        return replace(c, x_cm=x_cm, y_cm=y_cm, centroid_x_cm=at_x_cm, centroid_y_cm=at_y_cm)

    def _of(self, x: float, y: float) -> Pair:
        return (
            self._xx * x + self._xy * y + self._x_cm,
            self._yx * x + self._yy * y + self._y_cm,
        )
