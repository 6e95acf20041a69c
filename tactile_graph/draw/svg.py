"""A pipeline's graph as SVG text, without styles or ids that could leak into a page."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence, Set

from tactile_graph.draw.graph_boxes import Mark
from tactile_graph.draw.graph_drawing import NO_MARKS, NOTHING, graph_drawing
from tactile_graph.draw.graph_records import Boxed, Drawing, Part, Plate, Stroke, Tip, Words
from tactile_graph.draw.svg_text import escaped, px, quoted
from tactile_graph.pipeline.graph import Graph


def graph_svg(
    pipeline: Graph,
    new: Set[str] = frozenset(),
    *,
    notes: Mapping[str, Sequence[str]] = NOTHING,
    marks: Mapping[str, Sequence[Mark]] = NO_MARKS,
) -> str:
    """Return the graph as one SVG element; parameters as in `graph_drawing`."""
    drawing = graph_drawing(pipeline, new, notes=notes, marks=marks)
    return "\n".join([*_opening(drawing), *_body(drawing), "</svg>"]) + "\n"


def _opening(drawing: Drawing) -> list[str]:
    width, height = px(drawing.width), px(drawing.height)
    size = f'width="{width}" height="{height}" viewBox="0 0 {width} {height}"'
    return [
        f'<svg xmlns="http://www.w3.org/2000/svg" {size} role="img" '
        f"aria-label={quoted(drawing.name)} "
        'style="max-width:100%;height:auto" '
        "font-family=\"Helvetica, Arial, 'DejaVu Sans', sans-serif\">",
        f"<title>{escaped(drawing.name)}</title>",
        f"<desc>{escaped(drawing.description)}</desc>",
    ]


def _body(drawing: Drawing) -> Iterator[str]:
    for words in drawing.head:
        yield from _elements(words)
    yield f'<g transform="translate({px(drawing.shift.x)} {px(drawing.shift.y)})">'
    for part in drawing.parts:
        yield from _elements(part)
    yield "</g>"
    for part in drawing.legend:
        yield from _elements(part)


def _elements(part: Part) -> Iterator[str]:
    match part:
        case Plate():
            yield _plate(part)
        case Stroke():
            yield _stroke(part)
        case Tip(at, size_px, paint):
            tip = (
                f"M{px(at.x)} {px(at.y)} l{px(-size_px - 1)} {px(-size_px / 2)} l0 {px(size_px)} z"
            )
            yield f'<path d="{tip}" fill="{paint}"/>'
        case Words():
            yield _words(part)
        case Boxed(parts, detail):
            yield f"<g><title>{escaped(detail)}</title>"
            for inner in parts:
                yield from _elements(inner)
            yield "</g>"


def _plate(plate: Plate) -> str:
    edge = f' stroke="{plate.stroke}" stroke-width="{px(plate.stroke_px)}"' if plate.stroke else ""
    return (
        f'<rect x="{px(plate.x)}" y="{px(plate.y)}" width="{px(plate.width)}" '
        f'height="{px(plate.height)}" rx="{px(plate.round_px)}" '
        f"fill={quoted(plate.fill)}{edge}{_dashed(plate.dashes)}/>"
    )


def _stroke(stroke: Stroke) -> str:
    path = f"M{px(stroke.start.x)} {px(stroke.start.y)}"
    for bend in stroke.bends:
        to = " ".join(f"{px(p.x)} {px(p.y)}" for p in bend)
        path += f" {'C' if len(bend) == 3 else 'L'}{to}"
    cap = ' stroke-linecap="round"' if stroke.round_ends else ""
    return (
        f'<path d="{path}" fill="none" stroke="{stroke.paint}" '
        f'stroke-width="{px(stroke.width_px)}"{_dashed(stroke.dashes)}{cap}/>'
    )


def _dashed(dashes: tuple[float, ...]) -> str:
    return f' stroke-dasharray="{" ".join(map(px, dashes))}"' if dashes else ""


def _words(words: Words) -> str:
    line = words.line
    style = ' font-weight="bold"' if line.bold else ""
    style += ' font-style="italic"' if line.italic else ""
    return (
        f'<text x="{px(words.at.x)}" y="{px(words.at.y)}" text-anchor="{words.anchor}" '
        f'font-size="{px(line.size)}" fill="{line.ink}"{style}>{escaped(line.text)}</text>'
    )
