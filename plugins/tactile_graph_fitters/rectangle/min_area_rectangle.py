"""``min_area_rectangle``: the smallest rectangle around points, by rotating calipers."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import Annotated

import numpy as np
from annotated_types import Gt
from numpy.typing import NDArray

from tactile_graph.compiled import compiled_later
from tactile_graph.errors import Degenerate
from tactile_graph.wires import Image, Points
from tactile_graph_fitters.orientation.element_pitch import THESIS_PITCH_CM, element_pitch_cm
from tactile_graph_fitters.orientation.oriented import Oriented
from tactile_graph_fitters.rectangle.fitted_rectangle import FittedRectangle, rectangle_of

Values = NDArray[np.float64]

TIE = 1e-12
"""Part of an area by which rounding alone makes another one of it."""
ANGLE = 1e-6
"""In radians, up to quarter turns: sides of one rectangle lie no further apart."""


def min_area_rectangle(
    points: Points,
    elements: Image | None = None,
    *,
    cell_cm: Annotated[float | None, Gt(0)] = None,
) -> FittedRectangle:
    """Return the rectangle of least area that holds all points.

    Parameters
    ----------
    points : Points
        Of any kind; their hull, which `hull` gives, holds all that matters.
    elements : Image, optional
        What was read, as it was read: not subdivided.
    cell_cm : float, optional
        Pitch of the elements that were read, for ``ambiguous``; that of ``elements`` if not given,
        or 1.3, the thesis' pad's.

    Returns
    -------
    FittedRectangle
        ``misfit`` is the share of its area outside the points' hull, 0 to 1; ``iterations`` counts
        the hull's sides tried; it is ``ambiguous``, too, where one at another angle is as small.

    Raises
    ------
    Degenerate
        If there are fewer than 3 points not on one line, some are not finite, or the rectangle
        is too large for a number.

    Notes
    -----
    A side of the smallest rectangle lies along a side of the hull (Freeman and Shapira 1975,
    10.1145/360881.360919), so calipers turned once around the hull find it in O(N) (Toussaint
    1983). One stray point moves it: it is a start and a bound rather than a fit.
    """
    from tactile_graph_hull.hull import hull

    corners = hull(points).xy_cm
    n = len(points.xy_cm)
    if len(corners) < 3:
        raise Degenerate(f"{n} points on one line: no rectangle around them has an area")
    # By a power of two: areas of very large and very small ones are no numbers.
    _, exponent = math.frexp(float(np.abs(corners).max()))
    found = smallest(np.ldexp(corners, -exponent))
    first, second, angle, filled, tied = found[2:]
    if not first * second > 0.0:
        raise Degenerate(f"{n} points nearly on one line: the rectangle's area is too small")
    empty = max(0.0, 1.0 - filled / (first * second))
    try:
        x, y, first, second = (math.ldexp(v, exponent) for v in (*found[:2], first, second))
    except OverflowError:
        raise Degenerate(f"{n} points: their rectangle is too large for a number") from None
    pitch_cm = element_pitch_cm(elements, cell_cm)
    its = rectangle_of(Oriented(x, y, first, second, angle), empty, n, len(corners), pitch_cm)
    return replace(its, ambiguous=True) if tied else its


min_area_rectangle.usual_cm = {"cell_cm": THESIS_PITCH_CM}  # type: ignore[attr-defined]


@compiled_later
def _furthest(corners: Values, start: int, dx: float, dy: float) -> int:
    """Return the corner furthest along a direction, going on from ``start``."""
    n = corners.shape[0]
    at = start
    for _ in range(n):
        k = (at + 1) % n
        if (corners[k, 0] - corners[at, 0]) * dx + (corners[k, 1] - corners[at, 1]) * dy <= 0.0:
            break
        at = k
    return at


@compiled_later
def smallest(corners: Values) -> tuple[float, float, float, float, float, float, bool]:
    """Return centre (x, y), two sides, the first one's angle as seen, and the hull's own area.

    Last comes whether there is another one as small, but for rounding, at another angle.

    ``corners`` run counter-clockwise as seen, that is from +x to -y: outwards of a side (dx, dy)
    is (-dy, dx), where y runs down.
    """
    n = corners.shape[0]
    ahead = away = behind = 0
    best = np.inf
    x = y = first = second = angle = area = best_dx = best_dy = 0.0
    tied = False
    for i in range(n):
        k = (i + 1) % n
        dx, dy = corners[k, 0] - corners[i, 0], corners[k, 1] - corners[i, 1]
        area -= (corners[i, 0] - corners[0, 0]) * dy - (corners[i, 1] - corners[0, 1]) * dx
        size = math.hypot(dx, dy)
        dx, dy = dx / size, dy / size
        ahead = _furthest(corners, k if i == 0 else ahead, dx, dy)
        away = _furthest(corners, ahead if i == 0 else away, dy, -dx)
        behind = _furthest(corners, away if i == 0 else behind, -dx, -dy)
        high = (corners[ahead, 0] - corners[i, 0]) * dx + (corners[ahead, 1] - corners[i, 1]) * dy
        low = (corners[behind, 0] - corners[i, 0]) * dx + (corners[behind, 1] - corners[i, 1]) * dy
        deep = (corners[away, 0] - corners[i, 0]) * dy - (corners[away, 1] - corners[i, 1]) * dx
        here = (high - low) * deep
        if here < best * (1.0 - TIE):
            tied = False
        elif here <= best * (1.0 + TIE):
            along, across = dx * best_dx + dy * best_dy, dx * best_dy - dy * best_dx
            tied = tied or abs(along * across) > ANGLE
        if here < best:
            best, best_dx, best_dy = here, dx, dy
            first, second, angle = high - low, deep, math.atan2(-dy, dx)
            along = 0.5 * (low + high)
            x = corners[i, 0] + along * dx + 0.5 * deep * dy
            y = corners[i, 1] + along * dy - 0.5 * deep * dx
    return x, y, first, second, angle, 0.5 * area, tied
