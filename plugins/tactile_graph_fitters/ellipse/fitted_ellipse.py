"""``FittedEllipse``: an ellipse, and how well it fits."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar

from tactile_graph.wires import Ellipse
from tactile_graph_fitters.orientation.oriented import Oriented

ROUND = 1e-9
"""Part of a half axis by which the other may differ on a circle: rounding gives it some angle."""


@dataclass(frozen=True)
class FittedEllipse(Ellipse):
    """An ellipse fitted to points.

    ``rms_cm`` is the root mean square of the points' distances from the ellipse, as the method
    measures distance; ``iterations`` counts its rounds, 0 where it has a closed form. Half axes
    that differ by rounding alone are a circle's: their angle is 0.
    """

    rms_cm: float
    n_points: int
    iterations: int = 0
    columns_shown: ClassVar[tuple[str, ...]] = (*Ellipse.columns_shown, "rms_cm", "n_points")


def ellipse_of(found: Oriented, rms_cm: float, n_points: int, iterations: int) -> FittedEllipse:
    """Return the ellipse with these half axes, and how well it fits as `FittedEllipse` says it."""
    x_cm, y_cm, semi_major_cm, semi_minor_cm, angle_rad = found.longer_first()
    if semi_major_cm - semi_minor_cm <= ROUND * semi_major_cm:
        angle_rad = 0.0
    ellipse = object.__new__(FittedEllipse)
    # At once: a frozen dataclass sets its fields one by one.
    ellipse.__dict__.update(
        x_cm=x_cm,
        y_cm=y_cm,
        semi_major_cm=semi_major_cm,
        semi_minor_cm=semi_minor_cm,
        angle_rad=angle_rad,
        rms_cm=float(rms_cm),
        n_points=n_points,
        iterations=iterations,
    )
    return ellipse
