"""``orientation``: the direction of the major axis of a footprint, by its scatter matrix."""

from __future__ import annotations

import math
from typing import Annotated, NamedTuple

import numpy as np
from annotated_types import Gt
from numpy.typing import NDArray

from tactile_graph.compiled import compiled_later
from tactile_graph.errors import Degenerate
from tactile_graph.wires import Mask, Points
from tactile_graph.wires.shapes import printed_angle_deg

ANY_ANGLE_STD_RAD = math.pi / math.sqrt(12.0)
"""Standard deviation of an axis of which nothing is known."""

Sums = tuple[int, float, float, float, float, float]
"""Number, mean x and y, scatter xx, xy and yy about the mean."""


class Orientation(NamedTuple):
    """Centre and major axis of a footprint.

    ``angle_rad`` is counter-clockwise as seen, in (-pi/2, pi/2]; an axis has no head, so it is
    known up to half turns. ``elongation`` is 1 less the ratio of the standard deviations across
    and along the axis: 0 for squares and discs, 1 for a line. ``angle_std_rad`` estimates how far
    the angle may be off; where that is too much, ``ambiguous`` says not to use the angle.
    """

    angle_rad: float
    x_cm: float
    y_cm: float
    elongation: float
    angle_std_rad: float
    ambiguous: bool

    @property
    def angle_deg(self) -> float:
        """Angle in (-90, 90] degrees."""
        return printed_angle_deg(self.angle_rad)

    @property
    def angle_std_deg(self) -> float:
        """``angle_std_rad`` in degrees."""
        return math.degrees(self.angle_std_rad)


def require_finite(axis: Orientation) -> None:
    """Raise if nothing can be turned by an axis.

    Raises
    ------
    Degenerate
        If its angle or centre is NaN or infinite.
    """
    if not math.isfinite(axis.angle_rad + axis.x_cm + axis.y_cm):
        raise Degenerate(
            f"the axis must be finite, got {axis.angle_rad:g} rad at ({axis.x_cm:g}, "
            f"{axis.y_cm:g}) cm"
        )


# Beside the class: a NamedTuple would take it for a field.
Orientation.columns_shown = (  # type: ignore[attr-defined]
    "angle_deg", "x_cm", "y_cm", "elongation", "angle_std_deg", "ambiguous")  # fmt: skip


def orientation(
    footprint: Mask | Points,
    *,
    cell_cm: Annotated[float | None, Gt(0)] = None,
    ambiguous_above_rad: Annotated[float, Gt(0)] = 0.35,
) -> Orientation:
    """Return centre and direction of the major axis.

    Parameters
    ----------
    footprint : Mask or Points
        Cells that are on, or their positions.
    cell_cm : float, optional
        Pitch of the elements that were read, for the estimate of the angle's error; needed where
        the mask was subdivided. By default that of the mask or, for points, the square root of
        the area of the rectangle with their moments over their number.
    ambiguous_above_rad : float
        From which estimated error of the angle on it is declared ambiguous.

    Returns
    -------
    Orientation

    Raises
    ------
    Degenerate
        If there are no points, some are not finite, or all are at one place.

    Notes
    -----
    The major axis is the eigenvector of the larger eigenvalue of the scatter matrix S = B' B of
    the centred positions B (thesis 4.3.4, equations 4.4 and 4.5; Golub and Van Loan 1983).
    A footprint broken so that what is left is broader across than along gives the wrong axis:
    see `orientation_robust`.

    The error is estimated for a rectangle with the same moments (sides L and B) of whose outline
    every cell is on or off at random: p**1.5 sqrt(1.5 / (L + B)) / (L - B) for a pitch p, never
    more than pi / sqrt(12), that of an axis of which nothing is known.
    """
    n, x, y, xx, xy, yy = scatter_of(footprint)
    along, across = principal_variances(xx / n, xy / n, yy / n)
    if not along > 0.0:
        raise Degenerate(f"{n} points, all at one place: no direction")
    if not 12.0 * along < math.inf:
        raise Degenerate(f"{n} points, some not finite or too large: no direction")
    length, breadth = math.sqrt(12.0 * along), math.sqrt(12.0 * across)
    pitch = cell_cm
    if pitch is None:
        pitch = (
            math.sqrt(footprint.cell_area_cm2)
            if isinstance(footprint, Mask)
            else math.sqrt(length * breadth / n)
        )
    std = angle_std_rad(length, breadth, pitch)
    return Orientation(
        seen_angle(xx, xy, yy), x, y, 1.0 - breadth / length, std, std > ambiguous_above_rad
    )


