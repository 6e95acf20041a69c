"""Step ``align_contacts``: contacts in the coordinates of another sensor."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from tactile_graph_filters.contacts.contacts import Contact, Contacts, contacts_of

LARGEST_LOG = 709.0
"""Beyond this no exponential is a number."""
Pair = tuple[float, float]
Six = tuple[float, float, float, float, float, float]


class AlignContacts:
    """Move the centres of contacts by a fixed affine map, and scale their areas by place.

    What one sensor calls (3, 4) another, mounted by hand, calls (3.1, 3.9), and a lamp at one
    edge makes contacts there look wide to a camera; the maps are found once from places both
    have seen. Images stay as they are.

    Parameters
    ----------
    shift_cm : (float, float)
        Added to x and to y.
    matrix : ((float, float), (float, float))
        Its first row gives x, its second y, each of the old (x, y).
    log_area : tuple of 6 floats
        Natural logarithm of the factor on the area, as coefficients of 1, x, y, x², x y, y² at
        the old centre in cm.

    Raises
    ------
    ValueError
        If the matrix turns the pad into a line, or something is not finite.
    """

    stateless = True

    def __init__(
        self,
        *,
        shift_cm: Pair = (0.0, 0.0),
        matrix: tuple[Pair, Pair] = ((1.0, 0.0), (0.0, 1.0)),
        log_area: Six = (0.0, 0.0, 0.0, 0.0, 0.0, 0.0),
    ) -> None:
        (self._xx, self._xy), (self._yx, self._yy) = matrix
        self._x_cm, self._y_cm = shift_cm
        self._log_area = log_area
        if not (np.isfinite(matrix).all() and np.isfinite([*shift_cm, *log_area]).all()):
            raise ValueError(
                "shift_cm, matrix and log_area must be finite, "
                f"got {shift_cm}, {matrix} and {log_area}"
            )
        if self._xx * self._yy == self._xy * self._yx:
            raise ValueError(f"matrix must not turn the pad into a line, got {matrix}")

    def __call__(self, contacts: Sequence[Contact]) -> Contacts:
        """Return the contacts with their centres moved and their areas scaled.

        Raises
        ------
        DataError
            If the area or a place of one is then not finite.
        """
        return contacts_of([self._moved(c) for c in contacts])

    def _moved(self, c: Contact) -> Contact:
        x_cm, y_cm = self._of(c.x_cm, c.y_cm)
        at_x_cm, at_y_cm = self._of(c.centroid_x_cm, c.centroid_y_cm)
        x, y = c.x_cm, c.y_cm
        of_one, of_x, of_y, of_xx, of_xy, of_yy = self._log_area
        growth = of_one + of_x * x + of_y * y + of_xx * x * x + of_xy * x * y + of_yy * y * y
        return replace(
            c,
            area_cm2=c.area_cm2 * (math.exp(growth) if growth < LARGEST_LOG else math.inf),
            x_cm=x_cm,
            y_cm=y_cm,
            centroid_x_cm=at_x_cm,
            centroid_y_cm=at_y_cm,
        )

    def _of(self, x: float, y: float) -> Pair:
        return (
            self._xx * x + self._xy * y + self._x_cm,
            self._yx * x + self._yy * y + self._y_cm,
        )
