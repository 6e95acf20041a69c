"""``FittedEllipse``: an ellipse, and how well it fits."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import ClassVar

from tactile_graph.wires import Ellipse


@dataclass(frozen=True)
class FittedEllipse(Ellipse):
    """An ellipse fitted to points.

    ``rms_cm`` is the root mean square of the points' distances from the ellipse, as the method
    measures distance; ``iterations`` counts its rounds, 0 where it has a closed form.
    """

    rms_cm: float
    n_points: int
    iterations: int = 0
    columns_shown: ClassVar[tuple[str, ...]] = (*Ellipse.columns_shown, "rms_cm", "n_points")


def in_order(
    x_cm: float,
    y_cm: float,
    first_cm: float,
    second_cm: float,
    angle_rad: float,
    rms_cm: float,
    n_points: int,
    iterations: int,
) -> FittedEllipse:
    """Return the ellipse with half axes ``first_cm`` along the angle and ``second_cm`` across.

    Parameters
    ----------
    x_cm, y_cm : float
        Centre.
    first_cm, second_cm : float
        The two half axes, in either order of size.
    angle_rad : float
        Direction of the first, as seen; brought into (-pi/2, pi/2] for the longer one.
    rms_cm, n_points, iterations : float, int, int
        As in `FittedEllipse`.
    """
    if second_cm > first_cm:
        first_cm, second_cm, angle_rad = second_cm, first_cm, angle_rad + 0.5 * math.pi
    ellipse = object.__new__(FittedEllipse)
    # At once: a frozen dataclass sets its fields one by one. Plain references leave NumPy's floats.
    ellipse.__dict__.update(
        x_cm=float(x_cm),
        y_cm=float(y_cm),
        semi_major_cm=float(first_cm),
        semi_minor_cm=float(second_cm),
        angle_rad=axis_angle(angle_rad),
        rms_cm=float(rms_cm),
        n_points=n_points,
        iterations=iterations,
    )
    return ellipse


def axis_angle(angle_rad: float) -> float:
    """Return the angle of an axis, known up to half turns, brought into (-pi/2, pi/2]."""
    angle = math.remainder(angle_rad, math.pi)
    return angle if angle > -0.5 * math.pi else 0.5 * math.pi
