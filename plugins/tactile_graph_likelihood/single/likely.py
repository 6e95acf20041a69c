"""Shapes with their uncertainty: what a fit by likelihood answers with.

The shape is the posterior mean. ``fits`` says whether the frame looks like the model's at all;
``surprise`` is the number behind it, about normal where it does.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, fields, is_dataclass
from typing import Any, ClassVar

import numpy as np

from tactile_graph.wires import Circle, Ellipse, Polygon, Rectangle, Shape
from tactile_graph_likelihood.geometry.outlines import unpacked
from tactile_graph_likelihood.single.posterior import Posterior

SHOWN = ("centre_std_cm", "log_evidence", "surprise", "fits")


class _Likely:
    """What all of them tell of their posterior; two are equal where all that they hold is."""

    posterior: Posterior

    def __eq__(self, other: object) -> bool:
        if other.__class__ is not self.__class__:
            return NotImplemented
        return _hold_the_same(self, other)

    def __hash__(self) -> int:
        shape: Any = self
        return hash((self.__class__, shape.x_cm, shape.y_cm))

    @property
    def centre_std_cm(self) -> float:
        """Root mean square distance of the centre from its mean."""
        return self.posterior.centre_std_cm

    @property
    def log_evidence(self) -> float:
        """As in `Posterior`."""
        return self.posterior.log_evidence

    @property
    def surprise(self) -> float:
        """As in `Posterior`."""
        return self.posterior.surprise

    @property
    def fits(self) -> bool:
        """As in `Posterior`."""
        return self.posterior.fits


def _hold_the_same(one: Any, other: Any) -> bool:
    if one.__class__ is not other.__class__:
        return False
    if not is_dataclass(one):
        return np.array_equal(one, other)
    return all(_hold_the_same(getattr(one, f.name), getattr(other, f.name)) for f in fields(one))


@dataclass(frozen=True, eq=False)
class LikelyCircle(_Likely, Circle):
    """The posterior mean of a disc."""

    posterior: Posterior
    columns_shown: ClassVar[tuple[str, ...]] = (*Circle.columns_shown, "radius_std_cm", *SHOWN)

    @property
    def radius_std_cm(self) -> float:
        """Posterior standard deviation of the radius."""
        return self.posterior.std(2)


class _Turned(_Likely):
    """What has two sizes and an angle."""

    @property
    def angle_std_deg(self) -> float:
        """Posterior standard deviation of the angle, in degrees."""
        return math.degrees(self.posterior.std(4))

    def _size_std_cm(self, shorter: bool) -> float:
        mean = self.posterior.mean
        return self.posterior.std(3 if (mean[3] > mean[2]) != shorter else 2)


@dataclass(frozen=True, eq=False)
class LikelyRectangle(_Turned, Rectangle):
    """The posterior mean of a rectangle."""

    posterior: Posterior
    columns_shown: ClassVar[tuple[str, ...]] = (
        *Rectangle.columns_shown, "length_std_cm", "breadth_std_cm", "angle_std_deg", *SHOWN,
    )  # fmt: skip

    @property
    def length_std_cm(self) -> float:
        """Posterior standard deviation of the length."""
        return 2.0 * self._size_std_cm(shorter=False)

    @property
    def breadth_std_cm(self) -> float:
        """Posterior standard deviation of the breadth."""
        return 2.0 * self._size_std_cm(shorter=True)


@dataclass(frozen=True, eq=False)
class LikelyEllipse(_Turned, Ellipse):
    """The posterior mean of an ellipse."""

    posterior: Posterior
    columns_shown: ClassVar[tuple[str, ...]] = (
        *Ellipse.columns_shown, "semi_major_std_cm", "semi_minor_std_cm", "angle_std_deg", *SHOWN,
    )  # fmt: skip

    @property
    def semi_major_std_cm(self) -> float:
        """Posterior standard deviation of the longer half axis."""
        return self._size_std_cm(shorter=False)

    @property
    def semi_minor_std_cm(self) -> float:
        """Posterior standard deviation of the shorter half axis."""
        return self._size_std_cm(shorter=True)


@dataclass(frozen=True, eq=False)
class LikelyPolygon(_Likely, Polygon):
    """The polygon of a regular one's mean numbers, or of a free one's mean corners."""

    posterior: Posterior
    columns_shown: ClassVar[tuple[str, ...]] = (*Polygon.columns_shown, *SHOWN)


Likely = LikelyCircle | LikelyEllipse | LikelyRectangle | LikelyPolygon


_BY_SHAPE: dict[type[Shape], Callable[..., Likely]] = {
    Circle: LikelyCircle,
    Ellipse: LikelyEllipse,
    Rectangle: LikelyRectangle,
    Polygon: LikelyPolygon,
}


def likely(posterior: Posterior) -> Likely:
    """Return the shape of a posterior's mean."""
    shape = unpacked(posterior.kind, posterior.corners, posterior.mean)
    return _BY_SHAPE[type(shape)](**vars(shape), posterior=posterior)
