"""The boxes of a graph: what stands in them, how large they are, and what they are drawn of."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from textwrap import shorten, wrap
from typing import NamedTuple

from tactile_graph.draw.blocks import Block, Wire
from tactile_graph.draw.graph_records import Boxed, Part, Plate, Words, stacked
from tactile_graph.draw.layout import Place, Point
from tactile_graph.draw.svg_text import INK, LINE_PX, SMALL_PX, TITLE_PX, Line, text_width

PADDING = 10.0
PAINTS = {
    "source": ("#dfeaf8", "#3d6ea8"),
    "frame": ("#dfeaf8", "#3d6ea8"),
    "step": ("#f3f5f9", "#6b7a90"),
    "choice": ("#fbefd5", "#b0811f"),
    "output": ("#dcf1e1", "#2f8a4c"),
}


class Mark(NamedTuple):
    """A word on a coloured plate at the foot of a box, as whose node it is."""

    text: str
    paint: str

    @property
    def width(self) -> float:
        """Of the plate, in pixels."""
        return max(text_width(self.text, SMALL_PX) + 8, _MARK_PX)


_MARK_PX, _MARK_GAP = 16.0, 4.0


def box_lines(block: Block) -> list[Line]:
    """Return what stands in a box: name, step, settings, guard, and what it gives out."""
    lines = [Line(block.title, TITLE_PX, bold=True, ink=INK)]
    if block.step and block.step != block.title:
        lines.append(Line(shorten(block.step, 40, placeholder=" …")))
    lines += [Line(s, ink=INK) for s in block.settings]
    lines += [Line(s, italic=True) for s in _folded(block.guard, 28)]
    if block.outputs:
        own = block.outputs == (block.title,)
        text = "output" if own else "output " + ", ".join(block.outputs)
        lines += [Line(s, ink=PAINTS["output"][1]) for s in _folded(text, 28)]
    if block.unused:
        lines.append(Line("only when asked for", italic=True))
    return lines


def _folded(text: str, width: int) -> list[str]:
    lines = wrap(text, width)
    return lines if len(lines) <= 3 else [*lines[:2], lines[2][: width - 2] + " …"]


def box_size(
    lines: list[Line], block: Block, joined: list[Wire], marks: Sequence[Mark]
) -> tuple[float, float]:
    """Return width and height of a box, in pixels: room for its lines, plates and wires."""
    arriving = sum(w.end == block.key for w in joined)
    width = max(*(line.width for line in lines), _marks_width(marks)) + 2 * PADDING
    foot = _MARK_PX + _MARK_GAP if marks else 0.0
    height = max(len(lines) * LINE_PX + 2 * PADDING - 4 + foot, arriving * LINE_PX + PADDING)
    return max(width, 64.0), height


def _marks_width(marks: Sequence[Mark]) -> float:
    return sum(m.width + _MARK_GAP for m in marks) - _MARK_GAP


def box(
    block: Block, place: Place, lines: list[Line], new: bool, marks: Sequence[Mark] = ()
) -> Boxed:
    """Return a box at its place; one that is new has a thicker border."""
    fill, stroke = PAINTS["output" if block.outputs and block.role != "frame" else block.role]
    width = 4.0 if new else 1.3
    dashes = (2.0, 3.0) if block.unused else ()
    round_px = 14.0 if block.role == "choice" else 5.0

    def plate(shift: float) -> Plate:
        x, y = place.x + shift, place.y - shift
        return Plate(x, y, place.width, place.height, round_px, fill, stroke, width, dashes)

    middle = place.x + place.width / 2
    first = place.middle - len(lines) * LINE_PX / 2 + LINE_PX * 0.75
    first -= (_MARK_PX + _MARK_GAP) / 2 if marks else 0.0
    parts: tuple[Part, ...] = (
        *([plate(4.0)] if block.each else []),  # a stack: one box for each item of a list
        plate(0.0),
        *stacked(lines, Point(middle, first), "middle"),
        *_plates(marks, middle, first + (len(lines) - 0.75) * LINE_PX + _MARK_GAP),
    )
    return Boxed(parts, block.detail)


def _plates(marks: Sequence[Mark], middle: float, top: float) -> Iterator[Part]:
    x = middle - _marks_width(marks) / 2
    for mark in marks:
        yield Plate(x, top, mark.width, _MARK_PX, _MARK_PX / 2, mark.paint)
        line = Line(mark.text, SMALL_PX, bold=True, ink="#ffffff")
        yield Words(line, Point(x + mark.width / 2, top + _MARK_PX - 4.2), "middle")
        x += mark.width + _MARK_GAP
