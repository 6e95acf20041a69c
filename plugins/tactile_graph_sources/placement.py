"""Put a scene's objects down: fully on the pad, apart from each other."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from tactile_graph.errors import UsageError
from tactile_graph.wires import Circle, Rectangle, Shape
from tactile_graph_pads.geometry import Geometry
from tactile_graph_sources.scene import Scene, Thing

MOST_TRIES = 2000
"""For one object, before all are taken off the pad again."""
MOST_STARTS = 10
"""With an empty pad, before the scene is given up."""
_TURNS = np.linspace(0.0, 2.0 * np.pi, 360, endpoint=False)
_DIRECTIONS = np.stack([np.cos(_TURNS), np.sin(_TURNS)])


class _CrowdedError(UsageError):
    """An object found no place among those before it; with others there it might."""


def place(
    things: Sequence[Thing], geometry: Geometry, apart_cm: float, rng: np.random.Generator
) -> list[Shape]:
    """Return each object's outline, in order.

    Parameters
    ----------
    things : sequence of Thing
    geometry : Geometry
        Gives the size of the pad.
    apart_cm : float
        Least distance between objects where one is placed at random.
    rng : numpy.random.Generator

    Raises
    ------
    UsageError
        If an object cannot come to lie on the pad, or not apart from those before it.

    Notes
    -----
    Objects are placed one after another, each anywhere where it fits. Where one finds no place
    left, the whole scene starts anew with the draws that follow: a scene whose first start
    succeeds takes the same draws as ever.
    """
    for start in range(MOST_STARTS):
        shapes: list[Shape] = []
        try:
            for number, thing in enumerate(things):
                shapes.append(_place_one(number, thing, shapes, geometry, apart_cm, rng))
            break
        except _CrowdedError:
            if start == MOST_STARTS - 1:
                raise
    return shapes


def _place_one(
    number: int,
    thing: Thing,
    others: list[Shape],
    geometry: Geometry,
    apart_cm: float,
    rng: np.random.Generator,
) -> Shape:
    if not isinstance(thing.place, str):
        return thing.footprint(*thing.place, _angle_rad(thing, rng))
    low = high = None
    for _ in range(MOST_TRIES):
        angle_rad = _angle_rad(thing, rng)
        low, high = _room(thing.footprint(0.0, 0.0, angle_rad), geometry)
        if (low > high).any():
            continue
        x_cm, y_cm = rng.uniform(low, high)
        shape = thing.footprint(float(x_cm), float(y_cm), angle_rad)
        if all(are_apart(shape, other, apart_cm) for other in others):
            return shape
    label = _label(number, thing)
    if low is None or high is None or (low > high).any():
        width, height = geometry.size_cm
        raise UsageError(f"{label} does not fit on the pad of {width:g} by {height:g} cm")
    raise _CrowdedError(
        f"{label} found no place {apart_cm:g} cm apart from the {len(others)} before it "
        f"in {MOST_TRIES} tries, nor after starting anew {MOST_STARTS - 1} times"
    )


def check_places(scene: Scene, geometry: Geometry) -> None:
    """Refuse places at which an object lies wholly off the pad.

    Parameters
    ----------
    scene : Scene
        All its placements are looked at; angles that are left to chance may be any.
    geometry : Geometry
        Gives the size of the pad.

    Raises
    ------
    UsageError
        With the first such object.
    """
    width, height = geometry.size_cm
    for placement, things in enumerate(scene.in_turn or (scene.objects,)):
        of_it = f" of placement {placement + 1}" if scene.in_turn else ""
        for number, thing in enumerate(things):
            if isinstance(thing.place, str) or not is_off(
                _within(thing), (0.0, width, height, 0.0)
            ):
                continue
            x, y = thing.place
            raise UsageError(
                f"{_label(number, thing)}{of_it}: at place [{x:g}, {y:g}] it lies wholly off the "
                f"pad of {width:g} by {height:g} cm; places are in cm from the pad's top left "
                "corner, x to the right, y down"
            )


def is_off(shape: Shape, extent_cm: tuple[float, float, float, float]) -> bool:
    """Return whether an outline lies wholly off a pad.

    Parameters
    ----------
    shape : Circle, Ellipse, Rectangle or Polygon
        A polygon that is not convex counts as its hull.
    extent_cm : (float, float, float, float)
        The pad's left, right, bottom and top edge.
    """
    left, right, bottom, top = extent_cm
    if left < shape.x_cm < right and top < shape.y_cm < bottom:
        return False  # as of most: told at once
    x_cm, y_cm = 0.5 * (left + right), 0.5 * (top + bottom)
    return are_apart(shape, Rectangle(x_cm, y_cm, right - left, bottom - top, 0.0))


def _within(thing: Thing) -> Shape:
    """Return what an object that has a place lies within at any angle that it may have."""
    assert not isinstance(thing.place, str)
    x_cm, y_cm = thing.place
    angle_deg = getattr(thing, "angle_deg", 0.0)
    if angle_deg == "random":
        corners = thing.footprint(0.0, 0.0, 0.0).outline_cm()
        return Circle(x_cm, y_cm, float(np.hypot(*corners.T).max()))
    return thing.footprint(x_cm, y_cm, math.radians(angle_deg))


def _label(number: int, thing: Thing) -> str:
    return f"object {number + 1}" + (f" ({thing.name})" if thing.name else "")


def _angle_rad(thing: Thing, rng: np.random.Generator) -> float:
    angle = getattr(thing, "angle_deg", 0.0)
    return float(math.pi * rng.uniform(-0.5, 0.5)) if angle == "random" else math.radians(angle)


def _room(shape: Shape, geometry: Geometry) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Return the least and the greatest centre at which an outline around (0, 0) is on the pad."""
    reach = _reach(shape, np.array([[1.0, 0.0, -1.0, 0.0], [0.0, 1.0, 0.0, -1.0]]))
    return reach[2:], np.array(geometry.size_cm) - reach[:2]


def _reach(shape: Shape, directions: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return how far the outline reaches along each direction (columns), from the origin."""
    from tactile_graph.wires import Ellipse

    if isinstance(shape, Circle):
        centre = np.array([shape.x_cm, shape.y_cm]) @ directions
        return np.asarray(centre + shape.radius_cm * np.hypot(*directions))
    if isinstance(shape, Ellipse):
        cos, sin = math.cos(shape.angle_rad), -math.sin(shape.angle_rad)
        major = shape.semi_major_cm * (np.array([cos, sin]) @ directions)
        minor = shape.semi_minor_cm * (np.array([-sin, cos]) @ directions)
        centre = np.array([shape.x_cm, shape.y_cm]) @ directions
        return np.asarray(centre + np.hypot(major, minor))
    return np.asarray((shape.outline_cm() @ directions).max(axis=0))


def are_apart(one: Shape, other: Shape, by_cm: float = 0.0) -> bool:
    """Return whether a straight gap of ``by_cm`` runs between two outlines.

    Parameters
    ----------
    one, other : Circle, Ellipse, Rectangle or Polygon
        A polygon that is not convex counts as its hull.
    by_cm : float
        Width of the gap; 360 directions are tried, so pairs within a hair of touching may
        count as touching.
    """
    gap = -_reach(other, -_DIRECTIONS) - _reach(one, _DIRECTIONS)
    return bool((gap >= by_cm).any())
