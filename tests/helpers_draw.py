"""A plugin of small steps and the pipelines made of them, for the tests of the drawings."""

from __future__ import annotations

import types
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from typing import Annotated, Any, ClassVar, NamedTuple

import numpy as np
from annotated_types import Ge, Gt

from tactile_graph import Circle, Degenerate, Frame, Image, Mask, Points, Polygon, hookimpl, loads
from tactile_graph.api.pipeline import Pipeline
from tactile_graph.plugins.registry import Registry
from tactile_graph.steps import Quantity
from tactile_graph.wires import TrueObject


def threshold(
    image: Image, *, level_v: Annotated[float | None, Gt(0), Quantity("volt", of="image")] = None
) -> Mask:
    """Return the cells at or above a level."""
    return image.mask(image.values >= (level_v or 0.5))


def subdivide(mask: Mask, *, factor: Annotated[int, Ge(1)] = 2) -> Mask:
    """Return the mask on a finer grid."""
    values = mask.values.repeat(factor, 0).repeat(factor, 1)
    return Mask(values, (mask.pitch_cm[0] / factor, mask.pitch_cm[1] / factor), mask.origin_cm)


def erode(mask: Mask, *, element: str = "cross3") -> Mask:
    """Return the mask without its rim."""
    v = np.pad(mask.values, 1)
    kept = v[1:-1, 1:-1] & v[:-2, 1:-1] & v[2:, 1:-1] & v[1:-1, :-2] & v[1:-1, 2:]
    return mask.with_values(kept)


def dilate(mask: Mask, *, element: str = "cross3", turns: int = 1) -> Mask:
    """Return the mask with a rim more."""
    v = np.pad(mask.values, 1)
    grown = v[1:-1, 1:-1] | v[:-2, 1:-1] | v[2:, 1:-1] | v[1:-1, :-2] | v[1:-1, 2:]
    return mask.with_values(grown)


def boundary(mask: Mask) -> Points:
    """Return the centres of the cells on the rim."""
    rim = mask.values & ~erode(mask).values
    rows, columns = np.nonzero(rim)
    return Points(np.column_stack([mask.x_cm[columns], mask.y_cm[rows]]))


def hull(points: Points) -> Polygon:
    """Return the corners of the convex hull."""
    from scipy.spatial import ConvexHull

    if points.count < 3:
        raise Degenerate(f"a hull needs 3 points that are not on one line, got {points.count}")
    return Polygon(points.xy_cm[ConvexHull(points.xy_cm).vertices])


def fit_circle(points: Points, *, tolerance_cm: float = 1e-6, most_turns: int = 50) -> Circle:
    """Return a circle through points."""
    centre = points.xy_cm.mean(axis=0)
    radius = np.hypot(*(points.xy_cm - centre).T).mean()
    return Circle(float(centre[0]), float(centre[1]), float(radius))


@dataclass(frozen=True)
class Blob:
    """A plugin's own record: it provides a mask and has a number."""

    number: int
    mask: Mask
    provides: ClassVar[Mapping[type, str]] = {Mask: "mask"}


@dataclass(frozen=True)
class Cross:
    """A plugin's own record that has nothing but an outline."""

    x_cm: float
    y_cm: float

    def outline_cm(self, n: int = 0) -> np.ndarray[Any, Any]:
        """Return its four ends."""
        d = np.array([[0, -1], [1, 0], [0, 1], [-1, 0]], float)
        return d + np.array([self.x_cm, self.y_cm])


class Blobs(NamedTuple):
    """The parts of a mask, left and right half."""

    count: int  # type: ignore[assignment]
    items: list[Blob]


def blobs(image: Image, mask: Mask) -> Blobs:
    """Return what is on in the left and in the right half of the pad."""
    found = []
    for number, half in enumerate((slice(None, 8), slice(8, None)), 1):
        values = np.zeros_like(mask.values)
        values[:, half] = mask.values[:, half]
        if values.any():
            found.append(Blob(number, mask.with_values(values)))
    return Blobs(len(found), found)


def area(blob: Blob) -> float:
    """Return the area in cm2."""
    return blob.mask.area_cm2


