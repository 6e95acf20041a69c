"""The picture strip: one row a frame, one column a node, results and truth drawn over."""

from __future__ import annotations

import io
import os
import warnings
from collections.abc import Iterable, Sequence
from pathlib import Path
from textwrap import wrap
from typing import TYPE_CHECKING

from tactile_graph.draw.colours import FOUND, TRUE
from tactile_graph.draw.paint_strip import DASHES, Pen
from tactile_graph.draw.strip_columns import Column, columns, outcome_of
from tactile_graph.engine.outcomes.outcomes import Outcomes
from tactile_graph.errors import UsageError, did_you_mean, one_of
from tactile_graph.files import write_whole
from tactile_graph.foreign_text import visible
from tactile_graph.pipeline.graph import FRAME
from tactile_graph.wires import Frame

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure
    from matplotlib.image import AxesImage

FORMATS = ("pdf", "png", "svg")
MOST_ROWS = 12
DPI = 110
_CELL_IN = 1.75
_GAP_IN = 0.14
_LEFT_IN, _RIGHT_IN, _BOTTOM_IN = 1.0, 0.15, 0.55
_BAR_IN = 0.45
Extent = tuple[float, float, float, float]


def strip_figure(
    results: Iterable[Outcomes], nodes: Sequence[str] | None = None, *, most_rows: int = MOST_ROWS
) -> Figure:
    """Return the strip as a figure of its own, known to no window and no global state.

    Parameters
    ----------
    results : iterable of Outcomes
        One row each; where there are more than ``most_rows``, as many spread evenly over them.
    nodes : sequence of str, optional
        Nodes, outputs or ``node.field`` to show; the frame and every node that has a place on
        the pad if not given.
    most_rows : int

    Raises
    ------
    UsageError
        If there is no result, or no node of that name.
    """
    given = list(results)
    if not given:
        raise UsageError("no picture can be drawn: there is no frame")
    shown = _spread(given, most_rows)
    return _Strip(shown, columns(shown, nodes), len(given)).figure


def save_strip(
    results: Iterable[Outcomes],
    path: str | os.PathLike[str],
    nodes: Sequence[str] | None = None,
    *,
    most_rows: int = MOST_ROWS,
) -> None:
    """Write the strip as png, svg or pdf, by suffix; the file is there whole or not at all.

    Parameters
    ----------
    results, nodes, most_rows
        As in `strip_figure`.
    path : path
        An existing file is replaced.

    Raises
    ------
    UsageError
        If the suffix is none of these, or the file cannot be written.
    """
    kind = picture_format(path)
    data = figure_bytes(strip_figure(results, nodes, most_rows=most_rows), kind)
    write_whole(path, data)


def picture_format(path: str | os.PathLike[str]) -> str:
    """Return the format a picture's suffix stands for.

    Raises
    ------
    UsageError
        If it is none of `FORMATS`.
    """
    suffix = Path(path).suffix.lower().lstrip(".")
    if suffix in FORMATS:
        return suffix
    got = f"got {'.' + suffix!r}" if suffix else "got none"
    allowed = one_of(f".{f}" for f in FORMATS)
    hint = did_you_mean(suffix, FORMATS) if suffix else ""
    raise UsageError(f"{os.fspath(path)}: a picture's suffix must be one of {allowed}; {got}{hint}")


def figure_png(figure: Figure) -> bytes:
    """Return the figure as PNG."""
    return figure_bytes(figure, "png")


def figure_bytes(figure: Figure, kind: str, dpi: float = DPI) -> bytes:
    """Return the figure in one of `FORMATS`; the same figure gives the same bytes."""
    import matplotlib as mpl

    dated = {"svg": "Date", "pdf": "CreationDate"}.get(kind)
    make_visible(figure)
    buffer = io.BytesIO()
    with warnings.catch_warnings(), mpl.rc_context({"svg.hashsalt": "tactile-graph"}):
        # A name in a script that the font lacks is drawn as boxes; that harms nobody's run.
        warnings.filterwarnings("ignore", message="Glyph .* missing from")
        figure.savefig(buffer, format=kind, dpi=dpi, metadata={dated: None} if dated else None)
    return buffer.getvalue()


