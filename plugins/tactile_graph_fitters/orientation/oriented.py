"""``Oriented``: centre, two extents and an angle, as fits of ellipses and rectangles find them."""

from __future__ import annotations

import math
from typing import NamedTuple


class Oriented(NamedTuple):
    """Where an ellipse or a rectangle lies, as a method found it.

    Parameters
    ----------
    x_cm, y_cm : float
        Centre.
    first_cm, second_cm : float
        The two half axes of an ellipse or the two sides of a rectangle, in either order of size.
    angle_rad : float
        Direction of the first, as seen, known up to half turns.
    """

    x_cm: float
    y_cm: float
    first_cm: float
    second_cm: float
    angle_rad: float

    def longer_first(self) -> Oriented:
        """Return the same with the longer one first, the angle brought into (-pi/2, pi/2]."""
        x, y, first, second, angle = self
        if second > first:
            first, second, angle = second, first, angle + 0.5 * math.pi
        # Plain references leave NumPy's own floats.
        return Oriented(float(x), float(y), float(first), float(second), axis_angle(angle))


def axis_angle(angle_rad: float) -> float:
    """Return the angle of an axis, known up to half turns, brought into (-pi/2, pi/2]."""
    angle = math.remainder(angle_rad, math.pi)
    return angle if angle > -0.5 * math.pi else 0.5 * math.pi
