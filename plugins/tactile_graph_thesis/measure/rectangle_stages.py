"""The images of thesis figures 4.24 to 4.36, stage by stage, of one frame."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from tactile_graph.wires import Image, Mask, Points

if TYPE_CHECKING:
    from tactile_graph import Frame

PASSES = 8
"""Dilations and erosions of rectangle-2's pre-filter."""


class Stage(NamedTuple):
    """One image of a figure.

    Parameters
    ----------
    title : str
    shown : Image, Mask or Points
    """

    title: str
    shown: Image | Mask | Points


def rectangle_frame(seed: int = 0) -> Frame:
    """Return a reading of RECTANGLE II, which the thesis' figures show.

    Parameters
    ----------
    seed : int
    """
    from tactile_graph import load

    source = load("rectangle-2").with_source("simulate", scene="rectangle-2", frames=1)
    return next(iter(source.frames(seed)))


def rectangle_stages(frame: Frame) -> dict[str, tuple[Stage, ...]]:
    """Return the images of each figure from 4.24 to 4.36, but for block diagram 4.29.

    Parameters
    ----------
    frame : Frame
        With an object whose opened image is not empty.

    Returns
    -------
    dict
        Figure, such as ``"4.27"`` -> its images in the order of the text. Turned ones (4.28,
        4.30 to 4.33, 4.35, 4.36) lie along x about the footprint's centre, or about the origin
        where the mean was subtracted.

    Raises
    ------
    Failed
        Where the pipelines have no answer for the frame.

    Notes
    -----
    Figure 4.28 repeats the caption of 4.27; the text says that it is the boundary after turning.
    """
    from tactile_graph import load

    first = load("rectangle-1").runner(
        only=["footprint", "smooth", "clean", "axis", "boundary", "turned"]
    )(frame)
    second = load("rectangle-2").runner(
        only=["axis", "fine", "rotated", "filled", "opened", "boundary"]
    )(frame)
    coarse = load("rectangle-2").with_settings({"fine.factor": 1}).runner(only=["rotated"])(frame)
    axis = first["axis"]
    return {
        "4.24": (Stage("thresholded", first["footprint"]),),
        "4.25": (Stage("low pass filtered", first["smooth"]),),
        "4.26": (Stage("compared", first["clean"]),),
        "4.27": (Stage("boundary", first["boundary"]),),
        "4.28": (Stage("boundary, turned", first["turned"]),),
        "4.30": _rounding(first["footprint"], axis, coarse["rotated"]),
        "4.31": _rounding(second["fine"], axis, second["rotated"]),
        "4.32": (Stage("turned and rounded", second["rotated"]),),
        "4.33": (
            Stage("dilated", _dilated(second["rotated"])),
            Stage("then eroded", second["filled"]),
        ),
        "4.34": (Stage("structuring element, 21 x 21", _square(second["filled"])),),
        "4.35": (
            Stage("eroded", _eroded(second["filled"])),
            Stage("then dilated", second["opened"]),
        ),
        "4.36": (Stage("boundary", second["boundary"]),),
    }


def _rounding(mask: Mask, axis: Any, rounded: Mask) -> tuple[Stage, ...]:
    """Return an image as read, less its mean, turned, and turned and rounded."""
    from tactile_graph_fitters.orientation.rotate_points import rotate_points

    rows, columns = np.nonzero(mask.values)
    (x, y), (px, py) = mask.origin_cm, mask.pitch_cm
    at = np.column_stack([x + (columns + 0.5) * px, y + (rows + 0.5) * py])
    centre = (axis.x_cm, axis.y_cm)
    return (
        Stage("original", mask),
        Stage("less the mean", Points(at - centre)),
        Stage("turned", Points(rotate_points(Points(at), axis).xy_cm - centre)),
        Stage(
            "turned and rounded",
            Mask(
                rounded.values,
                rounded.pitch_cm,
                (rounded.origin_cm[0] - centre[0], rounded.origin_cm[1] - centre[1]),
            ),
        ),
    )


def _dilated(mask: Mask) -> Mask:
    from tactile_graph_filters.morphology.dilate import Dilate

    margin = PASSES
    (x, y), (px, py) = mask.origin_cm, mask.pitch_cm
    out = Mask(np.pad(mask.values, margin), mask.pitch_cm, (x - margin * px, y - margin * py))
    dilate = Dilate(element="cross3")
    for _ in range(PASSES):
        out = dilate(out)
    return out


def _eroded(mask: Mask) -> Mask:
    from tactile_graph_filters.morphology.erode import Erode

    return Erode(element="square21")(mask)


def _square(like: Mask) -> Mask:
    from tactile_graph_filters.morphology.elements import parse_element

    return Mask(parse_element("square21").cells, like.pitch_cm, (0.0, 0.0))
