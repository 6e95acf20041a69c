"""Step ``line_regions``: what the lines of a restored image enclose, and which of it is object."""

from __future__ import annotations

from typing import Annotated

import numpy as np
from annotated_types import Ge, Lt
from numpy.typing import NDArray

from tactile_graph.wires import Image
from tactile_graph_filters.contacts.labels import label
from tactile_graph_mrf.contours.regions import Flags, Regions, label_regions, require_grid, standing
from tactile_graph_mrf.energy.line_field import LineField


def line_regions(
    image: Image,
    lines: LineField,
    *,
    least_step: Annotated[float, Ge(0), Lt(1)] = 0.05,
    void_cells: Annotated[int, Ge(0)] = 8,
    min_cells: Annotated[int, Ge(1)] = 3,
) -> Regions:
    """Return the regions a line field encloses and the mask of those that are objects.

    A region is raised if it stands above what lies across its lines, all steps across them taken
    together: no level divides object and background. What is not raised and encloses nothing but
    voids is filled.

    Parameters
    ----------
    image : Image
        As restored, for the steps across lines.
    lines : LineField
        On the same grid.
    least_step : float
        What a region's mean step across its lines must exceed, as a share of the image's range.
        Lines that a sampler leaves on even ground enclose regions, too.
    void_cells : int
        Hollows of up to so many cells, cut off from the rest of the background and from the
        pad's rim, are missing elements within an object.
    min_cells : int
        Raised parts of fewer cells, voids included, are no objects.

    Returns
    -------
    Regions

    Raises
    ------
    DataError
        If the lines are not those of the image's grid.
    """
    require_grid(lines, image)
    values = np.where(np.isfinite(image.values), image.values, 0.0)
    labels = label_regions.call(lines.horizontal, lines.vertical)
    raised = standing(values, lines, labels, least_step)
    mask = with_voids(raised[labels], void_cells)
    _, sizes, found = _parts(mask, eight=True)
    keep = np.concatenate([[False], sizes >= min_cells])
    return Regions(labels, raised, image.mask(keep[found]))


def with_voids(mask: Flags, void_cells: int) -> Flags:
    """Return the mask with hollows of up to ``void_cells`` cells filled.

    Cells that only touch at a corner do not connect a hollow; one at the pad's rim is a bay.
    """
    table, sizes, found = _parts(~mask, eight=False)
    rows, columns = mask.shape
    inside = (
        (table[:, 8] > 0)
        & (table[:, 9] < rows - 1)
        & (table[:, 10] > 0)
        & (table[:, 11] < columns - 1)
    )
    return np.asarray(mask | np.concatenate([[False], inside & (sizes <= void_cells)])[found])


def _parts(
    on: Flags, *, eight: bool
) -> tuple[NDArray[np.float64], NDArray[np.float64], NDArray[np.int32]]:
    """Return the table of `label`, the sizes of the parts, and each cell's part."""
    found = np.empty(on.shape, np.int32)
    table = label(np.zeros(on.shape), np.ascontiguousarray(on), eight, found)
    return table, table[:, 0], found
