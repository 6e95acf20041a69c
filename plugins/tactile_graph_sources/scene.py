"""``Scene``: the objects that lie on a simulated pad, read from YAML or from a mapping."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Annotated, Any, ClassVar, Literal

import numpy as np
from annotated_types import Ge, Gt, Le, Len
from numpy.typing import NDArray
from pydantic import Field

from tactile_graph.plugins.registry import installed
from tactile_graph.wires import Circle, Ellipse, Polygon, Rectangle, Shape
from tactile_graph_pads.contact import Grain
from tactile_graph_pads.pad import read_file
from tactile_graph_pads.records import inline, read_record

Place = Literal["random"] | tuple[float, float]
Angle = Literal["random"] | float
Length = Annotated[float, Gt(0), Le(1e6)]
Grams = Annotated[float, Ge(0)]


@dataclass(frozen=True, kw_only=True)
class Thing:
    """What every object has, whatever its shape.

    Parameters
    ----------
    weight_g : float
        Its own weight.
    place : "random" or (float, float)
        Its centre, x and y in cm; random places keep it fully on the pad and off the others.
    name : str
        What it is called in the truth.
    stacked_g : tuple of float
        Weights piled on top.
    stack_offset_cm : float
        Standard deviation, along x and y, of where each stacked weight stands.
    touches : float
        Share of its size that touches the pad, about its centre: of a rectangle's length, of any
        other's size both ways. The truth keeps the whole.
    """

    weight_g: Grams
    place: Place = "random"
    name: str = ""
    stacked_g: tuple[Grams, ...] = ()
    stack_offset_cm: Annotated[float, Ge(0)] = 0.0
    touches: Annotated[float, Gt(0), Le(1)] = 1.0
    key_hints: ClassVar[dict[str, str]] = dict.fromkeys(
        ("x_cm", "y_cm", "x", "y", "centre_cm", "position"), "its centre is place: [x, y], in cm"
    )
    __pydantic_config__: ClassVar[dict[str, str]] = {"extra": "forbid"}

    @property
    def total_g(self) -> float:
        """Its weight with all that is stacked on it."""
        return self.weight_g + sum(self.stacked_g)

    def footprint(self, x_cm: float, y_cm: float, angle_rad: float) -> Shape:
        """Return its outline at a place."""
        raise NotImplementedError

    def touching(self, shape: Shape) -> Shape:
        """Return the part of its outline that touches the pad.

        Parameters
        ----------
        shape : Circle, Ellipse, Rectangle or Polygon
            Where it lies, as `footprint` gives it.
        """
        return shape if self.touches == 1.0 else _about_centre(shape, self.touches)


def _about_centre(shape: Shape, share: float) -> Shape:
    """Return a shape of so much of the size, a rectangle of so much of the length."""
    if isinstance(shape, Circle):
        return replace(shape, radius_cm=share * shape.radius_cm)
    if isinstance(shape, Rectangle):
        along, across = share * shape.length_cm, shape.breadth_cm
        if along >= across:
            return replace(shape, length_cm=along)
        turned = math.remainder(shape.angle_rad + 0.5 * math.pi, math.pi)
        return replace(shape, length_cm=across, breadth_cm=along, angle_rad=turned)
    if isinstance(shape, Ellipse):
        major, minor = share * shape.semi_major_cm, share * shape.semi_minor_cm
        return replace(shape, semi_major_cm=major, semi_minor_cm=minor)
    centre = np.array([shape.x_cm, shape.y_cm])
    return Polygon(centre + share * (shape.xy_cm - centre))


@dataclass(frozen=True, kw_only=True)
class Disc(Thing):
    """A disc.

    Parameters
    ----------
    shape : "disc"
    radius_cm : float
        Its radius.
    """

    shape: Literal["disc"] = "disc"
    radius_cm: Length
    angle_deg: ClassVar[Angle] = 0.0

    def footprint(self, x_cm: float, y_cm: float, angle_rad: float) -> Shape:
        """Return its circle at a place."""
        return Circle(x_cm, y_cm, self.radius_cm)


@dataclass(frozen=True, kw_only=True)
class Slab(Thing):
    """A rectangle.

    Parameters
    ----------
    shape : "rectangle"
    length_cm, breadth_cm : float
        Its sides; the length is the longer one.
    angle_deg : "random" or float
        Of its length, counter-clockwise from x as seen; drawn anew at each placement by default.
    """

    shape: Literal["rectangle"] = "rectangle"
    length_cm: Length
    breadth_cm: Length
    angle_deg: Angle = "random"

    def __post_init__(self) -> None:
        if self.breadth_cm > self.length_cm:
            raise ValueError(
                f"length_cm is the longer side, got {self.length_cm:g} by {self.breadth_cm:g}"
            )

    def footprint(self, x_cm: float, y_cm: float, angle_rad: float) -> Shape:
        """Return its rectangle at a place."""
        return Rectangle(x_cm, y_cm, self.length_cm, self.breadth_cm, angle_rad)


@dataclass(frozen=True, kw_only=True)
class Oval(Thing):
    """An ellipse.

    Parameters
    ----------
    shape : "ellipse"
    semi_major_cm, semi_minor_cm : float
        Its half axes; the major one is the longer.
    angle_deg : "random" or float
        Of its major axis, counter-clockwise from x as seen; drawn anew at each placement by
        default.
    """

    shape: Literal["ellipse"] = "ellipse"
    semi_major_cm: Length
    semi_minor_cm: Length
    angle_deg: Angle = "random"

    def __post_init__(self) -> None:
        if self.semi_minor_cm > self.semi_major_cm:
            raise ValueError(
                f"semi_major_cm is the longer half axis, got {self.semi_major_cm:g} and "
                f"{self.semi_minor_cm:g}"
            )

    def footprint(self, x_cm: float, y_cm: float, angle_rad: float) -> Shape:
        """Return its ellipse at a place."""
        return Ellipse(x_cm, y_cm, self.semi_major_cm, self.semi_minor_cm, angle_rad)


@dataclass(frozen=True, kw_only=True)
class Plate(Thing):
    """A polygon: regular, by ``sides`` and ``radius_cm`` to its corners, or by ``corners_cm``.

    Parameters
    ----------
    shape : "polygon"
    corners_cm : tuple of (float, float), optional
        Its corners, (x right, y down) in order; their centroid comes to lie at the place.
    sides : int, optional
        Number of sides of a regular polygon.
    radius_cm : float, optional
        From the centre of a regular polygon to its corners.
    angle_deg : "random" or float
        How far it is turned, counter-clockwise as seen; drawn anew at each placement by default.
    """

    shape: Literal["polygon"] = "polygon"
    corners_cm: Annotated[tuple[tuple[float, float], ...], Len(3)] | None = None
    sides: Annotated[int, Ge(3)] | None = None
    radius_cm: Length | None = None
    angle_deg: Angle = "random"

    def __post_init__(self) -> None:
        regular = self.sides is not None and self.radius_cm is not None
        if regular == (self.corners_cm is not None):
            raise ValueError("a polygon takes either corners_cm or both sides and radius_cm")
        if Polygon(self._corners.copy()).area_cm2 == 0.0:
            raise ValueError("corners_cm: all corners lie on one line")

    @property
    def _corners(self) -> NDArray[np.float64]:
        if self.corners_cm is not None:
            return np.array(self.corners_cm, dtype=np.float64)
        assert self.sides is not None
        assert self.radius_cm is not None
        turns = 2.0 * np.pi * np.arange(self.sides) / self.sides
        return self.radius_cm * np.column_stack([np.cos(turns), -np.sin(turns)])

    def footprint(self, x_cm: float, y_cm: float, angle_rad: float) -> Shape:
        """Return its polygon at a place, turned about its centroid."""
        corners = self._corners
        centre = Polygon(corners.copy())
        u, v = (corners - (centre.x_cm, centre.y_cm)).T
        cos, sin = math.cos(angle_rad), math.sin(angle_rad)
        return Polygon(np.column_stack([x_cm + u * cos + v * sin, y_cm - u * sin + v * cos]))


Object = Annotated[Disc | Slab | Oval | Plate, Field(discriminator="shape")]


@dataclass(frozen=True)
class Scene:
    """What lies on the pad.

    Parameters
    ----------
    about : str
        One line for people.
    objects : tuple of objects
        All on the pad together.
    in_turn : tuple of tuples of objects
        One group after the other instead, and round again.
    hold : int
        Frames for which each placement stays as it is; only the readings differ.
    apart_cm : float
        Least distance between objects placed at random, and from objects placed before.
    sand : tuple of Grain
        Grains of sand under single elements.
    foam_cm : float, optional
        Width of a foam pad on the array; the pad's own by default.
    """

    about: str = ""
    objects: tuple[Object, ...] = ()
    in_turn: tuple[tuple[Object, ...], ...] = ()
    hold: Annotated[int, Ge(1)] = 1
    apart_cm: Annotated[float, Ge(0)] = 0.0
    sand: tuple[Grain, ...] = ()
    foam_cm: Annotated[float, Ge(0)] | None = None
    __pydantic_config__: ClassVar[dict[str, str]] = {"extra": "forbid"}

    def __post_init__(self) -> None:
        if self.objects and self.in_turn:
            raise ValueError("a scene takes objects or in_turn, not both")

    def group(self, placement: int) -> tuple[Disc | Slab | Oval | Plate, ...]:
        """Return the objects of a placement, counted from 0."""
        return self.in_turn[placement % len(self.in_turn)] if self.in_turn else self.objects


def load_scene(scene: str | Mapping[str, Any]) -> Scene:
    """Return a scene by its name, by its YAML file, or from a mapping.

    Parameters
    ----------
    scene : str or mapping
        A name has no ending.

    Raises
    ------
    UsageError
        If no such scene or file is there.
    RecordError
        With everything wrong with it.
    """
    if isinstance(scene, Mapping):
        return read_record(inline(scene, "scene"), Scene, "a scene")
    path = Path(scene)
    if path.suffix not in (".yaml", ".yml"):
        path = installed().path("scenes", scene)
    return read_record(read_file(path, "scene"), Scene, "a scene")
