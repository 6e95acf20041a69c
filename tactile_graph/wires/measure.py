"""``Measure``: one thing about a shape that is held against the truth, beside its centre."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any, ClassVar, NamedTuple, Protocol

from tactile_graph.vocabulary import words_and_unit


def printed_angle_deg(angle_rad: float) -> float:
    """Return the axis angle in degrees, brought into (-90, 90]."""
    degrees = math.degrees(angle_rad) % 180.0
    return degrees - 180.0 if degrees > 90.0 else degrees


class Measure(NamedTuple):
    """One thing about a shape that is held against the truth.

    Attributes
    ----------
    field : str
        The number of it that a shape has, its unit in its name: ``length_cm``.
    off : callable, optional
        Returns how far a shape that was found is off from one that is true, in that unit; the
        difference of the two fields unless given.
    compared_as : str
        What comparisons call it, beside the same of other shapes; the field's words unless given.
    factor : float
        What comparisons take the error times: twice half an axis is an axis.
    """

    field: str
    off: Callable[[Any, Any], float] | None = None
    compared_as: str = ""
    factor: float = 1.0

    def error(self, found: Any, true: Any) -> float:
        """Return how far off a shape is, found less true."""
        if self.off is not None:
            return float(self.off(found, true))
        return float(getattr(found, self.field)) - float(getattr(true, self.field))

    @property
    def quantity(self) -> str:
        """What comparisons call it."""
        return self.compared_as or words_and_unit(self.field)[0]

    @property
    def unit(self) -> str:
        """Its unit as people write it."""
        return words_and_unit(self.field)[1]


class Measured(Protocol):
    """A shape of a plugin's own that can be true: it has a place and says how it is measured."""

    error_measures: ClassVar[tuple[Measure, ...]]

    @property
    def x_cm(self) -> float:
        """Its place, x."""

    @property
    def y_cm(self) -> float:
        """Its place, y."""


def axis_off_deg(found: Any, true: Any) -> float:
    """Return the angle between two axes: one has no head, so 179 degrees off is 1 degree off."""
    return printed_angle_deg(math.radians(float(found.angle_deg) - float(true.angle_deg)))
