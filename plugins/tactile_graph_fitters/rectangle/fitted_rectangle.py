"""``FittedRectangle``: a rectangle, and how well it fits."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar

from tactile_graph.wires import Rectangle
from tactile_graph_fitters.orientation.orientation import angle_std_rad
from tactile_graph_fitters.orientation.oriented import Oriented


@dataclass(frozen=True)
class FittedRectangle(Rectangle):
    """A rectangle fitted to points or to a load.

    ``misfit`` is what the method minimised, in its own unit (see there), per point or cell of the
    footprint; ``n_points`` counts these, ``iterations`` the method's rounds. ``ambiguous`` says
    that the sides are too alike for the angle to mean anything.
    """

    misfit: float
    n_points: int
    iterations: int = 0
    ambiguous: bool = False
    columns_shown: ClassVar[tuple[str, ...]] = (*Rectangle.columns_shown, "misfit", "ambiguous")


def rectangle_of(
    found: Oriented, misfit: float, n_points: int, iterations: int, cell_cm: float
) -> FittedRectangle:
    """Return the rectangle with these sides, and how well it fits as `FittedRectangle` says it.

    ``cell_cm``, the pitch of the elements that were read, tells whether it is ``ambiguous``.
    """
    place = found.longer_first()
    unclear = alike(place.first_cm, place.second_cm, cell_cm)
    return FittedRectangle(*place, float(misfit), n_points, iterations, unclear)


def alike(length_cm: float, breadth_cm: float, pitch_cm: float) -> bool:
    """Return whether sides read off cells of a pitch are too alike for an angle.

    That is where the angle's estimated error, of `orientation`, exceeds 0.35 rad (20 degrees).
    """
    return bool(angle_std_rad(length_cm, breadth_cm, pitch_cm) > 0.35)
