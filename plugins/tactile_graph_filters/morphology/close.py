"""Step ``close``: dilation, then erosion; fills what the structuring element does not fit in."""

from __future__ import annotations

from typing import Annotated

import numpy as np
from annotated_types import Ge, Le

from tactile_graph.steps.rules import Grid
from tactile_graph.wires import Mask
from tactile_graph.wires.stacks import MaskStack
from tactile_graph_filters.morphology.elements import LARGEST, ElementSetting, parse_element
from tactile_graph_filters.morphology.erosion import make_plan, sweep, swept


class Close:
    """Fill the gaps that the structuring element does not fit in: dilation, then erosion.

    Parameters
    ----------
    element : str or list of list of int
        The structuring element, as `erode` takes it.
    times : int
        How often it dilates, before it erodes as often: the gaps that are filled grow by as much.
    border : bool
        Whether cells outside the mask count as on.

    Raises
    ------
    ValueError
        If the element repeated so often is longer than `LARGEST`.

    Notes
    -----
    Thesis sections 3.1.3 ("can be performed iteratively") and 4.3.9 (filling voids). The dilation
    takes the element turned by half a turn, so that closing never turns a cell off and closing
    twice is closing once, whatever the element. Done as on an endless plane: the dilation may run
    over the edge of the pad, or a footprint at the edge would be eaten there.
    """

    stateless = True

    def __init__(
        self,
        *,
        element: ElementSetting = "cross3",
        times: Annotated[int, Ge(1), Le(LARGEST)] = 1,
        border: bool = False,
    ) -> None:
        parsed = parse_element(element).repeated(times)
        self._plan = make_plan(parsed.reflected, parsed, dilate=True, border=border)

    def __call__(self, mask: Mask) -> Annotated[Mask, Grid.like("mask")]:
        """Return the closed mask."""
        out = np.empty(mask.values.shape, np.bool_)
        count = sweep.call(mask.values, self._plan, out)
        return Mask(out, mask.pitch_cm, mask.origin_cm, count)

    def stacked(self, mask: MaskStack) -> MaskStack:
        """Return the closed masks of several frames."""
        return swept(mask, self._plan)
