"""Step ``outline_points``: where an object's outline crosses the cells at its border."""

from __future__ import annotations

import math
from typing import Annotated, TypeAlias

import numpy as np
from annotated_types import Ge, Gt, Le
from numpy.typing import NDArray

from tactile_graph.steps.rules import Grid, require_same_shape
from tactile_graph.wires import Image, Mask, Points
from tactile_graph_hull.parts import several_parts

Reals: TypeAlias = NDArray[np.float64]

UNSURE = 0.5
"""Share of a cell taken as covered where its reading tells nothing."""
FARTHEST = 20.0
"""Standard deviations above a full reading beyond which a cell is as good as fully covered."""


def outline_points(
    mask: Mask,
    image: Annotated[Image | None, Grid.like("mask")] = None,
    *,
    unevenness: Annotated[float, Ge(0), Le(4)] = 0.5,
    load_power: Annotated[float, Gt(0), Le(10)] = 1.5,
) -> Points:
    """Return one point for each side on which a cell of the mask borders on one outside.

    Without ``image`` the points are the middles of those sides, which is where the lines of a
    line field stand. A cell at the border is covered in part only, so the object ends within it:
    with ``image`` the point is moved inwards by the share not covered, as the reading has it.

    Parameters
    ----------
    mask : Mask
        Cells of an object; beyond the pad's rim nothing is.
    image : Image, optional
        Its readings, as recorded.
    unevenness : float
        Standard deviation of the logarithm of the gains of the elements' loads.
    load_power : float
        Power of the load that a reading goes with: 1 for grams, about 1.5 for the volts of the
        thesis' divider.

    Returns
    -------
    Points
        By rows from the top; upper, lower, left and right sides in turn.

    Raises
    ------
    RuleError
        If image and mask differ in shape.

    Notes
    -----
    A cell covered by the share c bears c times a lognormal gain of a full load, and reads that to
    the power load_power; any c is as likely as any other beforehand. The mean of c given the
    reading r over the median reading of the cells within is, with m = log(r) / load_power and
    s = unevenness::

        exp(m + 1.5 s²) Phi(-(m + 2 s²) / s) / Phi(-(m + s²) / s)

    Cells that read nothing, or are not known, are taken as half covered. The four-neighbourhood's
    outline is that of the line field (thesis section 5.3.2, fig. 5.13). The thesis names the grey
    levels near the boundary as what thresholding loses (section 5.5.2, item 1).
    """
    on = np.pad(mask.values, 1)
    inside, (px, py), (x, y) = on[1:-1, 1:-1], mask.pitch_cm, mask.origin_cm
    sides = (
        inside & ~on[:-2, 1:-1],
        inside & ~on[2:, 1:-1],
        inside & ~on[1:-1, :-2],
        inside & ~on[1:-1, 2:],
    )
    bare = np.zeros(mask.shape)
    if image is not None:
        require_same_shape(image=image, mask=mask)
        rim = sides[0] | sides[1] | sides[2] | sides[3]
        bare[rim] = 1.0 - coverage(image, inside, rim, unevenness, load_power)
    found: list[Reals] = []
    for side, (along, at, sign) in zip(
        sides, ((0.5, 0.0, 1.0), (0.5, 1.0, -1.0), (0.5, 0.0, 1.0), (0.5, 1.0, -1.0)), strict=True
    ):
        i, j = np.nonzero(side)
        across = at + sign * bare[i, j]
        upright = len(found) >= 2
        dx, dy = (across, np.full(i.shape, along)) if upright else (np.full(i.shape, along), across)
        found.append(np.column_stack([x + (j + dx) * px, y + (i + dy) * py]))
    return Points(np.concatenate(found))


outline_points.notice = several_parts  # type: ignore[attr-defined]


def coverage(
    image: Image, inside: NDArray[np.bool_], rim: NDArray[np.bool_], spread: float, power: float
) -> Reals:
    """Return the share covered of each cell of the rim, as likely as its reading makes it."""
    values = np.asarray(image.filled(), np.float64)
    telling = inside & np.isfinite(values) & (values > 0.0)
    full = values[telling & ~rim] if (telling & ~rim).any() else values[telling]
    if not full.size:
        return np.full(int(np.count_nonzero(rim)), UNSURE)
    share = np.full(values.shape, UNSURE)
    here = telling & rim
    logs = np.log(values[here] / float(np.median(full))) / power
    share[here] = [covered(m, spread) for m in logs.tolist()]
    return share[rim]


def covered(log_share: float, spread: float) -> float:
    """Return the mean of a share c, even on 0 to 1, given log c with a normal error."""
    if spread == 0.0:
        return math.exp(min(0.0, log_share))
    m = min(log_share, FARTHEST * spread)
    upper = math.erfc((m + 2.0 * spread**2) / (spread * math.sqrt(2.0)))
    lower = math.erfc((m + spread**2) / (spread * math.sqrt(2.0)))
    return min(1.0, math.exp(m + 1.5 * spread**2) * upper / lower)
