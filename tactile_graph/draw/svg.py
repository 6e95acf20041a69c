"""A pipeline's graph as SVG text, from left to right, legible on white and on dark pages."""

from __future__ import annotations

import re
from collections.abc import Iterable, Sequence, Set
from dataclasses import dataclass
from itertools import pairwise
from textwrap import shorten, wrap
from xml.sax.saxutils import escape, quoteattr

from tactile_graph.draw.blocks import Block, Wire, blocks, wires
from tactile_graph.draw.layers import Joint
from tactile_graph.draw.layout import Place, Point, layout
from tactile_graph.pipeline.pipeline import Pipeline

MARGIN = 16.0
PADDING = 10.0
TITLE_PX = 13.0
SMALL_PX = 11.0
LINE_PX = 15.0
ARROW = 7.0
WIRE = "#748296"
"""A grey that stands out as much from black as from white."""

_INK, _SOFT = "#16202e", "#46546a"
_PAINTS = {
    "source": ("#dfeaf8", "#3d6ea8"),
    "frame": ("#dfeaf8", "#3d6ea8"),
    "step": ("#f3f5f9", "#6b7a90"),
    "choice": ("#fbefd5", "#b0811f"),
    "output": ("#dcf1e1", "#2f8a4c"),
}
_DASHES = {"data": "", "guard": "7 4", "choice": "1.5 4"}
_LEGEND = {"data": "data", "guard": "condition", "choice": "choice, in order"}
_NOT_XML = re.compile("[\x00-\x08\x0b\x0c\x0e-\x1f\ud800-\udfff\ufffe\uffff]")


@dataclass(frozen=True)
class _Line:
    text: str
    size: float = SMALL_PX
    bold: bool = False
    italic: bool = False
    ink: str = _SOFT

    @property
    def width(self) -> float:
        return text_width(self.text, self.size) * (1.08 if self.bold else 1.0)


def graph_svg(pipeline: Pipeline, new: Set[str] = frozenset()) -> str:
    """Return the graph as one SVG element, without styles or ids that could leak into a page.

    Parameters
    ----------
    pipeline : Pipeline
    new : set of str
        Nodes to draw with a thicker border, as what an evolution added or changed.
    """
    shown, joined = blocks(pipeline), wires(pipeline)
    lines = {b.key: _lines(b) for b in shown}
    sizes = {b.key: _size(lines[b.key], b, joined) for b in shown}
    placed = layout(sizes, [_joint(w) for w in joined])
    head = _head(pipeline, max(placed.width, 320.0))
    kinds = list(dict.fromkeys(w.kind for w in joined))
    legend = [k for k in _LEGEND if k in kinds] if len(kinds) > 1 else []
    top = MARGIN + len(head) * LINE_PX + (10 if head else 0)
    legend_top = top + placed.height + 26
    width = max(placed.width, *(line.width for line in head), _legend_width(legend)) + 2 * MARGIN
    height = (legend_top + 4 if legend else top + placed.height) + MARGIN
    body = [
        *_texts(head, MARGIN, MARGIN + TITLE_PX, "start"),
        f'<g transform="translate({_n(MARGIN)} {_n(top)})">',
        *(_wire(w, route) for w, route in zip(joined, placed.routes, strict=True)),
        *(p for b in shown for p in _box(b, placed.boxes[b.key], lines[b.key], b.key in new)),
        *(_label(w, route) for w, route in zip(joined, placed.routes, strict=True) if w.label),
        "</g>",
        *_legend(legend, legend_top),
    ]
    return "\n".join([*_opening(pipeline, width, height), *body, "</svg>"]) + "\n"


def _joint(wire: Wire) -> Joint:
    room = text_width(wire.label, SMALL_PX) + 14 if wire.label else 0.0
    # Conditions hardly pull: what the data goes through stays in line.
    return Joint(wire.start, wire.end, room, 0.01 if wire.kind == "guard" else 1.0)


def _opening(pipeline: Pipeline, width: float, height: float) -> list[str]:
    name = f"pipeline {pipeline.name}"
    size = f'width="{_n(width)}" height="{_n(height)}" viewBox="0 0 {_n(width)} {_n(height)}"'
    return [
        f'<svg xmlns="http://www.w3.org/2000/svg" {size} role="img" aria-label={_attr(name)} '
        'style="max-width:100%;height:auto" '
        "font-family=\"Helvetica, Arial, 'DejaVu Sans', sans-serif\">",
        f"<title>{_text(name)}</title>",
        f"<desc>{_text(description(pipeline))}</desc>",
    ]


def description(pipeline: Pipeline) -> str:
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


# -- what stands in a box ------------------------------------------------------------------------


def _lines(block: Block) -> list[_Line]:
    lines = [_Line(block.title, TITLE_PX, bold=True, ink=_INK)]
    if block.step and block.step != block.title:
        lines.append(_Line(shorten(block.step, 40, placeholder=" …")))
    lines += [_Line(s, ink=_INK) for s in block.settings]
    lines += [_Line(s, italic=True) for s in _folded(block.guard, 28)]
    if block.outputs:
        own = block.outputs == (block.title,)
        text = "output" if own else "output " + ", ".join(block.outputs)
        lines += [_Line(s, ink=_PAINTS["output"][1]) for s in _folded(text, 28)]
    if block.unused:
        lines.append(_Line("only when asked for", italic=True))
    return lines


def _folded(text: str, width: int) -> list[str]:
    lines = wrap(text, width)
    return lines if len(lines) <= 3 else [*lines[:2], lines[2][: width - 2] + " …"]


