"""Step ``and_compare``: the cells that are on in both of two masks or images."""

from __future__ import annotations

from typing import Annotated, Any

import numpy as np
from numpy.typing import NDArray

from tactile_graph.steps.rules import Grid, require_same_shape
from tactile_graph.wires import Image, Mask
from tactile_graph_filters.thresholds.threshold import footprint


def and_compare(
    first: Image | Mask,
    second: Annotated[Image | Mask, Grid.like("first")],
    *,
    level: float = 0.5,
) -> Annotated[Mask, Grid.like("first")]:
    """Return the mask of the cells that are on in both.

    Parameters
    ----------
    first, second : Image or Mask
        On the same grid.
    level : float
        From which value on a valid cell of an image is on. A low-passed mask holds the share of
        the window that was on, so that 0.5 asks for half of it.

    Returns
    -------
    Mask

    Raises
    ------
    RuleError
        If the two differ in shape.

    Notes
    -----
    Thesis section 4.3.3, figure 4.26: the thresholded image and the same after the low pass
    keep the size of the former and lose its lone noise cells.
    """
    require_same_shape(first=first, second=second)
    mask = np.logical_and(_on(first, level), _on(second, level))
    return Mask(mask, first.pitch_cm, first.origin_cm)


def _on(image: Image | Mask, level: float) -> NDArray[Any]:
    return image.values if isinstance(image, Mask) else footprint(image, level).values
