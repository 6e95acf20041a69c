"""Figures 4.18, 4.20 and 4.21: where the boundary fails, and what the convex hull makes of it."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from tactile_graph import Frame, Mask, Points
from tactile_graph_thesis.drawing.circle_fits import fit_figure
from tactile_graph_thesis.drawing.panels import (
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
    DISCS,
    ONE_DISC,
    failing_disc,
    radius_errors,
    readings_of,
    stages,
    true_shape,
    typical_disc,
)
from tactile_graph_thesis.work import Work

Array = NDArray[np.float64]
BAD_CM = 1.0
"""Error of the radius from which a boundary is bad: about an element."""


def _figure_4_18(work: Work) -> Made:
    frame = failing_disc(work)
    result = stages("circle-2", frame, work.seed)
    figure, axes = panels(2)
    shown = draw_image(axes[0], frame.image)
    figure.colorbar(shown, ax=axes[0], label="output / V", shrink=0.8)
    draw_mask(axes[1], result["dilated"])
    draw_points(axes[1], result["boundary"], "boundary")
    for one in axes:
        draw_true(one, true_shape(frame))
    return Made(figure=finish(figure, axes, ["as read", "boundary of circle-2"]))


def _figure_4_20(work: Work) -> Made:
    errors = [
        radius_errors(work, readings_of(work, "discs", name), name, pipeline)
        for name in DISCS
        for pipeline in ("circle-2", "circle-3")
    ]
    without, hull = (np.concatenate(errors[k::2]) for k in (0, 1))
    return Made(
        findings=(betters_bad_boundaries(without, hull),),
        figure=fit_figure(failing_disc(work), ("circle-2", "circle-3"), work.seed),
    )


def betters_bad_boundaries(without_cm: Array, hull_cm: Array) -> Finding:
    """Return whether the hull betters the radius wherever a boundary is bad.

    Parameters
    ----------
    without_cm, hull_cm : ndarray, shape (readings,)
        Errors of the radius on the same readings without and with the hull.
    """
    bad = without_cm > BAD_CM
    better = int((hull_cm[bad] < 0.5 * without_cm[bad]).sum())
    n = int(bad.sum())
    return Finding(
        "the hull of a bad boundary is more circular, and so is what is fitted to it",
        f"{n} of {len(bad)} readings have a radius off by more than {BAD_CM:g} cm without the "
        f"hull; of these it at least halves the error of {better}",
        "one in ten of these whose error is not halved, or no such reading",
        n > 0 and better > 0.9 * n,
    )


def _figure_4_21(work: Work) -> Made:
    nodes = ("as read", "eroded", "dilated", "boundary", "hull")
    figure, axes = panels(len(nodes), len(DISCS), 2.3)
    titles = []
    for row, name in enumerate(DISCS):
        frame = typical_disc(work, name)
        result = stages("circle-3", frame, work.seed)
        for one, node in zip(axes[row * len(nodes) :], nodes, strict=False):
            _stage(one, frame, result, node)
            titles.append(f"{name}: {node}")
    return Made(figure=finish(figure, axes, titles, len(nodes)))


def _stage(axes: Any, frame: Frame, result: Any, node: str) -> None:
    draw_true(axes, true_shape(frame))
    value = frame.image if node == "as read" else result[node]
    if isinstance(value, Mask):
        draw_mask(axes, value)
    elif isinstance(value, Points):
        draw_points(axes, value)
    elif node == "hull":
        draw_outline(axes, value, "convex hull", OTHER)
        draw_outline(axes, result["circle"], "circle found")
    else:
        draw_image(axes, value)


ITEMS = (
    Item(
        "figure-4.18",
        "Where the boundary fails",
        "A reading with lost elements at the rim, and the boundary found.",
        _figure_4_18,
        "The reading is the one, of those tried, where the hull betters the radius most.",
    ),
    block_diagram("4.19", "circle-3", "Blocks of the third circular localisation"),
    Item(
        "figure-4.20",
        "Convex hull of a bad boundary",
        "The same reading without and with the convex hull.",
        _figure_4_20,
        "The reading of figure 4.18. The thesis fits to the corners of the hull alone, as here.",
    ),
    Item(
        "figure-4.21",
        "All stages for all discs",
        "Each disc of table 4.2 after each block of circle-3.",
        _figure_4_21,
        ONE_DISC,
    ),
)