def _size(lines: list[_Line], block: Block, joined: list[Wire]) -> tuple[float, float]:
    arriving = sum(w.end == block.key for w in joined)
    width = max(max(line.width for line in lines) + 2 * PADDING, 64.0)
    height = max(len(lines) * LINE_PX + 2 * PADDING - 4, arriving * LINE_PX + PADDING)
    return width, height


def text_width(text: str, size: float) -> float:
    """Return about how wide a text is at most, in pixels, whichever sans-serif font is there."""
    return size * sum(_em(c) for c in text)


def _em(char: str) -> float:
    if char in "iljtfrI.,:;|!'()[]{}/ -":
        return 0.37
    if char in "mwMW@%":
        return 0.97
    if ord(char) > 0x2E7F:
        return 1.05
    return 0.72 if char.isupper() or ord(char) > 0x7F else 0.62


# -- drawing -------------------------------------------------------------------------------------


def _box(block: Block, place: Place, lines: list[_Line], new: bool) -> list[str]:
    fill, stroke = _PAINTS["output" if block.outputs and block.role != "frame" else block.role]
    width = 4.0 if new else 1.3
    dash = ' stroke-dasharray="2 3"' if block.unused else ""
    round_px = 14 if block.role == "choice" else 5

    def rect(shift: float) -> str:
        return (
            f'<rect x="{_n(place.x + shift)}" y="{_n(place.y - shift)}" width="{_n(place.width)}" '
            f'height="{_n(place.height)}" rx="{round_px}" fill="{fill}" stroke="{stroke}" '
            f'stroke-width="{_n(width)}"{dash}/>'
        )

    middle = place.x + place.width / 2
    first = place.middle - len(lines) * LINE_PX / 2 + LINE_PX * 0.75
    return [
        f"<g><title>{_text(block.detail)}</title>",
        *([rect(4.0)] if block.each else []),  # a stack: one box for each item of a list
        rect(0.0),
        *_texts(lines, middle, first, "middle"),
        "</g>",
    ]


def _texts(lines: Iterable[_Line], x: float, y: float, anchor: str) -> list[str]:
    made = []
    for number, line in enumerate(lines):
        style = ' font-weight="bold"' if line.bold else ""
        style += ' font-style="italic"' if line.italic else ""
        made.append(
            f'<text x="{_n(x)}" y="{_n(y + number * LINE_PX)}" text-anchor="{anchor}" '
            f'font-size="{_n(line.size)}" fill="{line.ink}"{style}>{_text(line.text)}</text>'
        )
    return made


def _wire(wire: Wire, route: tuple[Point, ...]) -> str:
    end = route[-1]
    points = [*route[:-1], Point(end.x - ARROW, end.y)]
    path = f"M{_n(points[0].x)} {_n(points[0].y)}"
    for number, (a, b) in enumerate(pairwise(points)):
        if number % 2 or a.y == b.y:
            path += f" L{_n(b.x)} {_n(b.y)}"
        else:
            half = _n((a.x + b.x) / 2)
            path += f" C{half} {_n(a.y)} {half} {_n(b.y)} {_n(b.x)} {_n(b.y)}"
    tip = f"M{_n(end.x)} {_n(end.y)} l{_n(-ARROW - 1)} {_n(-ARROW / 2)} l0 {_n(ARROW)} z"
    return f'{_stroke(path, wire.kind)}<path d="{tip}" fill="{WIRE}"/>'


def _stroke(path: str, kind: str) -> str:
    dash = f' stroke-dasharray="{_DASHES[kind]}"' if _DASHES[kind] else ""
    cap = ' stroke-linecap="round"' if kind == "choice" else ""
    wide = 2.2 if kind == "choice" else 1.6
    return f'<path d="{path}" fill="none" stroke="{WIRE}" stroke-width="{_n(wide)}"{dash}{cap}/>'


def _label(wire: Wire, route: tuple[Point, ...]) -> str:
    """Return port names or rank on a small plate: it is read on any page and over any wire."""
    width = text_width(wire.label, SMALL_PX - 1) + 8
    right, y = route[-1].x - ARROW - 3, route[-1].y
    line = _Line(wire.label, SMALL_PX - 1, ink=_INK)
    plate = (
        f'<rect x="{_n(right - width)}" y="{_n(y - 6.5)}" width="{_n(width)}" height="13" rx="4" '
        f'fill="#e9edf3"/>'
    )
    return plate + _texts([line], right - width / 2, y + 3.5, "middle")[0]


def _head(pipeline: Pipeline, width: float) -> list[_Line]:
    lines = [_Line(pipeline.name, TITLE_PX, bold=True, ink=WIRE)]
    per_line = max(int(width / (SMALL_PX * 0.56)), 30)
    return lines + [_Line(t, ink=WIRE) for t in wrap(pipeline.about, per_line)[:3]]


def _legend(kinds: Sequence[str], y: float) -> list[str]:
    made, x = [], MARGIN
    for kind in kinds:
        made.append(_stroke(f"M{_n(x)} {_n(y - 4)} h30", kind))
        made += _texts([_Line(_LEGEND[kind], ink=WIRE)], x + 37, y, "start")
        x += _legend_width([kind])
    return made


def _legend_width(kinds: Sequence[str]) -> float:
    return sum(37 + text_width(_LEGEND[k], SMALL_PX) + 18 for k in kinds)


def _n(value: float) -> str:
    return f"{value:.1f}".removesuffix(".0")


def _text(text: str) -> str:
    return escape(_NOT_XML.sub("\ufffd", text))


def _attr(text: str) -> str:
    return quoteattr(_NOT_XML.sub("\ufffd", text))
