"""Step ``open``: erosion, then dilation; removes what the structuring element does not fit in."""

from __future__ import annotations

from typing import Annotated

import numpy as np

from tactile_graph.steps.rules import Grid
from tactile_graph.wires import Mask
from tactile_graph.wires.stacks import MaskStack
from tactile_graph_filters.morphology.elements import ElementSetting, parse_element
from tactile_graph_filters.morphology.erosion import make_plan, sweep, swept


class Open:
    """Remove what the structuring element does not fit in: erosion, then dilation.

    Parameters
    ----------
    element : str or list of list of int
        The structuring element, as `erode` takes it.
    border : bool
        Whether cells outside the mask count as on.

    Notes
    -----
    Thesis section 3.1.3 and figure 3.5. The dilation takes the element turned by half a turn, so
    that opening never turns a cell on and opening twice is opening once, whatever the element.
    Done as on an endless plane: nothing is cut off between the two operations.
    """

    stateless = True

    def __init__(self, *, element: ElementSetting = "cross3", border: bool = False) -> None:
        parsed = parse_element(element)
        self._plan = make_plan(parsed, parsed.reflected, border=border)

    def __call__(self, mask: Mask) -> Annotated[Mask, Grid.like("mask")]:
        """Return the opened mask."""
        out = np.empty(mask.values.shape, np.bool_)
        count = sweep.call(mask.values, self._plan, out)
        return Mask(out, mask.pitch_cm, mask.origin_cm, count)

    def stacked(self, mask: MaskStack) -> MaskStack:
        """Return the opened masks of several frames."""
        return swept(mask, self._plan)
