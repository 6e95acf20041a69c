"""The shapes a localiser can answer with; positions in pad coordinates, angles as seen.

An angle is counter-clockwise from +x *as seen* on the pad; y runs down, so a direction with
angle a is ``(cos a, -sin a)`` in (x, y).
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Any, ClassVar

import numpy as np
from numpy.typing import NDArray

from tactile_graph.errors import shown
from tactile_graph.wires.measure import Measure, axis_off_deg
from tactile_graph.wires.measure import printed_angle_deg as printed_angle_deg
from tactile_graph.wires.native import NATIVE, native
from tactile_graph.wires.points import Points, quick_points


def _turned(
    u: NDArray[np.float64], v: NDArray[np.float64], x: float, y: float, angle_rad: float
) -> NDArray[np.float64]:
    cos, sin = math.cos(angle_rad), math.sin(angle_rad)
    return np.column_stack([x + u * cos - v * sin, y - u * sin - v * cos])


@dataclass(frozen=True)
class Circle:
    """A circle; also what a disc's footprint is."""

    x_cm: float
    y_cm: float
    radius_cm: float
    columns_shown: ClassVar[tuple[str, ...]] = ("x_cm", "y_cm", "radius_cm")
    error_measures: ClassVar[tuple[Measure, ...]] = (Measure("radius_cm"),)

    @property
    def area_cm2(self) -> float:
        """Enclosed area."""
        return math.pi * (self.radius_cm * self.radius_cm)  # a power would overflow

    def outline_cm(self, n: int = 90) -> NDArray[np.float64]:
        """Return ``n`` points of the outline, shape (n, 2), to draw."""
        t = np.linspace(0.0, 2.0 * np.pi, n, endpoint=False)
        u, v = self.radius_cm * np.cos(t), self.radius_cm * np.sin(t)
        return _turned(u, v, self.x_cm, self.y_cm, 0.0)


@dataclass(frozen=True)
class Ellipse:
    """An ellipse; ``angle_rad`` is that of the major axis."""

    x_cm: float
    y_cm: float
    semi_major_cm: float
    semi_minor_cm: float
    angle_rad: float
    columns_shown: ClassVar[tuple[str, ...]] = (
        "x_cm",
        "y_cm",
        "semi_major_cm",
        "semi_minor_cm",
        "angle_deg",
    )
    error_measures: ClassVar[tuple[Measure, ...]] = (
        Measure("semi_major_cm", compared_as="length", factor=2.0),
        Measure("semi_minor_cm", compared_as="breadth", factor=2.0),
        Measure("angle_deg", axis_off_deg),
    )

    @property
    def angle_deg(self) -> float:
        """Angle of the major axis in (-90, 90] degrees."""
        return printed_angle_deg(self.angle_rad)

    @property
    def area_cm2(self) -> float:
        """Enclosed area."""
        return math.pi * self.semi_major_cm * self.semi_minor_cm

    def outline_cm(self, n: int = 90) -> NDArray[np.float64]:
        """Return ``n`` points of the outline, shape (n, 2), to draw."""
        t = np.linspace(0.0, 2.0 * np.pi, n, endpoint=False)
        u, v = self.semi_major_cm * np.cos(t), self.semi_minor_cm * np.sin(t)
        return _turned(u, v, self.x_cm, self.y_cm, self.angle_rad)


@dataclass(frozen=True)
class Rectangle:
    """A rectangle; ``length_cm`` is the longer side, ``angle_rad`` its direction."""

    x_cm: float
    y_cm: float
    length_cm: float
    breadth_cm: float
    angle_rad: float
    columns_shown: ClassVar[tuple[str, ...]] = (
        "x_cm",
        "y_cm",
        "length_cm",
        "breadth_cm",
        "angle_deg",
    )
    error_measures: ClassVar[tuple[Measure, ...]] = (
        Measure("length_cm"),
        Measure("breadth_cm"),
        Measure("angle_deg", axis_off_deg),
    )

    @property
    def angle_deg(self) -> float:
        """Angle of the long side in (-90, 90] degrees."""
        return printed_angle_deg(self.angle_rad)

    @property
    def area_cm2(self) -> float:
        """Enclosed area."""
        return self.length_cm * self.breadth_cm

    def outline_cm(self, n: int = 4) -> NDArray[np.float64]:
        """Return the four corners, shape (4, 2); ``n`` is ignored."""
        u = 0.5 * self.length_cm * np.array([1.0, -1.0, -1.0, 1.0])
        v = 0.5 * self.breadth_cm * np.array([1.0, 1.0, -1.0, -1.0])
        return _turned(u, v, self.x_cm, self.y_cm, self.angle_rad)


