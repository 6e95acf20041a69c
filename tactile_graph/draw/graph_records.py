"""The display list of a drawn graph: what stands where, in pixels, y down, painted in several ways.

`svg` writes it as SVG text, `paint_graph` puts it into a matplotlib figure.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

from tactile_graph.draw.layout import Point
from tactile_graph.draw.svg_text import LINE_PX, Line


@dataclass(frozen=True)
class Plate:
    """A rounded rectangle; without ``stroke`` it has no border."""

    x: float
    y: float
    width: float
    height: float
    round_px: float
    fill: str
    stroke: str = ""
    stroke_px: float = 0.0
    dashes: tuple[float, ...] = ()


@dataclass(frozen=True)
class Stroke:
    """A line: of each bend the points, one where it runs straight, three of a cubic Bézier."""

    start: Point
    bends: tuple[tuple[Point, ...], ...]
    paint: str
    width_px: float
    dashes: tuple[float, ...] = ()
    round_ends: bool = False


@dataclass(frozen=True)
class Tip:
    """The head of an arrow that points to the right, its point at ``at``."""

    at: Point
    size_px: float
    paint: str


@dataclass(frozen=True)
class Words:
    """A line of text, its foot at ``at``; ``anchor`` is ``start`` or ``middle``."""

    line: Line
    at: Point
    anchor: str


def stacked(lines: Iterable[Line], at: Point, anchor: str) -> tuple[Words, ...]:
    """Return lines below one another, the first with its foot at ``at``."""
    return tuple(
        Words(line, Point(at.x, at.y + number * LINE_PX), anchor)
        for number, line in enumerate(lines)
    )


@dataclass(frozen=True)
class Boxed:
    """What belongs to one box, and what more there is to know of it."""

    parts: tuple[Part, ...]
    detail: str


Part = Plate | Stroke | Tip | Words | Boxed


@dataclass(frozen=True)
class Drawing:
    """A whole graph.

    Parameters
    ----------
    name : str
    description : str
        It in words, for those who cannot see it.
    width, height : float
    head : tuple of Words
    shift : Point
        Where the origin of ``parts`` lies.
    parts : tuple of Part
        In the order of painting.
    legend : tuple of Part
    """

    name: str
    description: str
    width: float
    height: float
    head: tuple[Words, ...]
    shift: Point
    parts: tuple[Part, ...]
    legend: tuple[Part, ...]