def cross(mask: Mask) -> Cross:
    """Return a cross in the middle of the mask."""
    return Cross(float(mask.x_cm.mean()), float(mask.y_cm.mean()))


def broken(mask: Mask) -> Circle:
    """Fail."""
    raise ZeroDivisionError("no cell is left to divide by, whatever the operator may have asked")


def made(*, n: int = 2) -> Iterator[Frame]:
    """Give frames of discs."""
    yield from discs(n)


STEPS = {
    f.__name__: f
    for f in (
        threshold, subdivide, erode, dilate, boundary, hull, fit_circle, blobs, area, cross,
        broken, made,
    )
}  # fmt: skip


def registry(**more: Any) -> Registry:
    """Return a registry of the steps above and of ``more``."""
    module = types.ModuleType("drawn")
    steps = {**STEPS, **more}

    @hookimpl
    def tactile_graph_steps() -> dict[str, Any]:
        return steps

    module.tactile_graph_steps = tactile_graph_steps  # type: ignore[attr-defined]
    return Registry([("drawn", "drawn-package", "1", lambda: module)])


CIRCLE = """
pipeline: circle-demo
about: a disc located as the third circular algorithm does
source: {step: made, with: {n: 3}}
nodes:
  footprint: {step: threshold, in: frame, with: {level_v: 0.01}}
  fine: {step: subdivide, in: footprint}
  eroded: {step: erode, in: fine}
  dilated: {step: dilate, in: eroded}
  edge: {step: boundary, in: dilated}
  hull: {step: hull, in: edge}
  circle: {step: fit_circle, in: hull, when: footprint.count > 4}
outputs: [circle]
"""

BRANCHED = """
pipeline: branched
about: a cheap answer where it will do, a dear one where it will not
conditions: {touched: footprint.count > 0}
nodes:
  footprint: {step: threshold, in: frame, with: {level_v: 0.01}}
  parts: {step: blobs, in: {image: frame, mask: footprint}, when: touched}
  areas: {step: area, in: parts.items, each: true}
  fine: {step: subdivide, in: footprint, with: {factor: 4}}
  edge: {step: boundary, in: fine}
  hull: {step: hull, in: edge}
  cheap: {step: fit_circle, in: edge, when: parts.count == 1 and footprint.fraction < 0.5}
  dear: {step: fit_circle, in: hull, with: {tolerance_cm: 1.0e-9, most_turns: 500}, when: touched}
  circle: {first_of: [cheap, dear]}
  cross: {step: cross, in: footprint}
outputs: [circle, parts, circle.radius_cm, areas]
"""


def circle_demo() -> Pipeline:
    """Return a chain of seven steps."""
    return loads(CIRCLE, "circle-demo.yaml", registry())


def branched() -> Pipeline:
    """Return a graph with a choice, conditions, a step run for each item and an unused node."""
    return loads(BRANCHED, "branched.yaml", registry())


def discs(n: int, truth: bool = True) -> Iterator[Frame]:
    """Give frames of one disc that wanders, with its truth."""
    for i in range(n):
        disc = Circle(6.0 + 1.7 * i, 8.0 + 0.9 * i, 3.5 + 0.4 * i)
        yield disc_frame(disc, i, truth)


def disc_frame(disc: Circle, index: int = 0, truth: bool = True) -> Frame:
    """Return a frame of one disc on a pad of 16x16 cells."""
    centres = (np.arange(16) + 0.5) * 1.3
    x, y = np.meshgrid(centres, centres)
    inside = np.clip(disc.radius_cm - np.hypot(x - disc.x_cm, y - disc.y_cm) + 0.5, 0.0, 1.0)
    rng = np.random.default_rng(index)
    values = inside * rng.uniform(0.3, 1.4, inside.shape)
    known = (TrueObject(disc),) if truth else None
    return Frame.of(values, 1.3, quantity="volt", index=index, time_s=index * 0.04, truth=known)


def empty_frame(index: int = 0) -> Frame:
    """Return a frame of an empty pad."""
    return Frame.of(np.zeros((16, 16)), 1.3, quantity="volt", index=index, truth=())
