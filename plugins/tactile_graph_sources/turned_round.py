"""Readings that fall under pressure, turned round so that they rise as all steps take them."""

from __future__ import annotations

from dataclasses import replace
from typing import Annotated

import numpy as np
from annotated_types import Interval

from tactile_graph.wires import Frame
from tactile_graph.wires.frame_stack import FrameStack
from tactile_graph.wires.stacks import ImageStack

Finite = Annotated[float, Interval(ge=-1e100, le=1e100)]


def inverted(some: Frame | FrameStack, invert_from: float) -> Frame | FrameStack:
    """Return frames whose values v are ``invert_from - v``; masks, yes or no, stay as they are.

    Parameters
    ----------
    some : Frame or FrameStack
    invert_from : float
        What the pad reads at rest, or full scale, in the unit of its readings.
    """
    if isinstance(some, Frame):
        return _inverted(some, invert_from)
    if some.frames is not None:
        return FrameStack.of([_inverted(frame, invert_from) for frame in some.frames])
    images = some.images
    if images.quantity == "binary":
        return some
    values = np.subtract(invert_from, images.values, dtype=np.float64)
    turned = ImageStack(values, images.pitch_cm, images.origin_cm, images.quantity, images.valid)
    return FrameStack(turned, some.index, some.time_s, None, some.place)


def _inverted(frame: Frame, invert_from: float) -> Frame:
    image = frame.image
    if image.quantity == "binary":
        return frame
    values = np.subtract(invert_from, image.values, dtype=np.float64)
    return replace(frame, image=image.with_values(values))
