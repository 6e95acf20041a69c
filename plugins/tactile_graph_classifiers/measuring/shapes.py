"""What an object's shape is called, and what the truth of a frame says of it."""

from __future__ import annotations

from tactile_graph.wires import Circle, Ellipse, Frame, Polygon, Rectangle

SHAPES = ("disc", "rectangle", "ellipse", "polygon")
_NAMES = {Circle: "disc", Rectangle: "rectangle", Ellipse: "ellipse", Polygon: "polygon"}


def true_shape(frame: Frame) -> str:
    """Return the shape of the one object that truly lay there; empty where nobody knows.

    Parameters
    ----------
    frame : Frame
    """
    truth = frame.truth or ()
    return _NAMES.get(type(truth[0].shape), "") if len(truth) == 1 else ""


def true_name(frame: Frame) -> str:
    """Return the name of the one object that truly lay there; empty where nobody knows.

    Parameters
    ----------
    frame : Frame
    """
    truth = frame.truth or ()
    return truth[0].name if len(truth) == 1 else ""
