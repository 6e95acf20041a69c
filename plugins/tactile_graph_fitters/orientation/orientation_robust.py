"""``orientation_robust``: the major axis of a footprint with holes, breaks and strays."""

from __future__ import annotations

import math
from typing import Annotated

import numpy as np
from annotated_types import Gt, Le
from numpy.typing import NDArray

from tactile_graph.errors import Degenerate
from tactile_graph.wires import Mask, Points
from tactile_graph_fitters.orientation.orientation import (
    Orientation,
    angle_std_rad,
    orientation,
    principal_variances,
    seen_angle,
)

Values = NDArray[np.float64]


def orientation_robust(
    mask: Mask,
    *,
    min_share: Annotated[float, Gt(0), Le(1)] = 0.15,
    cell_cm: Annotated[float | None, Gt(0)] = None,
    ambiguous_above_rad: Annotated[float, Gt(0)] = 0.35,
) -> Orientation:
    """Return centre and major axis of the hull of a footprint's larger parts.

    Parameters
    ----------
    mask : Mask
    min_share : float
        Parts (cells that touch at sides or corners) of fewer cells than this share of the largest
        are taken for strays.
    cell_cm : float, optional
        Pitch of the elements that were read, where the mask was subdivided.
    ambiguous_above_rad : float
        As in `orientation`.

    Returns
    -------
    Orientation

    Raises
    ------
    Degenerate
        If no cell is on, or only one.

    Notes
    -----
    Where a footprint is broken (thesis 4.3.4), the scatter of what is left says how its pieces
    are spread, weighted by their cells; the moments of the area of their common hull say how
    the whole lay, however many cells are missing inside or between the pieces. Strays, to which
    a hull is sensitive, are left out first. What is lost at the ends no method can know; then
    the hull is nearly as broad as long and ``ambiguous`` says so. A hull in one line is judged
    by the scatter matrix.
    """
    from tactile_graph_hull.hull import hull

    cells = larger_parts(mask, min_share)
    if len(cells) == 0:
        raise Degenerate("no cell is on: no direction")
    corners = hull(Points(cells)).xy_cm
    pitch = math.sqrt(mask.cell_area_cm2) if cell_cm is None else cell_cm
    if len(corners) < 3:
        return orientation(Points(cells), cell_cm=pitch, ambiguous_above_rad=ambiguous_above_rad)
    # By a power of two: the fourth powers of very large and very small sizes are no numbers.
    _, exponent = math.frexp(float(np.abs(corners - corners[0]).max()))
    x, y, xx, xy, yy = area_moments(np.ldexp(corners, -exponent))
    x, y = math.ldexp(x, exponent), math.ldexp(y, exponent)
    along, across = principal_variances(xx, xy, yy)
    length, breadth = math.sqrt(12.0 * along), math.sqrt(12.0 * across)
    std = angle_std_rad(length, breadth, math.ldexp(pitch, -exponent))
    angle = seen_angle(xx, xy, yy)
    return Orientation(angle, x, y, 1.0 - breadth / length, std, std > ambiguous_above_rad)


def larger_parts(mask: Mask, min_share: float) -> Values:
    """Return the centres of the cells of the larger parts of a mask, shape (N, 2)."""
    from tactile_graph_filters.contacts.labels import label

    labels = np.empty(mask.shape, np.int32)
    values = np.ascontiguousarray(mask.values)
    table = label(values.astype(np.float64), values, True, labels)
    if len(table) == 0:
        return np.empty((0, 2))
    sizes = np.concatenate([[0.0], table[:, 0]])
    rows, columns = np.nonzero(sizes[labels] >= max(1.0, min_share * sizes.max()))
    return np.column_stack([mask.x_cm[columns], mask.y_cm[rows]])


def area_moments(corners: Values) -> tuple[float, float, float, float, float]:
    """Return centroid (x, y) and variances (xx, xy, yy) of the area of a polygon.

    ``corners`` has shape (N, 2) with N >= 3; its area must not be 0.
    """
    first = corners[0]
    x, y = (corners - first).T
    xn, yn = np.concatenate([x[1:], x[:1]]), np.concatenate([y[1:], y[:1]])
    cross = x * yn - xn * y
    area = 0.5 * float(cross.sum())
    cx, cy = float(((x + xn) @ cross) / (6.0 * area)), float(((y + yn) @ cross) / (6.0 * area))
    xx = float((x * x + x * xn + xn * xn) @ cross) / (12.0 * area) - cx * cx
    yy = float((y * y + y * yn + yn * yn) @ cross) / (12.0 * area) - cy * cy
    xy = float((2.0 * x * y + x * yn + xn * y + 2.0 * xn * yn) @ cross) / (24.0 * area) - cx * cy
    return float(first[0]) + cx, float(first[1]) + cy, xx, xy, yy
