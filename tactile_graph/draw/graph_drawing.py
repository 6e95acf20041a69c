"""A pipeline's graph as a display list, from left to right, legible on white and on dark pages."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence, Set
from itertools import pairwise
from textwrap import wrap
from types import MappingProxyType

from tactile_graph.draw.blocks import Wire, WireKind, blocks, wires
from tactile_graph.draw.graph_boxes import Mark, box, box_lines, box_size
from tactile_graph.draw.graph_records import Drawing, Part, Plate, Stroke, Tip, Words, stacked
from tactile_graph.draw.layers import Joint
from tactile_graph.draw.layout import Point, layout
from tactile_graph.draw.svg_text import INK, LINE_PX, SMALL_PX, TITLE_PX, Line, text_width
from tactile_graph.pipeline.graph import Graph

MARGIN = 16.0
ARROW = 7.0
WIRE = "#748296"
"""A grey that stands out as much from black as from white."""

_DASHES: Mapping[WireKind, tuple[float, ...]] = {"data": (), "guard": (7, 4), "choice": (1.5, 4)}
_LEGEND: Mapping[WireKind, str] = {
    "data": "data",
    "guard": "condition",
    "choice": "choice, in order",
}

NOTHING: Mapping[str, Sequence[str]] = MappingProxyType({})
NO_MARKS: Mapping[str, Sequence[Mark]] = MappingProxyType({})


def graph_drawing(
    pipeline: Graph,
    new: Set[str] = frozenset(),
    *,
    notes: Mapping[str, Sequence[str]] = NOTHING,
    marks: Mapping[str, Sequence[Mark]] = NO_MARKS,
) -> Drawing:
    """Return the graph as a display list.

    Parameters
    ----------
    pipeline : Graph
    new : set of str
        Nodes to draw with a thicker border, as what an evolution added or changed.
    notes : mapping
        Node -> lines to add to what stands in its box.
    marks : mapping
        Node -> plates at the foot of its box.
    """
    shown, joined = blocks(pipeline), wires(pipeline)
    lines = {b.key: box_lines(b) + [Line(t) for t in notes.get(b.key, ())] for b in shown}
    sizes = {b.key: box_size(lines[b.key], b, joined, marks.get(b.key, ())) for b in shown}
    placed = layout(sizes, [_joint(w) for w in joined])
    head = _head(pipeline, max(placed.width, 320.0))
    kinds = list(dict.fromkeys(w.kind for w in joined))
    legend = [k for k in _LEGEND if k in kinds] if len(kinds) > 1 else []
    top = MARGIN + len(head) * LINE_PX + (10 if head else 0)
    legend_top = top + placed.height + 26
    width = max(placed.width, *(line.width for line in head), _legend_width(legend)) + 2 * MARGIN
    height = (legend_top + 4 if legend else top + placed.height) + MARGIN
    routed = list(zip(joined, placed.routes, strict=True))
    boxes = (
        box(b, placed.boxes[b.key], lines[b.key], b.key in new, marks.get(b.key, ())) for b in shown
    )
    return Drawing(
        f"pipeline {pipeline.name}",
        description(pipeline),
        width,
        height,
        stacked(head, Point(MARGIN, MARGIN + TITLE_PX), "start"),
        Point(MARGIN, top),
        (
            *(part for w, route in routed for part in _wire(w, route)),
            *boxes,
            *(part for w, route in routed if w.label for part in _label(w, route)),
        ),
        tuple(_legend(legend, legend_top)),
    )


def _joint(wire: Wire) -> Joint:
    room = text_width(wire.label, SMALL_PX) + 14 if wire.label else 0.0
    # Conditions hardly pull: what the data goes through stays in line.
    return Joint(wire.start, wire.end, room, 0.01 if wire.kind == "guard" else 1.0)


def description(pipeline: Graph) -> str:
    """Return the graph in words, for those who cannot see it."""
    parts = [pipeline.about.rstrip(".")] if pipeline.about else []
    joined = wires(pipeline)
    for block in blocks(pipeline):
        reads = [w.start for w in joined if w.end == block.key]
        what = f"{block.title} ({block.step})" if block.step else block.title
        words = f"{what} reads {', '.join(dict.fromkeys(reads))}" if reads else what
        words += f" {block.guard}" if block.guard else ""
        parts.append(words + (" and is an output" if block.outputs else ""))
    return ". ".join(parts) + "."


# -- wires, head and legend ----------------------------------------------------------------------


def _wire(wire: Wire, route: tuple[Point, ...]) -> tuple[Stroke, Tip]:
    end = route[-1]
    points = [*route[:-1], Point(end.x - ARROW, end.y)]
    bends = []
    for number, (a, b) in enumerate(pairwise(points)):
        half = (a.x + b.x) / 2
        straight = number % 2 or a.y == b.y
        bends.append((b,) if straight else (Point(half, a.y), Point(half, b.y), b))
    return _stroke(points[0], tuple(bends), wire.kind), Tip(end, ARROW, WIRE)


def _stroke(start: Point, bends: tuple[tuple[Point, ...], ...], kind: WireKind) -> Stroke:
    chosen = kind == "choice"
    return Stroke(start, bends, WIRE, 2.2 if chosen else 1.6, _DASHES[kind], round_ends=chosen)


def _label(wire: Wire, route: tuple[Point, ...]) -> tuple[Plate, Words]:
    """Return port names or rank on a small plate: it is read on any page and over any wire."""
    width = text_width(wire.label, SMALL_PX - 1) + 8
    right, y = route[-1].x - ARROW - 3, route[-1].y
    line = Line(wire.label, SMALL_PX - 1, ink=INK)
    plate = Plate(right - width, y - 6.5, width, 13.0, 4.0, "#e9edf3")
    return plate, Words(line, Point(right - width / 2, y + 3.5), "middle")


def _head(pipeline: Graph, width: float) -> list[Line]:
    lines = [Line(pipeline.name, TITLE_PX, bold=True, ink=WIRE)]
    per_line = max(int(width / (SMALL_PX * 0.56)), 30)
    return lines + [Line(t, ink=WIRE) for t in wrap(pipeline.about, per_line)[:3]]


def _legend(kinds: Sequence[WireKind], y: float) -> Iterator[Part]:
    x = MARGIN
    for kind in kinds:
        yield _stroke(Point(x, y - 4), ((Point(x + 30, y - 4),),), kind)
        yield Words(Line(_LEGEND[kind], ink=WIRE), Point(x + 37, y), "start")
        x += _legend_width([kind])


def _legend_width(kinds: Sequence[WireKind]) -> float:
    return sum(37 + text_width(_LEGEND[k], SMALL_PX) + 18 for k in kinds)
