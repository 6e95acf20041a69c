"""``FittedCircle``: a circle, and how well it fits."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar, NamedTuple

from tactile_graph.wires import Circle


class CircleParts(NamedTuple):
    """A fitted circle, as machine code hands it on: what `FittedCircle.quickly` takes."""

    x_cm: float
    y_cm: float
    radius_cm: float
    rms_cm: float
    n_points: int
    iterations: int


@dataclass(frozen=True)
class FittedCircle(Circle):
    """A circle fitted to points.

    ``rms_cm`` is the root mean square of the points' distances from the circle, whatever the
    method minimised; ``iterations`` counts its rounds, 0 where it has a closed form.
    """

    rms_cm: float
    n_points: int
    iterations: int = 0
    columns_shown: ClassVar[tuple[str, ...]] = (
        "x_cm",
        "y_cm",
        "radius_cm",
        "rms_cm",
        "n_points",
    )

    @classmethod
    def quickly(
        cls,
        x_cm: float,
        y_cm: float,
        radius_cm: float,
        rms_cm: float,
        n_points: int,
        iterations: int,
    ) -> FittedCircle:
        """Return the same record, made at once: a frozen dataclass sets its fields one by one."""
        circle = object.__new__(cls)
        fields = circle.__dict__
        fields["x_cm"] = x_cm
        fields["y_cm"] = y_cm
        fields["radius_cm"] = radius_cm
        fields["rms_cm"] = rms_cm
        fields["n_points"] = n_points
        fields["iterations"] = iterations
        return circle
