"""Panels of a pad in cm: images, masks, points and outlines, found and true."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from tactile_graph.wires import Image, Mask, Points
from tactile_graph_pads.calibration.plot import new_figure

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure
    from matplotlib.image import AxesImage

    from tactile_graph.wires import Shape

FOUND, TRUE, OTHER = "#d81b60", "#00838f", "#5e35b1"
"""Colours of what was found, of what is true, and of a second thing found."""
BOUNDARY = "#f9a825"
"""Colour of boundary points that are drawn over a mask."""
ON, OFF = "#37474f", "#eceff1"
_PANEL_IN = 3.1
MOST_DRAWN = 400
"""Points beyond these are drawn as pixels in vector files too."""


def panels(
    columns: int, rows: int = 1, panel_in: float = _PANEL_IN, shared: bool = True
) -> tuple[Figure, list[Axes]]:
    """Return a figure of empty panels, row by row.

    Parameters
    ----------
    columns, rows : int
    panel_in : float
        Side of a panel.
    shared : bool
        Whether all have the same axes.
    """
    figure = new_figure(panel_in * columns + 0.6, panel_in * rows + 0.9)
    grid = figure.subplots(rows, columns, squeeze=False, sharex=shared, sharey=shared)
    return figure, list(grid.flat)


def draw_image(axes: Axes, image: Image, top: float | None = None) -> AxesImage:
    """Draw an image's values in shades, the lightest at 0.

    Parameters
    ----------
    axes : matplotlib Axes
    image : Image
    top : float, optional
        The value of the darkest shade; the image's own peak if not given.
    """
    return axes.imshow(
        image.values,
        "Greys",
        vmin=0.0,
        vmax=top or image.peak,
        extent=image.extent_cm,
        interpolation="nearest",
        zorder=0,
    )


def draw_mask(axes: Axes, mask: Mask) -> None:
    """Draw which cells are on, each cell that is a millimetre or more with its rim.

    Parameters
    ----------
    axes : matplotlib Axes
    mask : Mask
    """
    from matplotlib.colors import ListedColormap

    axes.imshow(
        mask.values,
        ListedColormap([OFF, ON]),
        vmin=0,
        vmax=1,
        extent=mask.extent_cm,
        interpolation="nearest",
        zorder=0,
    )
    if min(mask.pitch_cm) < 0.3:
        return
    (x, y), (px, py), (rows, columns) = mask.origin_cm, mask.pitch_cm, mask.shape
    right, bottom = x + columns * px, y + rows * py
    axes.vlines(x + px * np.arange(columns + 1), y, bottom, color="white", lw=0.4, zorder=1)
    axes.hlines(y + py * np.arange(rows + 1), x, right, color="white", lw=0.4, zorder=1)


def draw_points(axes: Axes, points: Points, label: str = "", color: str = FOUND) -> None:
    """Draw points as dots.

    Parameters
    ----------
    axes : matplotlib Axes
    points : Points
    label : str
    color : str
    """
    size = 4.0 if points.count < 120 else 1.5
    axes.plot(
        *points.xy_cm.T,
        "o",
        ms=size,
        color=color,
        label=label or None,
        zorder=3,
        rasterized=points.count > MOST_DRAWN,
    )


def draw_outline(
    axes: Axes, shape: Shape | Any, label: str = "", color: str = FOUND, dashed: bool = False
) -> None:
    """Draw a shape's outline.

    Parameters
    ----------
    axes : matplotlib Axes
    shape : Circle, Ellipse, Rectangle or Polygon
    label : str
    color : str
    dashed : bool
        As true outlines are drawn.
    """
    xy = shape.outline_cm()
    closed = np.vstack([xy, xy[:1]])
    axes.plot(
        *closed.T, color=color, lw=1.6, ls="--" if dashed else "-", label=label or None, zorder=4
    )


def draw_true(axes: Axes, shape: Shape | Any, label: str = "true outline") -> None:
    """Draw where the object truly lies.

    Parameters
    ----------
    axes : matplotlib Axes
    shape : Circle, Ellipse, Rectangle or Polygon
    label : str
    """
    draw_outline(axes, shape, label, TRUE, dashed=True)


def finish(
    figure: Figure, axes: Sequence[Axes], titles: Sequence[str], columns: int | None = None
) -> Figure:
    """Give the panels titles, axes in cm with y downwards, and one legend for all.

    Parameters
    ----------
    figure : matplotlib Figure
    axes : sequence of Axes
        Those that share their axes get the widest extent of any.
    titles : sequence of str
    columns : int, optional
        Panels in a row; all of them if not given.
    """
    columns = columns or len(axes)
    shared = len(axes) > 1 and axes[0].get_shared_x_axes().joined(axes[0], axes[1])
    handles: dict[str, Any] = {}
    for k, (one, title) in enumerate(zip(axes, titles, strict=True)):
        left, right, bottom, top = _extent(axes if shared else [one])
        one.set(xlim=(left, right), ylim=(bottom, top), aspect="equal")
        one.set_title(title, fontsize=10)
        one.locator_params(nbins=5, steps=[1, 2, 5, 10])
        if k % columns == 0 or not shared:
            one.set_ylabel("y / cm")
        if k + columns >= len(axes) or not shared:
            one.set_xlabel("x / cm")
        handles |= dict(zip(*reversed(one.get_legend_handles_labels()), strict=True))
    ncols = max(2 * columns - 1, 1)
    if shared or len(axes) == 1:
        ratio = (bottom - top) / (right - left)
        _fit_height(figure, columns, len(axes) // columns, ratio, 0.3 * -(-len(handles) // ncols))
    if handles:
        figure.legend(handles.values(), handles.keys(), loc="outside lower center", ncols=ncols)
    return figure


def _fit_height(figure: Figure, columns: int, rows: int, ratio: float, legend_in: float) -> None:
    """Make the figure as high as its panels of that height over width, and a legend, need."""
    width = figure.get_size_inches()[0]
    panel = (width - 0.6) / columns
    figure.set_size_inches(width, rows * (panel * ratio + 0.35) + 0.5 + legend_in)


def _extent(axes: Sequence[Axes]) -> tuple[float, float, float, float]:
    """Return left, right, bottom and top of all images, and of all lines with a margin."""
    edges = [im.get_extent() for one in axes for im in one.images]
    lines = [np.asarray(line.get_xydata()) for one in axes for line in one.lines]
    for xy in lines:
        (x0, y0), (x1, y1) = xy.min(axis=0), xy.max(axis=0)
        margin = 0.0 if edges else 0.5
        edges.append((x0 - margin, x1 + margin, y1 + margin, y0 - margin))
    found = np.array(edges)
    return (
        float(found[:, 0].min()),
        float(found[:, 1].max()),
        float(found[:, 2].max()),
        float(found[:, 3].min()),
    )
