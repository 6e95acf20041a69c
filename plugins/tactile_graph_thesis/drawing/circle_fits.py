"""What circles are fitted to, and the circles, a panel for each pipeline."""

from __future__ import annotations

from typing import TYPE_CHECKING

from tactile_graph import Frame
from tactile_graph_thesis.drawing.panels import (
    BOUNDARY,
    OTHER,
    draw_mask,
    draw_outline,
    draw_points,
    draw_true,
    finish,
    panels,
)
from tactile_graph_thesis.measure.shown_reading import stages, true_shape

if TYPE_CHECKING:
    from matplotlib.figure import Figure


def fit_figure(frame: Frame, pipelines: tuple[str, ...], seed: int) -> Figure:
    """Return a figure of what circles are fitted to, a panel for each pipeline.

    Parameters
    ----------
    frame : Frame
    pipelines : tuple of str
    seed : int
    """
    figure, axes = panels(len(pipelines))
    titles = []
    for one, name in zip(axes, pipelines, strict=True):
        result = stages(name, frame, seed)
        draw_mask(one, result["dilated"])
        draw_points(one, result["boundary"], "boundary", BOUNDARY)
        if "hull" in result:
            draw_outline(one, result["hull"], "convex hull", OTHER)
        draw_outline(one, result["circle"], "circle found")
        draw_true(one, true_shape(frame))
        off = result["circle"].radius_cm - true_shape(frame).radius_cm
        titles.append(f"{name}: radius off by {off:+.2f} cm")
    return finish(figure, axes, titles)
