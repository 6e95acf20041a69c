"""Step ``split_watershed``: touching contacts cut at their necks by a marked watershed."""

from __future__ import annotations

from typing import Annotated, Literal

import numpy as np
from annotated_types import Ge, Gt, Lt
from numpy.typing import NDArray

from tactile_graph.steps.rules import Grid, require_same_shape
from tactile_graph.wires import Image, Mask
from tactile_graph_filters.contacts.at_rest import counts_the_offset
from tactile_graph_filters.contacts.contacts import Contacts
from tactile_graph_filters.contacts.labelled import contacts_of
from tactile_graph_filters.nan import require_summable

SMOOTH_CELLS = 1.0
"""Standard deviation of the smoothing of the load map."""


def split_watershed(
    image: Image,
    mask: Annotated[Mask, Grid.like("image")],
    *,
    by: Literal["distance", "load", "both"] = "both",
    bridge_cells: Annotated[int, Ge(0)] = 1,
    neck: Annotated[float, Gt(0), Lt(1)] = 0.7,
    min_cells: Annotated[int, Ge(1)] = 1,
    margin: Annotated[int, Ge(0)] = 0,
) -> Contacts:
    """Return the contacts of a footprint, those joined by a neck cut apart at it.

    Parameters
    ----------
    image : Image
        Readings, for load and centre and for the load map.
    mask : Mask
        Which cells are in contact, on the same grid.
    by : str
        What the watershed runs on: each cell's distance from the outside, the smoothed load, or
        the product of the two.
    bridge_cells : int
        Gaps of up to twice this many cells are closed, and holes filled, before anything is
        measured, so that voids make no necks; 0 bridges nothing and fills nothing.
    neck : float
        Two parts are two contacts where the map on the best way between them drops below this
        share of the lower part's peak. By distance: where the neck is that much narrower than
        the narrower part. One disc has one peak and stays whole.
    min_cells : int
        Smaller contacts are left out.
    margin : int
        How many more cells each contact's own image and mask have on each side.

    Returns
    -------
    Contacts

    Raises
    ------
    RuleError
        If image and mask differ in shape.
    DataError
        If a cell of the mask holds NaN or infinity.

    Notes
    -----
    The markers are the h-maxima (Soille 2003, Morphological Image Analysis, section 6.3.4) of
    the map's logarithm with h = -log(neck), which makes the criterion a ratio. The flooding is
    Meyer's, 1994, 10.1016/0165-1684(94)90060-4. On grids as coarse as the pad's, where objects
    are three to five cells wide, `split_contacts` counts far better.
    """
    require_same_shape(image=image, mask=mask)
    if not mask.values.any():
        return Contacts((), 0)
    require_summable(image, image.values[mask.values])
    bridged = _bridged(mask.values, bridge_cells)
    labels = _flooded(_height(image, mask.values, bridged, by), bridged, neck)
    labels[~mask.values] = 0
    return contacts_of(labels, image, min_cells, margin)


split_watershed.notice = counts_the_offset  # type: ignore[attr-defined]


def _bridged(on: NDArray[np.bool_], cells: int) -> NDArray[np.bool_]:
    """Return the mask with gaps of up to twice ``cells`` closed and holes filled."""
    from scipy import ndimage

    if cells == 0:
        return on
    cells = min(cells, max(on.shape))  # a square as large as the mask closes as any larger one
    padded = np.pad(on, cells).view(np.uint8)  # closing must see the outside as off, not as unknown
    side = 2 * cells + 1
    closed = ndimage.grey_closing(padded, (side, side))[cells:-cells, cells:-cells]
    return np.asarray(ndimage.binary_fill_holes(closed), np.bool_)


def _height(
    image: Image, on: NDArray[np.bool_], bridged: NDArray[np.bool_], by: str
) -> NDArray[np.float64]:
    """Return the map to flood, > 0 within ``bridged``."""
    from scipy import ndimage

    height = np.ones(on.shape)
    if by != "load":
        height *= ndimage.distance_transform_edt(np.pad(bridged, 1))[1:-1, 1:-1]
    if by != "distance":
        readings = np.where(on, np.maximum(image.values, 0.0), 0.0)
        # A few strong elements would make peaks of their own.
        flat = np.minimum(readings, np.median(readings[on]))
        around = [
            ndimage.gaussian_filter(part, SMOOTH_CELLS, mode="constant")
            for part in (flat, bridged.astype(np.float64))
        ]
        level = around[0] / np.maximum(around[1], 1e-12)
        height *= np.maximum(level, 1e-6 * max(float(level.max()), 1e-300))
    return height


def _flooded(
    height: NDArray[np.float64], bridged: NDArray[np.bool_], neck: float
) -> NDArray[np.int32]:
    """Return the number of the peak each bridged cell belongs to."""
    from scipy import ndimage
    from skimage.morphology import local_maxima, reconstruction
    from skimage.segmentation import watershed

    floor = float(np.log(height[bridged].min())) - 1.0
    levels = np.full(height.shape, floor)
    levels[bridged] = np.log(height[bridged])
    levels = np.round(np.pad(levels, 1, constant_values=floor), 9)  # equal heights, equal bits
    lowered = np.round(reconstruction(levels + np.log(neck), levels, method="dilation"), 9)  # type: ignore[no-untyped-call]
    peaks = local_maxima(lowered) & np.pad(bridged, 1)  # type: ignore[no-untyped-call]
    markers, _ = ndimage.label(peaks, np.ones((3, 3)))
    flooded = watershed(  # type: ignore[no-untyped-call]
        -levels, markers, connectivity=2, mask=np.pad(bridged, 1)
    )
    return np.ascontiguousarray(flooded[1:-1, 1:-1], np.int32)