def scatter_of(footprint: Mask | Points) -> Sums:
    """Return number, mean (x, y) and scatter (xx, xy, yy) of cells or points, in cm.

    Raises
    ------
    Degenerate
        If there are none, or some are not finite.
    """
    if isinstance(footprint, Mask):
        (x0, y0), (px, py) = footprint.origin_cm, footprint.pitch_cm
        n, x, y, xx, xy, yy = mask_scatter(np.ascontiguousarray(footprint.values))
        found = (
            n,
            x0 + (x + 0.5) * px,
            y0 + (y + 0.5) * py,
            xx * px * px,
            xy * px * py,
            yy * py * py,
        )
    else:
        found = points_scatter(np.ascontiguousarray(footprint.xy_cm, dtype=np.float64))
    if found[0] == 0:
        raise Degenerate("0 points: no direction")
    if not math.isfinite(sum(found)):
        raise Degenerate(f"{found[0]} points, some not finite or too large: no direction")
    return found


@compiled_later
def principal_variances(xx: float, xy: float, yy: float) -> tuple[float, float]:
    """Return the larger and the smaller eigenvalue of a covariance matrix; none below 0."""
    middle, off = 0.5 * xx + 0.5 * yy, math.hypot(0.5 * xx - 0.5 * yy, xy)
    larger = middle + off
    if not 0.0 < larger < math.inf:
        return larger, 0.0
    # By a power of two into a range where products are numbers: that costs no digit.
    power = math.frexp(larger)[1]
    a, b, c = math.ldexp(xx, -power), math.ldexp(xy, -power), math.ldexp(yy, -power)
    # The product of the two is exact where their difference would cancel.
    smaller = math.ldexp((a * c - b * b) / math.ldexp(larger, -power), power)
    # What is left of a line by rounding is a line.
    return larger, smaller if smaller > 64.0 * 2.0**-52 * larger else 0.0


@compiled_later
def seen_angle(xx: float, xy: float, yy: float) -> float:
    """Return the angle of the major axis as seen, of moments with y down, in (-pi/2, pi/2]."""
    angle = -0.5 * math.atan2(2.0 * xy, xx - yy)
    return angle if angle > -0.5 * math.pi else 0.5 * math.pi


def angle_std_rad(length_cm: float, breadth_cm: float, pitch_cm: float) -> float:
    """Return the estimated error of the angle (see `orientation`)."""
    difference = length_cm - breadth_cm
    spread = pitch_cm**1.5 * math.sqrt(1.5 / (length_cm + breadth_cm))
    return min(spread / difference, ANY_ANGLE_STD_RAD) if difference > 0.0 else ANY_ANGLE_STD_RAD


@compiled_later
def mask_scatter(values: NDArray[np.bool_]) -> Sums:
    """Return number, mean (column, row) and scatter of the cells that are on."""
    n = sx = sy = sxx = sxy = syy = 0
    for i in range(values.shape[0]):
        row = values[i]
        m = mx = mxx = 0
        for j in range(values.shape[1]):
            on = int(row[j])
            m += on
            mx += on * j
            mxx += on * j * j
        n += m
        sx += mx
        sxx += mxx
        sy += i * m
        sxy += i * mx
        syy += i * i * m
    if n == 0:
        return 0, 0.0, 0.0, 0.0, 0.0, 0.0
    return (
        n,
        sx / n,
        sy / n,
        (n * sxx - sx * sx) / n,
        (n * sxy - sx * sy) / n,
        (n * syy - sy * sy) / n,
    )


@compiled_later
def points_scatter(xy: NDArray[np.float64]) -> Sums:
    """Return number, mean (x, y) and scatter (xx, xy, yy) of points of shape (N, 2)."""
    n = xy.shape[0]
    if n == 0:
        return 0, 0.0, 0.0, 0.0, 0.0, 0.0
    x = y = 0.0
    for i in range(n):
        x += xy[i, 0] - xy[0, 0]
        y += xy[i, 1] - xy[0, 1]
    x, y = xy[0, 0] + x / n, xy[0, 1] + y / n
    s_xx = s_xy = s_yy = 0.0
    for i in range(n):
        dx, dy = xy[i, 0] - x, xy[i, 1] - y
        s_xx += dx * dx
        s_xy += dx * dy
        s_yy += dy * dy
    return n, x, y, s_xx, s_xy, s_yy