@dataclass(frozen=True, eq=False)
class Polygon:
    """A simple polygon by its corners, shape (N, 2); the last joins the first."""

    xy_cm: NDArray[np.float64]
    columns_shown: ClassVar[tuple[str, ...]] = ("count", "x_cm", "y_cm", "area_cm2")
    error_measures: ClassVar[tuple[Measure, ...]] = (Measure("area_cm2"),)
    provides: ClassVar[Mapping[type, str]] = {Points: "points"}

    def __post_init__(self) -> None:
        if self.xy_cm.dtype not in NATIVE:
            object.__setattr__(self, "xy_cm", native(self.xy_cm))
        self.xy_cm.setflags(False)  # type: ignore[call-arg]  # by keyword it takes longer

    @property
    def points(self) -> Points:
        """The corners as points."""
        return quick_points(self.xy_cm)

    @property
    def count(self) -> int:
        """Number of corners."""
        return len(self.xy_cm)

    def _moments(self) -> tuple[float, float, float]:
        if self.count < 3:
            x, y = self.xy_cm.mean(axis=0) if self.count else (0.0, 0.0)
            return 0.0, float(x), float(y)
        x0, y0 = self.xy_cm[0]
        size = float(np.abs(self.xy_cm - self.xy_cm[0]).max()) or 1.0
        x, y = (self.xy_cm[:, 0] - x0) / size, (self.xy_cm[:, 1] - y0) / size
        xn, yn = np.roll(x, -1), np.roll(y, -1)
        cross = x * yn - xn * y
        area = 0.5 * float(cross.sum())
        if area == 0.0:
            return 0.0, float(self.xy_cm[:, 0].mean()), float(self.xy_cm[:, 1].mean())
        cx = size * float(((x + xn) * cross).sum()) / (6.0 * area)
        cy = size * float(((y + yn) * cross).sum()) / (6.0 * area)
        return area * size * size, float(x0) + cx, float(y0) + cy

    @property
    def area_cm2(self) -> float:
        """Enclosed area."""
        return abs(self._moments()[0])

    @property
    def x_cm(self) -> float:
        """Centroid, x."""
        return self._moments()[1]

    @property
    def y_cm(self) -> float:
        """Centroid, y."""
        return self._moments()[2]

    def outline_cm(self, n: int = 0) -> NDArray[np.float64]:
        """Return the corners, shape (N, 2); ``n`` is ignored."""
        return self.xy_cm


def quick_polygon(xy_cm: NDArray[np.float64]) -> Polygon:
    """Return ``Polygon(xy_cm)`` in half the time."""
    xy_cm.setflags(False)  # type: ignore[call-arg]
    polygon = _new(Polygon)
    polygon.__dict__["xy_cm"] = xy_cm
    return polygon


_new = object.__new__

Shape = Circle | Ellipse | Rectangle | Polygon


_SIZES = {
    Circle: ("radius_cm",),
    Ellipse: ("semi_major_cm", "semi_minor_cm", "angle_rad"),
    Rectangle: ("length_cm", "breadth_cm", "angle_rad"),
}


def check_true(shape: Any) -> None:
    """Check a shape that truly lay on a pad; those of plugins are taken as they are.

    Raises
    ------
    ValueError
        If its place or size is no finite number, or a size is less than 0.
    """
    for name in ("x_cm", "y_cm", *sizes) if (sizes := _SIZES.get(type(shape))) else ():
        value = getattr(shape, name)
        try:
            finite = math.isfinite(value)
        except TypeError:
            finite = False
        if not finite or (value < 0.0 and name not in ("x_cm", "y_cm", "angle_rad")):
            must = "a finite number" if not finite else "at least 0"
            kind = type(shape).__name__
            raise ValueError(f"a true {kind}: {name} must be {must}, got {shown(value)}")


def longer_side_first(shape: Any) -> Any:
    """Return the same rectangle or ellipse with its longer side, or axis, as the first.

    Other shapes, and those of plugins, are left as they are.
    """
    if type(shape) is Rectangle and shape.length_cm < shape.breadth_cm:
        long, short = shape.breadth_cm, shape.length_cm
        turned = shape.angle_rad + math.pi / 2
        return replace(shape, length_cm=long, breadth_cm=short, angle_rad=turned)
    if type(shape) is Ellipse and shape.semi_major_cm < shape.semi_minor_cm:
        long, short = shape.semi_minor_cm, shape.semi_major_cm
        turned = shape.angle_rad + math.pi / 2
        return replace(shape, semi_major_cm=long, semi_minor_cm=short, angle_rad=turned)
    return shape
