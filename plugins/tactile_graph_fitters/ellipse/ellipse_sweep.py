"""``ellipse_sweep``: the ellipse of least error over orientations tried in steps."""

from __future__ import annotations

import math
from typing import Annotated

import numpy as np
from annotated_types import Gt, Le
from numpy.typing import NDArray

from tactile_graph.compiled import compiled_later
from tactile_graph.errors import Degenerate
from tactile_graph.wires import Points
from tactile_graph_fitters.circle.principal_axes import LARGEST
from tactile_graph_fitters.ellipse.fit_ellipse_origin import (
    FLATTEST,
    OK,
    Polar,
    origin_fit,
    polar,
)
from tactile_graph_fitters.ellipse.fitted_ellipse import FittedEllipse, ellipse_of
from tactile_graph_fitters.orientation.orientation import Orientation
from tactile_graph_fitters.orientation.oriented import Oriented

SETTLED = 1e-6  # of the half axes, where the simplex has to find them
STEPS = 12  # of Newton's method, which needs about five
SMALL = 1e-8  # relative step after which the next would be below rounding
NARROW_RAD = 1e-4  # width at which halving the angle's interval ends
LONGEST = 3.0  # half axes, in farthest coordinates of the points, beyond which they say nothing
GOLDEN = 0.5 * (math.sqrt(5.0) - 1.0)

Values = NDArray[np.float64]


def ellipse_sweep(
    points: Points,
    centre: Orientation | None = None,
    *,
    step_deg: Annotated[float, Gt(0), Le(45)] = 5.0,
    refine: bool = True,
) -> FittedEllipse:
    """Return the ellipse about a centre whose orientation leaves the least error.

    Parameters
    ----------
    points : Points
        On the outline.
    centre : Orientation, optional
        Its centre is taken, its angle is not. By default the middle of the smallest box along
        the axes around the points.
    step_deg : float
        Step between the orientations tried over a quarter turn; the other quarter is the same
        ellipses with their axes exchanged.
    refine : bool
        Whether to look between the steps next to the best, by golden sections.

    Returns
    -------
    FittedEllipse
        ``rms_cm`` is of the radial distances; ``iterations`` counts the orientations tried.

    Raises
    ------
    Degenerate
        If there are fewer than 5 points, some are not finite or further than 1e150 cm away, or at
        no orientation an ellipse fits. One with a half axis of more than three times the points'
        farthest coordinate about the centre, along its axes, does not: a parabola fits as well.

    Notes
    -----
    Thesis 6.1.3: for each orientation the best ellipse is found as `fit_ellipse_origin` does, the
    most probable one being that of least squared error. It needs no orientation from a scatter
    matrix, so that a broken footprint does not lead it astray; but its centre must be right.
    `fit_ellipse` looks for centre, axes and angle together.
    """
    xy = np.asarray(points.xy_cm, dtype=np.float64)
    n = len(xy)
    if n < 5:
        raise Degenerate(f"{n} points: an ellipse to be swept needs at least 5")
    if not np.isfinite(xy).all():
        raise Degenerate(f"some of {n} points not finite: no ellipse fits")
    if np.abs(xy).max() > LARGEST:
        raise Degenerate(f"{n} points, some too far away for their squares: no ellipse fits")
    x, y = (
        (0.5 * (xy.min(axis=0) + xy.max(axis=0))).tolist()
        if centre is None
        else (centre.x_cm, centre.y_cm)
    )
    a, b, angle, rms, tried = swept(
        xy[:, 0] - x, xy[:, 1] - y, max(1, math.ceil(90.0 / step_deg)), refine
    )
    if not a > 0.0:
        raise Degenerate(f"{n} points: at none of {tried} orientations an ellipse fits")
    return ellipse_of(Oriented(x, y, a, b, angle), rms, n, tried)


@compiled_later
def _at(dx: Values, dy: Values, angle: float) -> tuple[float, float, float]:
    """Return half axes and rms of the best ellipse at an angle as seen; infinite rms for none."""
    cos, sin = math.cos(angle), math.sin(angle)
    x, y = dx * cos - dy * sin, dx * sin + dy * cos
    scale, a, b, points = polar(x, y)
    if scale > 0.0:
        a, b, error = straight(points, a, b)
        if FLATTEST * a < b < a / FLATTEST and max(a, b) <= LONGEST:
            return scale * a, scale * b, scale * math.sqrt(error / x.shape[0])
    status, a, b, rms, _ = origin_fit(x, y, SETTLED, 1000)
    if status != OK or max(a, b) > LONGEST * scale:
        return 0.0, 0.0, np.inf
    return a, b, rms


@compiled_later
def straight(points: Polar, a: float, b: float) -> tuple[float, float, float]:
    """Return half axes of least squared radial distances near a and b, and the sum of these.

    Newton's method on 1 / a**2 and 1 / b**2, as long as each step is at most half the one before;
    half axes of 0 where it does not lead straight to a minimum.
    """
    r, cos2, sin2 = points
    p, q, last = 1.0 / (a * a), 1.0 / (b * b), 1.0
    for _ in range(STEPS):
        error = g_p = g_q = h_pp = h_pq = h_qq = 0.0
        for i in range(r.shape[0]):
            c, s = cos2[i], sin2[i]
            square = 1.0 / (c * p + s * q)
            rho = math.sqrt(square)
            off, cube = r[i] - rho, rho * square
            bend = cube * (0.5 * cube - 1.5 * off * square)
            error += off * off
            g_p += off * cube * c
            g_q += off * cube * s
            h_pp += bend * c * c
            h_pq += bend * c * s
            h_qq += bend * s * s
        det = h_pp * h_qq - h_pq * h_pq
        if not (h_pp > 0.0 and det > 1e-12 * h_pp * h_qq):
            break
        d_p, d_q = (h_pq * g_q - h_qq * g_p) / det, (h_pq * g_p - h_pp * g_q) / det
        size = max(abs(d_p) / p, abs(d_q) / q)
        if not size <= 0.5 * last:
            break
        p, q, last = p + d_p, q + d_q, size
        if size <= SMALL:
            left = max(0.0, error + 0.5 * (g_p * d_p + g_q * d_q))
            return 1.0 / math.sqrt(p), 1.0 / math.sqrt(q), left
    return 0.0, 0.0, 0.0


@compiled_later
def swept(dx: Values, dy: Values, n: int, refine: bool) -> tuple[float, float, float, float, int]:
    """Return half axes, the first one's angle as seen, rms and the orientations tried."""
    step = 0.5 * math.pi / n
    best_a, best_b, best, least = 0.0, 0.0, 0.0, np.inf
    for k in range(n):
        a, b, rms = _at(dx, dy, k * step)
        if rms < least:
            best_a, best_b, best, least = a, b, k * step, rms
    if not refine or not math.isfinite(least):
        return best_a, best_b, best, least, n
    tried = n
    low, high = best - step, best + step
    left, right = high - GOLDEN * (high - low), low + GOLDEN * (high - low)
    at_left, at_right = _at(dx, dy, left), _at(dx, dy, right)
    while high - low > NARROW_RAD:
        tried += 1
        if at_left[2] < at_right[2]:
            high, right, at_right = right, left, at_left
            left = high - GOLDEN * (high - low)
            at_left = _at(dx, dy, left)
        else:
            low, left, at_left = left, right, at_right
            right = low + GOLDEN * (high - low)
            at_right = _at(dx, dy, right)
    found, angle = (at_left, left) if at_left[2] < at_right[2] else (at_right, right)
    if found[2] < least:
        return found[0], found[1], angle, found[2], tried + 2
    return best_a, best_b, best, least, tried + 2
