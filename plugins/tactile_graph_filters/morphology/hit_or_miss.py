"""Step ``hit_or_miss``: find the cells whose surroundings look exactly as asked for."""

from __future__ import annotations

from typing import Annotated

import numpy as np

from tactile_graph.steps.rules import Grid
from tactile_graph.wires import Mask
from tactile_graph_filters.morphology.elements import Element, ElementSetting, parse_element
from tactile_graph_filters.morphology.erosion import make_plan, sweep


class HitOrMiss:
    """Find the cells around which ``hit`` is all on and ``miss`` all off.

    Parameters
    ----------
    hit : str or list of list of int
        The cells that must be on, as `erode` takes an element.
    miss : str or list of list of int, optional
        The cells that must be off, of any odd size; every other cell of ``hit``'s square or
        rectangle where it is not given (an exact match, thesis section 4.2.2).
    border : bool
        Whether cells outside the mask count as on.

    Raises
    ------
    ValueError
        If a cell is asked to be on and off at once.

    Notes
    -----
    Thesis section 3.1.3: the erosion of the mask by ``hit`` and of its complement by ``miss``.
    """

    stateless = True

    def __init__(
        self, *, hit: ElementSetting, miss: ElementSetting | None = None, border: bool = False
    ) -> None:
        on = parse_element(hit)
        off = _others(on) if miss is None else parse_element(miss)
        both = {(y, x) for y, x in on.offsets.tolist()} & {
            (y, x) for y, x in (off.offsets.tolist() if off else [])
        }
        if both:
            down, right = min(both)
            raise ValueError(
                f"hit and miss both hold the cell {down} down and {right} right of the centre:"
                " it cannot be on and off"
            )
        self._hit = make_plan(on, border=border)
        # Off everywhere around = the complement of a dilation.
        self._miss = None if off is None else make_plan(off, dilate=True, border=border)

    def __call__(self, mask: Mask) -> Annotated[Mask, Grid.like("mask")]:
        """Return the mask of the cells that match."""
        out = np.empty(mask.values.shape, np.bool_)
        sweep(mask.values, self._hit, out)
        if self._miss is not None:
            hit_by_miss = np.empty(mask.values.shape, np.bool_)
            sweep(mask.values, self._miss, hit_by_miss)
            np.greater(out, hit_by_miss, out=out)
        return Mask(out, mask.pitch_cm, mask.origin_cm)


def _others(element: Element) -> Element | None:
    cells = ~element.cells
    return Element("others", cells) if cells.any() else None
