"""Figures 4.6 to 4.17: a disc on its way through circle-1 and circle-2."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np

from tactile_graph import Frame, Mask
from tactile_graph_thesis.drawing.circle_fits import fit_figure
from tactile_graph_thesis.drawing.elements import elements_figure
from tactile_graph_thesis.drawing.panels import (
    draw_image,
    draw_mask,
    draw_true,
    finish,
    panels,
)
from tactile_graph_thesis.item import Finding, Item, Made
from tactile_graph_thesis.items.block_diagram import block_diagram
from tactile_graph_thesis.measure.shown_reading import (
    ONE_DISC,
    RECTANGLES,
    setting,
    stages,
    true_shape,
    typical_disc,
    typical_rectangle,
)
from tactile_graph_thesis.work import Work


def _mask_figure(masks: dict[str, Mask], frame: Frame) -> Any:
    """Return a figure of masks side by side, each under its title, with the true outline."""
    figure, axes = panels(len(masks))
    for one, mask in zip(axes, masks.values(), strict=True):
        draw_mask(one, mask)
        draw_true(one, true_shape(frame))
    titles = [f"{title}, {m.area_cm2:.0f} cm²" for title, m in masks.items()]
    return finish(figure, axes, titles)


def _masks(pipeline: str, **nodes: str) -> Callable[[Work], Made]:
    """Return a function that draws nodes of a pipeline, by node and title."""

    def make(work: Work) -> Made:
        frame = typical_disc(work)
        result = stages(pipeline, frame, work.seed)
        return Made(figure=_mask_figure({t: result[n] for n, t in nodes.items()}, frame))

    return make


# -- what is on the pad ----------------------------------------------------------------------


def _figure_4_6(work: Work) -> Made:
    frames = {"a disc": typical_disc(work), "a rectangle": typical_rectangle(work, RECTANGLES[0])}
    figure, axes = panels(2)
    for one, frame in zip(axes, frames.values(), strict=True):
        shown = draw_image(one, frame.image)
        draw_true(one, true_shape(frame))
        figure.colorbar(shown, ax=one, label="output / V", shrink=0.8)
    return Made(figure=finish(figure, axes, list(frames)))


def _figure_4_8(work: Work) -> Made:
    frame = typical_disc(work)
    figure, axes = panels(2)
    shown = draw_image(axes[0], frame.image)
    figure.colorbar(shown, ax=axes[0], label="output / V", shrink=0.8)
    mask = stages("circle-1", frame, work.seed)["footprint"]
    draw_mask(axes[1], mask)
    for one in axes:
        draw_true(one, true_shape(frame))
    titles = ["as read", f"above 0.01 V, {mask.count} cells"]
    return Made(figure=finish(figure, axes, titles))


def _figure_4_9(work: Work) -> Made:
    figure = elements_figure(
        {
            "#1 of circle-1": setting("circle-1", "eroded", "element"),
            "#2 of circle-2 and circle-3": setting("circle-2", "eroded", "element"),
        }
    )
    return Made(figure=figure)


# -- circle-1 and circle-2 -------------------------------------------------------------------


def _figure_4_10(work: Work) -> Made:
    frame = typical_disc(work)
    result = stages("circle-1", frame, work.seed)
    before, after = result["footprint"], result["eroded"]
    return Made(
        findings=(quite_small(before, after),),
        figure=_mask_figure({"before": before, "eroded": after}, frame),
    )


def quite_small(before: Mask, after: Mask) -> Finding:
    """Return whether an image is quite small beside what it was.

    Parameters
    ----------
    before, after : Mask
    """
    one, other = before.area_cm2, after.area_cm2
    return Finding(
        "erosion leaves an image quite small beside the original",
        f"{one:.0f} cm² before, {other:.0f} cm² after, {100 * other / one:.0f} %",
        "half of the area or more left",
        other < 0.5 * one,
    )


def _figure_4_12(work: Work) -> Made:
    from tactile_graph_hull.boundary_scan import seen_cells

    frame = typical_disc(work)
    dilated = stages("circle-1", frame, work.seed)["dilated"]
    scans = [("left",), ("right",), ("top",), ("bottom",), ("left", "right", "top", "bottom")]
    figure, axes = panels(3, 2)
    draw_mask(axes[0], dilated)
    titles = ["dilated"]
    for one, some in zip(axes[1:], scans, strict=True):
        seen = dilated.with_values(seen_cells(dilated.values, some))
        draw_mask(one, seen)
        titles.append(f"{some[0] if len(some) == 1 else 'all four'}, {seen.count} cells")
    for one in axes:
        draw_true(one, true_shape(frame))
    return Made(figure=finish(figure, axes, titles, 3))


def _figure_4_13(work: Work) -> Made:
    from tactile_graph_filters.morphology.subdivide import subdivide

    mask = Mask(np.array([[False, True], [True, True]]), (1.3, 1.3))
    figure, axes = panels(2)
    draw_mask(axes[0], mask)
    draw_mask(axes[1], subdivide(mask, factor=2))
    return Made(figure=finish(figure, axes, ["four elements", "each cut in four"]))


def _figure_4_15(work: Work) -> Made:
    frame = typical_disc(work)
    one, two = (stages(p, frame, work.seed)["eroded"] for p in ("circle-1", "circle-2"))
    return Made(
        findings=(more_is_left(one, two),),
        figure=_mask_figure({"by element #1": one, "by element #2": two}, frame),
    )


def more_is_left(one: Mask, two: Mask) -> Finding:
    """Return whether a second mask holds more of the footprint, on cells of another size.

    Parameters
    ----------
    one, two : Mask
    """
    return Finding(
        "element #2 leaves more of the footprint than element #1",
        f"{two.count} cells of {two.cell_area_cm2:.2f} cm² against {one.count} of "
        f"{one.cell_area_cm2:.2f} cm²: {two.area_cm2:.0f} and {one.area_cm2:.0f} cm²",
        "no more area; cells of a quarter the size are more in any case",
        two.area_cm2 > one.area_cm2,
    )


def _figure_4_17(work: Work) -> Made:
    frame = typical_disc(work)
    return Made(figure=fit_figure(frame, ("circle-2",), work.seed))


_LOST = "The thesis' drawing of element #2 is lost: the digital disc of five cells stands for it."

ITEMS = (
    Item(
        "figure-4.6",
        "A disc and a rectangle as read",
        "Typical readings: which is which is hard to say.",
        _figure_4_6,
        ONE_DISC,
    ),
    block_diagram("4.7", "circle-1", "Blocks of the first circular localisation"),
    Item(
        "figure-4.8",
        "Footprint of a disc",
        "DISC I as read, and above the threshold.",
        _figure_4_8,
        ONE_DISC,
    ),
    Item(
        "figure-4.9",
        "Structuring elements of the discs",
        "The two elements of the first and the later algorithms.",
        _figure_4_9,
        _LOST,
    ),
    Item(
        "figure-4.10",
        "After erosion",
        "The footprint of figure 4.8 eroded by element #1.",
        _figure_4_10,
        ONE_DISC,
    ),
    Item(
        "figure-4.11",
        "After dilation",
        "The same dilated: voids are filled or reshaped.",
        _masks("circle-1", footprint="footprint", dilated="dilated"),
        ONE_DISC,
    ),
    Item(
        "figure-4.12",
        "Boundary, scan by scan",
        "The first cells met from the left, right, top and bottom, and all together.",
        _figure_4_12,
        ONE_DISC,
    ),
    Item(
        "figure-4.13",
        "Elements cut in four",
        "Each part inherits the state of its element.",
        _figure_4_13,
    ),
    block_diagram("4.14", "circle-2", "Blocks of the second circular localisation"),
    Item(
        "figure-4.15",
        "After erosion by element #2",
        "The footprint of figure 4.8, cut in four, eroded by element #2, beside figure 4.10.",
        _figure_4_15,
        ONE_DISC + " " + _LOST,
    ),
    Item(
        "figure-4.16",
        "After dilation by element #2",
        "The same dilated.",
        _masks("circle-2", fine="footprint, cut in four", dilated="dilated"),
        ONE_DISC + " " + _LOST,
    ),
    Item(
        "figure-4.17",
        "Boundary found by the second algorithm",
        "Boundary of figure 4.16 and the circle fitted to it.",
        _figure_4_17,
        ONE_DISC,
    ),
)
