"""``FittedRectangle``: a rectangle, and how well it fits."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import ClassVar

from tactile_graph.wires import Rectangle
from tactile_graph_fitters.ellipse.fitted_ellipse import axis_angle
from tactile_graph_fitters.orientation.orientation import angle_std_rad


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
    x_cm: float,
    y_cm: float,
    first_cm: float,
    second_cm: float,
    angle_rad: float,
    misfit: float,
    n_points: int,
    iterations: int,
    cell_cm: float,
) -> FittedRectangle:
    """Return the rectangle with sides ``first_cm`` along the angle and ``second_cm`` across.

    Parameters
    ----------
    x_cm, y_cm : float
        Centre.
    first_cm, second_cm : float
        The two sides, in either order of size.
    angle_rad : float
        Direction of the first, as seen; brought into (-pi/2, pi/2] for the longer one.
    misfit, n_points, iterations : float, int, int
        As in `FittedRectangle`.
    cell_cm : float
        Pitch of the elements that were read, for ``ambiguous``.
    """
    if second_cm > first_cm:
        first_cm, second_cm, angle_rad = second_cm, first_cm, angle_rad + 0.5 * math.pi
    # Plain references leave NumPy's own floats.
    length, breadth = float(first_cm), float(second_cm)
    return FittedRectangle(
        float(x_cm),
        float(y_cm),
        length,
        breadth,
        axis_angle(angle_rad),
        float(misfit),
        n_points,
        iterations,
        alike(length, breadth, cell_cm),
    )


def alike(length_cm: float, breadth_cm: float, pitch_cm: float) -> bool:
    """Return whether sides read off cells of a pitch are too alike for an angle.

    That is where the angle's estimated error, of `orientation`, exceeds 0.35 rad (20 degrees).
    """
    return bool(angle_std_rad(length_cm, breadth_cm, pitch_cm) > 0.35)
