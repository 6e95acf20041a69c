"""Step ``erode``: keep the cells around which the whole structuring element is on."""

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


class Erode:
    """Keep the cells around which the whole structuring element is on.

    Parameters
    ----------
    element : str or list of list of int
        The structuring element: ``cross3`` (the thesis' #1), ``disc5``, ``disc7``, ``square3``,
        ``square21``, any odd ``cross:N``, ``disc:N``, ``square:N``, or rows of 0 and 1.
    border : bool
        Whether cells outside the mask count as on. By default they do not, so that what reaches
        the edge of the pad is eroded from there too; the thesis does not say.

    Notes
    -----
    Thesis section 3.1.3, equation 3.3 (Jain 1989): the cells x for which the element, put with
    its centre on x, lies in the mask.
    """

    stateless = True

    def __init__(self, *, element: ElementSetting = "cross3", border: bool = False) -> None:
        self._element, self._border = parse_element(element), border
        self._plan = make_plan(self._element, border=border)
        self._around = None if border else around(self._element, dilate=False)

    def __call__(self, mask: Mask) -> Annotated[Mask, Grid.like("mask")]:
        """Return the eroded mask."""
        packed = None if self._around is None else combined_mask(mask, self._around)
        return swept_mask(mask, self._plan) if packed is None else packed

    def stacked(self, mask: MaskStack) -> MaskStack:
        """Return the eroded masks of several frames."""
        packed = None if self._border else combined(mask, self._element, dilate=False)
        return packed or swept(mask, self._plan)

    def linked(self) -> Linked | None:
        """Return the form for masks as machine code hands them on."""
        if self._around is None:
            return None
        return Linked(combined_parts, MaskParts, mask_of, (self._around,))
