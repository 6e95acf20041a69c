"""``FittedRectangle``: a rectangle, and how well it fits."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import ClassVar

from tactile_graph.wires import Rectangle
from tactile_graph_fitters.fitted_ellipse import axis_angle
from tactile_graph_fitters.orientation import angle_std_rad


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


def sides_in_order(
    first_cm: float, second_cm: float, angle_rad: float
) -> tuple[float, float, float]:
    """Return length, breadth and the length's angle in (-pi/2, pi/2] of two sides in any order.

    Parameters
    ----------
    first_cm, second_cm : float
    angle_rad : float
        Direction of the first side.
    """
    if second_cm > first_cm:
        return second_cm, first_cm, axis_angle(angle_rad + 0.5 * math.pi)
    return first_cm, second_cm, axis_angle(angle_rad)


def alike(length_cm: float, breadth_cm: float, pitch_cm: float) -> bool:
    """Return whether sides read off cells of a pitch are too alike for an angle.

    That is where the angle's estimated error, of `orientation`, exceeds 0.35 rad (20 degrees).
    """
    return angle_std_rad(length_cm, breadth_cm, pitch_cm) > 0.35
