"""A pipeline's graph as a picture file: its display list in a matplotlib figure."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING, Any

from tactile_graph.draw.graph_drawing import graph_drawing
from tactile_graph.draw.graph_records import Boxed, Drawing, Part, Plate, Stroke, Tip, Words
from tactile_graph.pipeline.graph import Graph

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

PX_PER_INCH = 96.0
DPI = 192.0
"""Two pixels of the picture for one of the drawing, where it does not get too large."""
MOST_PX = 30_000
_POINTS = 72.0 / PX_PER_INCH
_FONT = 0.92
"""Matplotlib's own font is wider than those of browsers, for which the boxes are made."""


def graph_figure(pipeline: Graph) -> Figure:
    """Return the graph as a figure of its own, on white, known to no window."""
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure

    drawing = graph_drawing(pipeline)
    size = drawing.width / PX_PER_INCH, drawing.height / PX_PER_INCH
    figure = Figure(figsize=size, dpi=min(DPI, MOST_PX / max(size)), facecolor="white")
    FigureCanvasAgg(figure)
    axes = figure.add_axes((0.0, 0.0, 1.0, 1.0), xlim=(0.0, drawing.width),
                           ylim=(drawing.height, 0.0))  # fmt: skip
    axes.set_axis_off()
    for part, shift in _parts(drawing):
        _paint(axes, part, *shift)
    return figure


def graph_picture(pipeline: Graph, kind: str) -> bytes:
    """Return the graph as ``png`` or ``pdf``; the same graph gives the same bytes."""
    from tactile_graph.draw.strip import figure_bytes

    figure = graph_figure(pipeline)
    return figure_bytes(figure, kind, figure.dpi)


def _parts(drawing: Drawing) -> Iterator[tuple[Part, tuple[float, float]]]:
    for part in (*drawing.head, *drawing.legend):
        yield part, (0.0, 0.0)
    for part in drawing.parts:
        yield part, drawing.shift


def _paint(axes: Axes, part: Part, dx: float, dy: float) -> None:
    match part:
        case Plate():
            _plate(axes, part, dx, dy)
        case Stroke():
            _stroke(axes, part, dx, dy)
        case Tip(at, size, paint):
            x, y = at.x + dx, at.y + dy
            corners = ([x, x - size - 1, x - size - 1], [y, y - size / 2, y + size / 2])
            axes.fill(*corners, color=paint, lw=0, zorder=2)
        case Words(line, at, anchor):
            axes.text(
                at.x + dx, at.y + dy, line.text, fontsize=line.size * _POINTS * _FONT,
                color=line.ink, fontweight="bold" if line.bold else "normal",
                fontstyle="italic" if line.italic else "normal", va="baseline",
                ha="center" if anchor == "middle" else "left", zorder=2, parse_math=False,
            )  # fmt: skip
        case Boxed(parts):
            for inner in parts:
                _paint(axes, inner, dx, dy)


def _plate(axes: Axes, plate: Plate, dx: float, dy: float) -> None:
    from matplotlib.patches import FancyBboxPatch

    style = f"round,pad=0,rounding_size={min(plate.round_px, plate.height / 2)}"
    axes.add_patch(
        FancyBboxPatch(
            (plate.x + dx, plate.y + dy), plate.width, plate.height, boxstyle=style,
            fc=plate.fill, ec=plate.stroke or "none", lw=plate.stroke_px * _POINTS,
            ls=_dashes(plate.dashes, plate.stroke_px), zorder=2,
        )
    )  # fmt: skip


def _stroke(axes: Axes, stroke: Stroke, dx: float, dy: float) -> None:
    from matplotlib.patches import PathPatch
    from matplotlib.path import Path

    points, codes = [(stroke.start.x + dx, stroke.start.y + dy)], [Path.MOVETO]
    for bend in stroke.bends:
        points += [(p.x + dx, p.y + dy) for p in bend]
        codes += [Path.CURVE4 if len(bend) == 3 else Path.LINETO] * len(bend)
    axes.add_patch(
        PathPatch(
            Path(points, codes), fill=False, ec=stroke.paint, lw=stroke.width_px * _POINTS,
            ls=_dashes(stroke.dashes, stroke.width_px),
            capstyle="round" if stroke.round_ends else "butt", zorder=2,
        )
    )  # fmt: skip


def _dashes(dashes: tuple[float, ...], width_px: float) -> Any:
    """Return a dash pattern as matplotlib takes it, in widths of the line."""
    return (0.0, [d / width_px for d in dashes]) if dashes else "solid"
