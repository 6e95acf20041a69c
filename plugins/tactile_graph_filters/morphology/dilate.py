"""Step ``dilate``: turn on the cells around which the structuring element hits the mask."""

from __future__ import annotations

from typing import Annotated

from tactile_graph.steps import Linked
from tactile_graph.steps.rules import Grid
from tactile_graph.wires import Mask
from tactile_graph.wires.parts import MaskParts, mask_of
from tactile_graph.wires.stacks import MaskStack
from tactile_graph_filters.morphology.elements import ElementSetting, parse_element
from tactile_graph_filters.morphology.erosion import make_plan, swept, swept_mask
from tactile_graph_filters.morphology.packed import around, combined, combined_mask, combined_parts


class Dilate:
    """Turn on the cells around which the structuring element hits the mask.

    Parameters
    ----------
    element : str or list of list of int
        The structuring element, as `erode` takes it.
    border : bool
        Whether cells outside the mask count as on; the thesis does not say.

    Notes
    -----
    Thesis section 3.1.3, equation 3.4 (Jain 1989): the cells x for which the element, put with
    its centre on x, has a cell in common with the mask. The element is not turned round, which
    only matters for one that is not symmetric; `open` and `close` turn it for theirs.
    """

    stateless = True

    def __init__(self, *, element: ElementSetting = "cross3", border: bool = False) -> None:
        self._element, self._border = parse_element(element), border
        self._plan = make_plan(self._element, dilate=True, border=border)
        self._around = None if border else around(self._element, dilate=True)

    def __call__(self, mask: Mask) -> Annotated[Mask, Grid.like("mask")]:
        """Return the dilated mask."""
        packed = None if self._around is None else combined_mask(mask, self._around)
        return swept_mask(mask, self._plan) if packed is None else packed

    def stacked(self, mask: MaskStack) -> MaskStack:
        """Return the dilated masks of several frames."""
        packed = None if self._border else combined(mask, self._element, dilate=True)
        return packed or swept(mask, self._plan)

    def linked(self) -> Linked | None:
        """Return the form for masks as machine code hands them on."""
        if self._around is None:
            return None
        return Linked(combined_parts, MaskParts, mask_of, (self._around,))
