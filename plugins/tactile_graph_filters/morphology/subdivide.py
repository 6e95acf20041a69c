"""Step ``subdivide``: each cell of a mask cut into N x N cells that inherit its state."""

from __future__ import annotations

from typing import Annotated

import numpy as np
from annotated_types import Ge, Le

from tactile_graph.compiled import compiled_later
from tactile_graph.steps import Linked
from tactile_graph.steps.rules import Grid
from tactile_graph.wires import Mask, packed_mask, quick_mask
from tactile_graph.wires.parts import MaskParts, mask_of
from tactile_graph.wires.stacks import MaskStack
from tactile_graph_filters.morphology.erosion import BOOL
from tactile_graph_filters.morphology.packed import WORD, doubled, doubled_cells, doubled_parts

HALF = Mask.WIDEST // 2


@compiled_later
def expand(values, factor, out):  # type: ignore[no-untyped-def]
    """Write each cell of ``values`` into factor x factor cells of ``out``."""
    rows, columns = values.shape
    for i in range(rows):
        given, first = values[i], out[i * factor]
        if factor == 2:  # the usual case, in a form that becomes vector code
            for j in range(columns):
                first[2 * j] = given[j]
                first[2 * j + 1] = given[j]
        else:
            for j in range(columns):
                for k in range(j * factor, (j + 1) * factor):
                    first[k] = given[j]
        for k in range(1, factor):
            other = out[i * factor + k]
            for j in range(columns * factor):
                other[j] = first[j]


def subdivide(
    mask: Mask, *, factor: Annotated[int, Ge(1), Le(64)] = 2
) -> Annotated[Mask, Grid.like("mask", finer_by="factor")]:
    """Return the mask with each cell cut into factor x factor cells that inherit its state.

    Parameters
    ----------
    mask : Mask
    factor : int
        Into how many cells a side each cell is cut.

    Returns
    -------
    Mask
        On a grid of a ``factor`` finer pitch with the same origin.

    Notes
    -----
    Thesis section 4.2.5, figure 4.13; section 4.3.8 takes a factor of 10.
    """
    if factor == 1:
        return mask
    values = mask.values
    rows, columns = values.shape
    x, y = mask.pitch_cm
    if factor == 2 and columns <= HALF:
        words = np.empty(2 * rows, WORD)
        usual = values.dtype is BOOL and values.flags.c_contiguous
        count = (doubled_cells.direct if usual else doubled_cells.call)(values, words)
        return packed_mask(words, 2 * columns, (x / 2, y / 2), mask.origin_cm, count)
    out = np.empty((rows * factor, columns * factor), BOOL)
    expand.call(values, factor, out)
    return quick_mask(out, (x / factor, y / factor), mask.origin_cm)


def subdivide_stacked(mask: MaskStack, *, factor: int) -> MaskStack:
    """Return the masks of several frames cut as finely."""
    if factor == 1:
        return mask
    n, rows, columns = mask.shape
    x, y = mask.pitch_cm
    grid, counts = ((x / factor, y / factor), mask.origin_cm), mask.counts * factor**2
    words = mask.words if factor == 2 and 2 * columns <= MaskStack.WIDEST else None
    if words is not None:
        return MaskStack.packed(np.repeat(doubled(words), 2, axis=1), 2 * columns, *grid, counts)
    out = np.empty((n * rows * factor, columns * factor), np.bool_)
    expand.call(mask.values.reshape(n * rows, columns), factor, out)  # as one tall mask
    return MaskStack(out.reshape(n, rows * factor, columns * factor), *grid, counts)


def subdivide_linked(*, factor: int) -> Linked | None:
    """Return the form for masks as machine code hands them on."""
    return Linked(doubled_parts, MaskParts, mask_of) if factor == 2 else None


subdivide.stacked = subdivide_stacked  # type: ignore[attr-defined]
subdivide.linked = subdivide_linked  # type: ignore[attr-defined]
