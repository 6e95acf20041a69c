"""Section 4.3.5: whether a rectangle's boundary may be found before or after it is turned."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from tactile_graph import load
from tactile_graph_thesis.drawing.bars import bars
from tactile_graph_thesis.item import Finding, Item, Made, Table
from tactile_graph_thesis.measure.altered import altered
from tactile_graph_thesis.measure.rectangles import signed_errors
from tactile_graph_thesis.work import Work

Array = NDArray[np.float64]
TURNED_FIRST = {
    "turned": None,
    "rotated": {"step": "rotate_mask", "in": ["clean", "axis"]},
    "boundary": {"step": "boundary_scan", "in": "rotated"},
    "ellipse": {"step": "fit_ellipse_origin", "in": ["boundary", "axis"]},
}
"""Nodes of rectangle-1 that turn the image, cells rounded, before its boundary is found."""
READINGS = 150
"""Of each rectangle, at most."""
SAME_CM = 0.1
"""Of a length: the last digit of the thesis' tables."""


def _rotation_order(work: Work) -> Made:
    frames = work.frames("rectangles", 2 * work.readings)[: 2 * READINGS]
    ways = {
        "boundary first": load("rectangle-1"),
        "turned first": altered("rectangle-1", TURNED_FIRST),
    }
    errors = {way: signed_errors(p.runner(seed=work.seed), frames) for way, p in ways.items()}
    first, second = errors.values()
    moved = {name: second[name][:, 1:3] - first[name][:, 1:3] for name in first}
    groups = {
        f"{name}, {quantity}": {
            way: float(np.nanmean(np.abs(found[name][:, k]))) for way, found in errors.items()
        }
        for name in first
        for k, quantity in ((1, "length"), (2, "breadth"))
    }
    rows = [(what, *of.values()) for what, of in groups.items()]
    return Made(
        findings=(interchangeable(moved),),
        table=Table(("object and side", *(f"{way}_cm" for way in ways)), rows),
        figure=bars(groups, "mean error / cm", "Boundary and rotation in either order"),
    )


def interchangeable(moved_cm: dict[str, Array]) -> Finding:
    """Return whether the order of two blocks leaves length and breadth as they are.

    Parameters
    ----------
    moved_cm : dict
        Object -> by how much length and breadth change with the order, shape (readings, 2).
    """
    worst = {name: float(np.nanmean(np.abs(m[:, 0]))) for name, m in moved_cm.items()}
    largest = max(float(np.nanmean(np.abs(m), axis=0).max()) for m in moved_cm.values())
    words = ", ".join(f"{name} by {value:.2f} cm" for name, value in worst.items())
    return Finding(
        "finding the boundary and turning may be interchanged, the output remains unaffected",
        f"turned before, the length changes on average: {words}",
        f"a length or breadth that changes by more than {SAME_CM:g} cm on average",
        largest <= SAME_CM,
    )


ITEMS = (
    Item(
        "rotation-order",
        "Boundary and rotation interchanged",
        "Length and breadth of both rectangles with the boundary found before the image is turned, "
        "as in rectangle-1, and after.",
        _rotation_order,
        "Points turn exactly, an image only to the cell: its rounding moves whole rows of the "
        "boundary by up to an element.",
        after="4.3.5",
    ),
)
