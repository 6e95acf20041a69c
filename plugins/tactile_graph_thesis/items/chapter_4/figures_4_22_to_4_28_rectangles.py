"""Figures 4.22 to 4.28: a rectangle on its way through rectangle-1."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from tactile_graph import Degenerate, Frame, Image, Mask
from tactile_graph_fitters.rectangle.fit_rectangle import fit_rectangle
from tactile_graph_thesis.drawing.panels import (
    BOUNDARY,
    OTHER,
    draw_image,
    draw_mask,
    draw_outline,
    draw_points,
    draw_true,
    finish,
    panels,
)
from tactile_graph_thesis.item import Finding, Item, Made
from tactile_graph_thesis.items.block_diagram import block_diagram
from tactile_graph_thesis.measure.shown_reading import (
    ONE_RECTANGLE,
    RECTANGLES,
    readings_of,
    setting,
    stages,
    true_shape,
    typical_rectangle,
)
from tactile_graph_thesis.work import Work

STRAYS = 0.04
"""Share of the elements off the object that are switched on for figure 4.26."""


def lone_cells(mask: Mask) -> int:
    """Return how many cells that are on touch no other, not even at a corner.

    Parameters
    ----------
    mask : Mask
    """
    padded = np.pad(mask.values, 1).astype(int)
    rows, columns = mask.shape
    around = sum(padded[i : i + rows, j : j + columns] for i in (0, 1, 2) for j in (0, 1, 2))
    return int((mask.values & (around == 1)).sum())


def _figure_4_22(work: Work) -> Made:
    frame = typical_rectangle(work)
    result = stages("rectangle-1", frame, work.seed)
    figure, (axes,) = panels(1, panel_in=4.6)
    draw_points(axes, result["boundary"], "boundary", "0.4")
    draw_outline(axes, result["ellipse"], "ellipse")
    draw_outline(axes, fit_rectangle(result["boundary"]), "rectangle", OTHER)
    draw_true(axes, true_shape(frame))
    finish(figure, [axes], ["fitted to the same boundary"])
    off = {k: float(np.mean(v)) for k, v in _length_errors(work).items()}
    return Made(
        findings=(
            Finding(
                "there is little gain in a rectangle over an ellipse",
                f"mean length error {off['ellipse']:.2f} cm of the ellipse's full axis, "
                f"{off['rectangle']:.2f} cm of a rectangle fitted to the same points",
                "half the error or less by the rectangle",
                off["rectangle"] > 0.5 * off["ellipse"],
            ),
        ),
        figure=figure,
    )


def _length_errors(work: Work) -> dict[str, list[float]]:
    """Return length errors of an ellipse and of a rectangle fitted to the same boundaries."""
    errors: dict[str, list[float]] = {"ellipse": [], "rectangle": []}
    for frame in readings_of(work, "rectangles", RECTANGLES[1]):
        result, true = stages("rectangle-1", frame, work.seed), true_shape(frame).length_cm
        try:
            length = fit_rectangle(result["boundary"]).length_cm
        except Degenerate:
            continue
        errors["ellipse"].append(abs(2.0 * result["ellipse"].semi_major_cm - true))
        errors["rectangle"].append(abs(length - true))
    return errors


def _figure_4_24(work: Work) -> Made:
    frame = typical_rectangle(work)
    mask = stages("rectangle-1", frame, work.seed)["footprint"]
    figure, axes = panels(2)
    shown = draw_image(axes[0], frame.image)
    figure.colorbar(shown, ax=axes[0], label="output / V", shrink=0.8)
    draw_mask(axes[1], mask)
    for one in axes:
        draw_true(one, true_shape(frame))
    return Made(figure=finish(figure, axes, ["as read", f"above 0.01 V, {mask.count} cells"]))


def _figure_4_25(work: Work) -> Made:
    frame = typical_rectangle(work)
    result = stages("rectangle-1", frame, work.seed)
    smooth, footprint = result["smooth"], result["footprint"]
    figure, axes = panels(1, panel_in=4.0)
    shown = draw_image(axes[0], smooth, 1.0)
    figure.colorbar(shown, ax=axes, label="share of the 3 × 3 cells that are on", shrink=0.8)
    draw_true(axes[0], true_shape(frame))
    return Made(
        findings=(much_bigger(smooth, footprint),), figure=finish(figure, axes, ["low pass"])
    )


def much_bigger(smooth: Image, footprint: Mask) -> Finding:
    """Return whether a filtered footprint covers many more cells.

    Parameters
    ----------
    smooth : Image
    footprint : Mask
    """
    grown = int((smooth.values > 1e-9).sum())
    return Finding(
        "the filtered image is much bigger than the original",
        f"{grown} cells are not 0, {footprint.count} were on",
        "three tenths more cells or fewer",
        grown > 1.3 * footprint.count,
    )


def with_strays(frame: Frame, seed: int) -> Frame:
    """Return the reading with some elements off the object that read as if they were touched.

    Parameters
    ----------
    frame : Frame
    seed : int
        Of which elements.
    """
    image = frame.image
    off = image.values < setting("rectangle-1", "footprint", "level_v")
    drawn = np.random.default_rng(seed).random(image.shape) < STRAYS
    values = np.where(off & drawn, np.median(image.values[~off]), image.values)
    return replace(frame, image=image.with_values(values))


def _figure_4_26(work: Work) -> Made:
    frame = with_strays(typical_rectangle(work), work.seed)
    result = stages("rectangle-1", frame, work.seed)
    before, after = result["footprint"], result["clean"]
    figure, axes = panels(2)
    for one, mask in zip(axes, (before, after), strict=True):
        draw_mask(one, mask)
        draw_true(one, true_shape(frame))
    finish(figure, axes, [f"footprint, {before.count} cells", f"compared, {after.count} cells"])
    return Made(
        findings=(keeps_size_and_cleans(before, after),),
        figure=figure,
        notes=(f"{100 * STRAYS:.0f} % of the elements off the object are switched on.",),
    )


def keeps_size_and_cleans(before: Mask, after: Mask) -> Finding:
    """Return whether a comparison takes lone cells away and hardly any other.

    Parameters
    ----------
    before, after : Mask
    """
    lone, left = lone_cells(before), lone_cells(after)
    others = (after.count - left) / max(before.count - lone, 1)
    return Finding(
        "the comparison keeps the size of the footprint and takes noise points away",
        f"of {before.count - lone} cells that touch others {100 * others:.0f} % stay; {lone} "
        f"touched no other, {left} do now",
        "a tenth of the cells that touch others gone, or half of the lone ones left",
        others > 0.9 and left < 0.5 * lone,
    )


def _figure_4_27(work: Work) -> Made:
    frame = typical_rectangle(work)
    result = stages("rectangle-1", frame, work.seed)
    figure, axes = panels(1, panel_in=4.0)
    draw_mask(axes[0], result["clean"])
    draw_points(axes[0], result["boundary"], "boundary", BOUNDARY)
    draw_true(axes[0], true_shape(frame))
    return Made(figure=finish(figure, axes, [f"{result['boundary'].count} boundary points"]))


def _figure_4_28(work: Work) -> Made:
    frame = typical_rectangle(work)
    result = stages("rectangle-1", frame, work.seed)
    axis, ellipse = result["axis"], result["ellipse"]
    turned = replace(ellipse, angle_rad=ellipse.angle_rad - axis.angle_rad)
    figure, axes = panels(1, panel_in=4.0)
    draw_points(axes[0], result["turned"], "boundary, turned")
    draw_outline(axes[0], turned, "ellipse found", OTHER)
    off = result["rectangle"].length_cm - true_shape(frame).length_cm
    title = f"turned by {-axis.angle_deg:.0f}°: major axis off by {off:+.1f} cm"
    return Made(figure=finish(figure, axes, [title]))


ITEMS = (
    Item(
        "figure-4.22",
        "An ellipse or a rectangle?",
        "Both fitted to the same boundary of a rectangle.",
        _figure_4_22,
        ONE_RECTANGLE
        + " The thesis judges by its one picture; the errors here are means over many "
        "readings of the same rectangle. The pipeline rectangle-3, which weighs the load of every "
        "cell, gains more still.",
    ),
    block_diagram("4.23", "rectangle-1", "Blocks of the first rectangular localisation"),
    Item(
        "figure-4.24",
        "Footprint of a rectangle",
        "RECTANGLE II as read, and above the threshold.",
        _figure_4_24,
        ONE_RECTANGLE,
    ),
    Item(
        "figure-4.25",
        "After the low pass",
        "The mean of each 3 × 3 cells of the footprint.",
        _figure_4_25,
        ONE_RECTANGLE,
    ),
    Item(
        "figure-4.26",
        "After comparing",
        "What both the footprint and the filtered image hold.",
        _figure_4_26,
        ONE_RECTANGLE
        + " The simulated pad has no noise points, which this block is to take away: some are "
        "added, as large a share as best explains tables 4.7 and 4.8. The thesis does not give the "
        "level above which the filtered image counts.",
    ),
    Item(
        "figure-4.27",
        "Boundary of a rectangle",
        "The boundary of figure 4.24 after the comparison.",
        _figure_4_27,
        ONE_RECTANGLE,
    ),
    Item(
        "figure-4.28",
        "Boundary, turned",
        "The boundary turned until the major axis lies along x, and the ellipse fitted to it.",
        _figure_4_28,
        ONE_RECTANGLE,
    ),
)
