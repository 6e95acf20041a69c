"""Pictures of restored images with the lines between their cells, after figures 5.8 to 5.14."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from tactile_graph.wires import Image, Shape
from tactile_graph_mrf.energy.line_field import LineField
from tactile_graph_thesis.measure.restorations import Hulls, Restoration

if TYPE_CHECKING:
    from matplotlib.artist import Artist
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure
    from matplotlib.image import AxesImage

LINE, OUTLINE, HEURISTIC, TRUTH = "#d62728", "#ff7f0e", "#1f77b4", "#2ca02c"
EVERY = "#9e9e9e"
MAP = "Greys"


def draw_5_8(*made: Restoration) -> Figure:
    """Draw figures 5.8 and 5.9, a row a restorer: original to restored images, and the lines."""
    figure, axes = _panels(len(made), 5)
    for row, one in zip(axes, made, strict=True):
        assert one.truth is not None
        images = (
            ("original", one.truth),
            ("corrupted", one.observed),
            (f"{one.restorer}, without lines", one.smooth),
            (f"{one.restorer}, with lines", one.lined),
        )
        low = min(float(image.values.min()) for _, image in images)
        high = max(float(image.values.max()) for _, image in images)
        for ax, (title, image) in zip(row, images, strict=False):
            shown = _image(ax, image, title, (low, high))
        title = f"line field, energy {one.energy:.0f}"
        _lines(row[4], one.lines, None, title, label="line that is on")
        _polygons(row[4], [p.xy_cm for p in one.outlines], TRUTH, "true outline")
        figure.colorbar(shown, ax=list(row[:4]), shrink=0.75, label="grey level")
    _legend(figure, axes.ravel())
    return figure


def draw_5_10_to_5_13(made: Sequence[Restoration]) -> Figure:
    """Draw figures 5.10 to 5.13: a row an object, the last column its line field."""
    figure, axes = _panels(len(made), 4)
    for row, one in zip(axes, made, strict=True):
        images = (
            (f"{one.name}, as recorded", one.observed),
            ("restored without lines", one.smooth),
            ("restored with lines", one.lined),
        )
        high = max(float(image.values.max()) for _, image in images)
        for ax, (title, image) in zip(row, images, strict=False):
            shown = _image(ax, image, title, (0.0, high))
        figure.colorbar(shown, ax=list(row[:3]), shrink=0.8, label=one.unit)
        title = "lines and contour" if one.outlines else "lines"
        _lines(row[3], one.lines, one.observed, title, label="line that is on")
        _polygons(row[3], [p.xy_cm for p in one.outlines], OUTLINE, "closed contour")
        _shape(row[3], one.shape)
    _legend(figure, axes.ravel())
    return figure


def draw_5_13(*made: Sequence[Restoration]) -> Figure:
    """Draw figure 5.13: line fields, a row a way and a column an object."""
    figure, axes = _panels(len(made), len(made[0]))
    for row, objects in zip(axes, made, strict=True):
        for ax, one in zip(row, objects, strict=True):
            _lines(ax, one.lines, one.observed, f"{one.name}, {one.unit}", label="line that is on")
            _shape(ax, one.shape)
    _legend(figure, axes.ravel())
    return figure


def draw_5_14(made: Sequence[Hulls]) -> Figure:
    """Draw figure 5.14: hulls of the line field and of the heuristic way, and the true disc."""
    figure, axes = _panels(1, len(made))
    for ax, one in zip(axes[0], made, strict=True):
        _lines(ax, one.lines, None, one.name, label="line that is on")
        _polygons(ax, [one.every_line.xy_cm], EVERY, "hull of every line")
        _polygons(ax, [one.enclosed.xy_cm], OUTLINE, "hull of what lines enclose")
        _polygons(ax, [one.heuristic.xy_cm], HEURISTIC, "hull of circle-3")
        _shape(ax, one.shape)
    _legend(figure, axes.ravel())
    return figure


def _panels(rows: int, columns: int) -> tuple[Figure, NDArray[np.object_]]:
    from matplotlib.figure import Figure

    figure = Figure(figsize=(3.1 * columns + 0.6, 3.1 * rows + 1.1), layout="constrained")
    axes = figure.subplots(rows, columns, squeeze=False)
    for ax in axes[-1]:
        ax.set_xlabel("x (cm)")
    for ax in axes[:, 0]:
        ax.set_ylabel("y (cm)")
    return figure, axes


def _image(ax: Axes, image: Image, title: str, limits: tuple[float, float]) -> AxesImage:
    ax.set_title(title, fontsize=10)
    return ax.imshow(image.values, cmap=MAP, vmin=limits[0], vmax=limits[1], extent=image.extent_cm)


def _lines(ax: Axes, lines: LineField, image: Image | None, title: str, label: str) -> None:
    from matplotlib.collections import LineCollection

    ax.set_title(title, fontsize=10)
    (px, py), (x, y) = lines.pitch_cm, lines.origin_cm
    rows, columns = lines.vertical.shape[0], lines.horizontal.shape[1]
    if image is not None:
        ax.imshow(image.values, cmap=MAP, alpha=0.35, extent=image.extent_cm)
    ax.add_collection(
        LineCollection([*lines.segments_cm], colors=LINE, linewidths=1.6, label=label)
    )
    ax.set_xlim(x, x + columns * px)
    ax.set_ylim(y + rows * py, y)
    ax.set_aspect("equal")


def _polygons(ax: Axes, outlines: Sequence[NDArray[np.float64]], colour: str, label: str) -> None:
    for k, xy in enumerate(outlines):
        closed = np.vstack([xy, xy[:1]])
        ax.plot(*closed.T, "--", color=colour, lw=1.8, label="" if k else label)


def _shape(ax: Axes, shape: Shape | None) -> None:
    if shape is not None:
        xy = np.asarray(shape.outline_cm())
        ax.plot(*np.vstack([xy, xy[:1]]).T, color=TRUTH, lw=1.5, label="true outline")


def _legend(figure: Figure, axes: NDArray[np.object_]) -> None:
    found: dict[str, Artist] = {}
    for ax in axes:
        for handle, label in zip(*ax.get_legend_handles_labels(), strict=True):
            found.setdefault(label, handle)
    figure.legend([*found.values()], [*found], loc="outside lower center", ncols=3, fontsize=9)