def make_visible(figure: Figure) -> None:
    """Spell out in a figure's texts what is not seen; half of a character's code draws no glyph."""
    from matplotlib.text import Text

    for text in figure.findobj(Text):
        assert isinstance(text, Text)
        if (told := visible(text.get_text())) != text.get_text():
            text.set_text(told)


def _spread(results: list[Outcomes], most: int) -> list[Outcomes]:
    if len(results) <= most:
        return results
    if most <= 1:
        return results[:1]
    step = (len(results) - 1) / (most - 1)
    return [results[round(i * step)] for i in range(most)]


class _Strip:
    """Lays out the axes in inches and lets a `Pen` draw each."""

    def __init__(self, results: list[Outcomes], shown: list[Column], n_given: int) -> None:
        from matplotlib.backends.backend_agg import FigureCanvasAgg
        from matplotlib.figure import Figure

        self.results = results
        self.columns = shown
        self.beneath = columns(results, [FRAME])[0]
        pipeline, n = results[0].plan.pipeline, len(results)
        self.head = pipeline.name + (f"  ({n} of {n_given} frames)" if n < n_given else "")
        self.extent = _extent([r.frame for r in results])
        self.cell = _cell_size(self.extent)
        self.titles = [_title(c, self.cell[0]) for c in shown]
        self.top = 0.5 + 0.16 * max(t.count("\n") + 1 for t in self.titles)
        bars = any(c.quantity for c in shown)
        self.bottom = _BOTTOM_IN + (_BAR_IN if bars else 0.0)
        n_rows, n_columns = len(results), len(shown)
        self.width = _LEFT_IN + n_columns * (self.cell[0] + _GAP_IN) - _GAP_IN + _RIGHT_IN
        self.width = max(self.width, 2.2 + 0.1 * len(self.head))
        self.height = self.top + n_rows * (self.cell[1] + _GAP_IN) - _GAP_IN + self.bottom
        self.figure = Figure(figsize=(self.width, self.height), facecolor="white")
        FigureCanvasAgg(self.figure)
        drawn = set()
        for row, result in enumerate(results):
            for column in range(n_columns):
                drawn |= self._cell(row, column, result)
        self.figure.text(
            0.12 / self.width, 1 - 0.12 / self.height, self.head, fontsize=11,
            fontweight="bold", ha="left", va="top", parse_math=False,
        )  # fmt: skip
        self._legend(drawn)

    def _cell(self, row: int, column: int, result: Outcomes) -> set[str]:
        axes = self._axes(row, column)
        what = self.columns[column]
        pen = Pen(axes, result.frame, what, self.beneath)
        pen.draw(outcome_of(result, what.name))
        if result.frame.truth and axes.images:
            pen.truth(result.frame.truth)
        self._frame_of(axes)
        if row == 0:
            axes.set_title(self.titles[column], fontsize=9, parse_math=False)
        if column == 0:
            self._row_title(axes, result.frame)
        if pen.heat is not None and what.quantity:
            self._bar(column, pen.heat, what)
        return pen.drawn

    def _axes(self, row: int, column: int) -> Axes:
        from matplotlib.ticker import MaxNLocator

        width, height = self.cell
        x = _LEFT_IN + column * (width + _GAP_IN)
        y = self.height - self.top - (row + 1) * height - row * _GAP_IN
        axes = self.figure.add_axes(
            (x / self.width, y / self.height, width / self.width, height / self.height)
        )
        self._frame_of(axes)
        axes.tick_params(
            labelsize=7, length=2.5, width=0.6, color="#777777",
            labelleft=column == 0, labelbottom=row == len(self.results) - 1,
        )  # fmt: skip
        for spine in axes.spines.values():
            spine.set(linewidth=0.6, color="#777777")
        for axis in (axes.xaxis, axes.yaxis):
            axis.set_major_locator(MaxNLocator(5, steps=[1, 2, 5, 10]))
        if row == len(self.results) - 1:
            axes.set_xlabel("x in cm", fontsize=8, labelpad=2)
        return axes

    def _frame_of(self, axes: Axes) -> None:
        """Give every axes the same extent, y down; drawing must not have moved it."""
        left, right, bottom, top = self.extent
        axes.set(xlim=(left, right), ylim=(bottom, top), aspect="auto")

    def _row_title(self, axes: Axes, frame: Frame) -> None:
        axes.set_ylabel("y in cm", fontsize=8, labelpad=2)
        lines = [f"frame {frame.index}"]
        lines += (
            [] if frame.time_s is None else [f"{frame.time_s:.3f}".rstrip("0").rstrip(".") + " s"]
        )
        lines += wrap(frame.label, 12)[:2]
        axes.annotate(
            "\n".join(lines), (0, 0.5), (-_LEFT_IN * 72 + 6, 0), xycoords="axes fraction",
            textcoords="offset points", rotation=90, ha="left", va="center", fontsize=9,
            multialignment="center", parse_math=False,
        )  # fmt: skip

    def _bar(self, column: int, heat: AxesImage, what: Column) -> None:
        """Put the column's colour bar at the foot, once: its range holds for all frames."""
        name = f"scale of {what.name}"
        if any(axes.get_label() == name for axes in self.figure.axes):
            return
        width = self.cell[0]
        x = _LEFT_IN + column * (width + _GAP_IN) + 0.08 * width
        place = (x / self.width, 0.4 / self.height, 0.84 * width / self.width, 0.08 / self.height)
        axes = self.figure.add_axes(place, label=name)
        bar = self.figure.colorbar(heat, cax=axes, orientation="horizontal")
        bar.ax.tick_params(labelsize=7, length=2, width=0.6)
        bar.ax.locator_params(nbins=4 if width > 1.4 else 2)
        bar.outline.set_linewidth(0.5)
        bar.set_label(what.scale, fontsize=8, labelpad=1)

    def _legend(self, drawn: set[str]) -> None:
        from matplotlib.lines import Line2D

        handles = []
        if "found" in drawn:
            handles.append(Line2D([], [], color=FOUND, lw=1.7, label="found"))
        if "true" in drawn:
            handles.append(Line2D([], [], color=TRUE, lw=1.4, dashes=DASHES, label="true"))
        if handles:
            self.figure.legend(
                handles=handles, loc="upper right", ncols=2, fontsize=9, frameon=False,
                bbox_to_anchor=(1 - 0.05 / self.width, 1 - 0.03 / self.height),
                borderaxespad=0.1, handlelength=2.6,
            )  # fmt: skip


def _extent(frames: list[Frame]) -> Extent:
    """Return left, right, bottom and top of what all the frames' images cover together."""
    edges = [f.image.extent_cm for f in frames]
    return (
        min(e[0] for e in edges),
        max(e[1] for e in edges),
        max(e[2] for e in edges),
        min(e[3] for e in edges),
    )


def _cell_size(extent: Extent) -> tuple[float, float]:
    """Return width and height of a cell in inches, shaped as the pad is."""
    left, right, bottom, top = extent
    ratio = (right - left) / (bottom - top)
    width = _CELL_IN * min(1.0, ratio)
    height = width / ratio
    # A long pad's cells grow, so that titles find room; a centimetre stays a centimetre.
    scale = min(max(1.0, 0.9 / width, 0.6 / height), 2.0)
    return width * scale, height * scale


def _title(column: Column, width_in: float) -> str:
    per_line = max(int(width_in * 15), 10)
    lines = wrap(column.name, per_line)[:2]
    if column.step and column.step != column.name:
        lines += wrap(f"({column.step})", per_line)[:2]
    return "\n".join(lines)
