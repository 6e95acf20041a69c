"""Section 6.1.3: an ellipse fitted at every orientation, against rectangle-1."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
from numpy.typing import NDArray

from tactile_graph import Frame, load
from tactile_graph_thesis.drawing.bars import bars
from tactile_graph_thesis.item import Finding, Item, Made, Table
from tactile_graph_thesis.items.chapter_4.figures_4_22_to_4_28_rectangles import with_strays
from tactile_graph_thesis.measure.rectangles import angle_error_degree
from tactile_graph_thesis.measure.shown_reading import true_shape
from tactile_graph_thesis.work import Work

Array = NDArray[np.float64]
READINGS = 100
"""Of each rectangle, at most."""
WAYS = {"swept": "every five degrees", "direct": "algebraic", "geometric": "by distance"}
"""Nodes of ellipse-direct, and how each fits."""


def _direct(work: Work) -> Made:
    frames = work.frames("rectangles", 2 * work.readings)[: 2 * READINGS]
    noisy = [with_strays(frame, work.seed + k) for k, frame in enumerate(frames)]
    clean, strays = (angle_errors(some, work.seed) for some in (frames, noisy))
    groups = {
        f"{name}, {words}": {way: float(np.nanmean(e[of])) for way, e in found.items()}
        for name, of in (("RECTANGLE I", slice(0, None, 2)), ("RECTANGLE II", slice(1, None, 2)))
        for words, found in (("as read", clean), ("with noise points", strays))
    }
    rows = [(what, *of.values()) for what, of in groups.items()]
    return Made(
        findings=(
            no_worse(clean["rectangle-1"], clean["swept"]),
            less_sensitive(
                *(
                    float(np.nanmean(e[way]))
                    for way in ("rectangle-1", "swept")
                    for e in (clean, strays)
                )
            ),
        ),
        table=Table(("object", *(f"{way}_degree" for way in clean)), rows),
        figure=bars(groups, "mean error of the angle / degree", "Orientation first, or swept"),
        notes=("Fits of ellipse-direct: " + ", ".join(f"{k} {v}" for k, v in WAYS.items()) + ".",),
    )


def angle_errors(frames: list[Frame], seed: int) -> dict[str, Array]:
    """Return sizes of the angle's errors, by way, in degrees; NaN without an answer.

    Parameters
    ----------
    frames : list of Frame
    seed : int
    """
    first, second = (load(name).runner(seed=seed) for name in ("rectangle-1", "ellipse-direct"))
    rows = []
    for frame in frames:
        true, ours, theirs = true_shape(frame), first(frame), second(frame)
        axis = math.nan if ours.get("rectangle") is None else abs(angle_error_degree(ours, true))
        rows.append((axis, *(_off(theirs.get(way), true) for way in WAYS)))
    return dict(zip(("rectangle-1", *WAYS), np.array(rows).T, strict=True))


def _off(found: Any, true: Any) -> float:
    shape = getattr(found, "ellipse", found)
    if shape is None or not hasattr(shape, "angle_rad"):
        return math.nan
    return abs(math.degrees(math.remainder(shape.angle_rad - true.angle_rad, math.pi)))


def no_worse(axis_degree: Array, swept_degree: Array) -> Finding:
    """Return whether sweeping gives an angle at least as good.

    Parameters
    ----------
    axis_degree, swept_degree : ndarray, shape (readings,)
        Sizes of the errors on the same readings.
    """
    one, other = float(np.nanmean(axis_degree)), float(np.nanmean(swept_degree))
    return Finding(
        "(not in the thesis) an ellipse fitted at every orientation gives as good an angle",
        f"mean error {other:.1f} degrees swept, {one:.1f} by rectangle-1",
        "a tenth more",
        other <= 1.1 * one,
    )


def less_sensitive(axis: float, axis_noisy: float, swept: float, swept_noisy: float) -> Finding:
    """Return whether noise makes less of a difference to the swept angle.

    Parameters
    ----------
    axis, axis_noisy, swept, swept_noisy : float
        Mean errors in degrees by rectangle-1 and swept, as read and with noise points.
    """
    return Finding(
        "a direct fit eliminates the sensitivity of the orientation to noise",
        f"noise points add {swept_noisy - swept:.1f} degrees to the mean error swept, "
        f"{axis_noisy - axis:.1f} by rectangle-1",
        "half as much added or more",
        swept_noisy - swept < 0.5 * (axis_noisy - axis),
    )


ITEMS = (
    Item(
        "direct-ellipse",
        "Ellipses fitted without an orientation found before",
        "Errors of the angle by rectangle-1 and by the fits of ellipse-direct, as read and with "
        "noise points switched on.",
        _direct,
        "The thesis proposes the fit and has not tried it. An ellipse follows the outermost points "
        "of a boundary with gaps, the axis all cells.",
        after="6.1.3",
    ),
)
