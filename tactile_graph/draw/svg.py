"""A pipeline's graph as SVG text, from left to right, legible on white and on dark pages."""

from __future__ import annotations

from collections.abc import Mapping, Sequence, Set
from itertools import pairwise
from textwrap import wrap
from types import MappingProxyType

from tactile_graph.draw.blocks import Wire, blocks, wires
from tactile_graph.draw.layers import Joint
from tactile_graph.draw.layout import Point, layout
from tactile_graph.draw.svg_boxes import Mark, box, box_lines, box_size
from tactile_graph.draw.svg_text import (
    INK,
    LINE_PX,
    SMALL_PX,
    TITLE_PX,
    Line,
    escaped,
    px,
    quoted,
    text_width,
    texts,
)
from tactile_graph.pipeline.graph import Graph

MARGIN = 16.0
ARROW = 7.0
WIRE = "#748296"
"""A grey that stands out as much from black as from white."""

_DASHES = {"data": "", "guard": "7 4", "choice": "1.5 4"}
_LEGEND = {"data": "data", "guard": "condition", "choice": "choice, in order"}

_NOTHING: Mapping[str, Sequence[str]] = MappingProxyType({})
_NO_MARKS: Mapping[str, Sequence[Mark]] = MappingProxyType({})


def graph_svg(
    pipeline: Graph,
    new: Set[str] = frozenset(),
    *,
    notes: Mapping[str, Sequence[str]] = _NOTHING,
    marks: Mapping[str, Sequence[Mark]] = _NO_MARKS,
) -> str:
    """Return the graph as one SVG element, without styles or ids that could leak into a page.

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
    body = [
        *texts(head, MARGIN, MARGIN + TITLE_PX, "start"),
        f'<g transform="translate({px(MARGIN)} {px(top)})">',
        *(_wire(w, route) for w, route in zip(joined, placed.routes, strict=True)),
        *(
            part
            for b in shown
            for part in box(
                b, placed.boxes[b.key], lines[b.key], b.key in new, marks.get(b.key, ())
            )
        ),
        *(_label(w, route) for w, route in zip(joined, placed.routes, strict=True) if w.label),
        "</g>",
        *_legend(legend, legend_top),
    ]
    return "\n".join([*_opening(pipeline, width, height), *body, "</svg>"]) + "\n"


def _joint(wire: Wire) -> Joint:
    room = text_width(wire.label, SMALL_PX) + 14 if wire.label else 0.0
    # Conditions hardly pull: what the data goes through stays in line.
    return Joint(wire.start, wire.end, room, 0.01 if wire.kind == "guard" else 1.0)


def _opening(pipeline: Graph, width: float, height: float) -> list[str]:
    name = f"pipeline {pipeline.name}"
    size = f'width="{px(width)}" height="{px(height)}" viewBox="0 0 {px(width)} {px(height)}"'
    return [
        f'<svg xmlns="http://www.w3.org/2000/svg" {size} role="img" aria-label={quoted(name)} '
        'style="max-width:100%;height:auto" '
        "font-family=\"Helvetica, Arial, 'DejaVu Sans', sans-serif\">",
        f"<title>{escaped(name)}</title>",
        f"<desc>{escaped(description(pipeline))}</desc>",
    ]


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


def _wire(wire: Wire, route: tuple[Point, ...]) -> str:
    end = route[-1]
    points = [*route[:-1], Point(end.x - ARROW, end.y)]
    path = f"M{px(points[0].x)} {px(points[0].y)}"
    for number, (a, b) in enumerate(pairwise(points)):
        if number % 2 or a.y == b.y:
            path += f" L{px(b.x)} {px(b.y)}"
        else:
            half = px((a.x + b.x) / 2)
            path += f" C{half} {px(a.y)} {half} {px(b.y)} {px(b.x)} {px(b.y)}"
    tip = f"M{px(end.x)} {px(end.y)} l{px(-ARROW - 1)} {px(-ARROW / 2)} l0 {px(ARROW)} z"
    return f'{_stroke(path, wire.kind)}<path d="{tip}" fill="{WIRE}"/>'


def _stroke(path: str, kind: str) -> str:
    dash = f' stroke-dasharray="{_DASHES[kind]}"' if _DASHES[kind] else ""
    cap = ' stroke-linecap="round"' if kind == "choice" else ""
    wide = 2.2 if kind == "choice" else 1.6
    return f'<path d="{path}" fill="none" stroke="{WIRE}" stroke-width="{px(wide)}"{dash}{cap}/>'


def _label(wire: Wire, route: tuple[Point, ...]) -> str:
    """Return port names or rank on a small plate: it is read on any page and over any wire."""
    width = text_width(wire.label, SMALL_PX - 1) + 8
    right, y = route[-1].x - ARROW - 3, route[-1].y
    line = Line(wire.label, SMALL_PX - 1, ink=INK)
    plate = (
        f'<rect x="{px(right - width)}" y="{px(y - 6.5)}" width="{px(width)}" height="13" rx="4" '
        f'fill="#e9edf3"/>'
    )
    return plate + texts([line], right - width / 2, y + 3.5, "middle")[0]


def _head(pipeline: Graph, width: float) -> list[Line]:
    lines = [Line(pipeline.name, TITLE_PX, bold=True, ink=WIRE)]
    per_line = max(int(width / (SMALL_PX * 0.56)), 30)
    return lines + [Line(t, ink=WIRE) for t in wrap(pipeline.about, per_line)[:3]]


def _legend(kinds: Sequence[str], y: float) -> list[str]:
    made, x = [], MARGIN
    for kind in kinds:
        made.append(_stroke(f"M{px(x)} {px(y - 4)} h30", kind))
        made += texts([Line(_LEGEND[kind], ink=WIRE)], x + 37, y, "start")
        x += _legend_width([kind])
    return made


def _legend_width(kinds: Sequence[str]) -> float:
    return sum(37 + text_width(_LEGEND[k], SMALL_PX) + 18 for k in kinds)
