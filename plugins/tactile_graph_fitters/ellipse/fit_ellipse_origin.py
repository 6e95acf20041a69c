"""``fit_ellipse_origin``: the thesis' ellipse about a known centre along a known axis."""

from __future__ import annotations

import math
from typing import Annotated, NamedTuple

import numpy as np
from annotated_types import Ge, Gt
from numpy.typing import NDArray

from tactile_graph.compiled import compiled_later
from tactile_graph.errors import Degenerate
from tactile_graph.wires import Points
from tactile_graph_fitters.ellipse.fitted_ellipse import FittedEllipse, ellipse_of
from tactile_graph_fitters.orientation.orientation import Orientation
from tactile_graph_fitters.orientation.oriented import Oriented

OK, NO_SPREAD, NOT_SETTLED = range(3)
FLATTEST = 1e-6  # half axes of a smaller ratio than this are a line

Values = NDArray[np.float64]


class Polar(NamedTuple):
    """Distances of points from the centre, and the squared cosines and sines of their angles."""

    r: Values
    cos2: Values
    sin2: Values


def fit_ellipse_origin(
    points: Points,
    axis: Orientation,
    *,
    tolerance: Annotated[float, Gt(0)] = 1e-8,
    max_iterations: Annotated[int, Ge(1)] = 1000,
) -> FittedEllipse:
    """Return the ellipse about the axis' centre that lies nearest to turned points.

    Parameters
    ----------
    points : Points
        Turned by `rotate_points` or `rotate_mask` so that ``axis`` lies along x.
    axis : Orientation
        What they were turned by. The ellipse is turned back by it, so that it is in pad
        coordinates.
    tolerance : float
        The search has settled when its simplex is no larger than so many half axes and the error
        no more uneven over it than so many parts.
    max_iterations : int
        Steps of the simplex after which the search is given up.

    Returns
    -------
    FittedEllipse
        ``rms_cm`` is of the radial distances.

    Raises
    ------
    Degenerate
        If there are fewer than 2 points, some are not finite, all lie on one line through the
        centre, or the search does not settle twice at the same ellipse.

    Notes
    -----
    Minimises the sum of squared distances along the rays from the centre,
    (r - 1 / sqrt(cos**2 / a**2 + sin**2 / b**2))**2, over the half axes a and b: thesis appendix
    D, where of the two intersections of equation D.7 the nearer one is that on the point's own
    side. (D.3 should read x**2 b**2 + y**2 a**2 = a**2 b**2; what follows from it is right.)
    Rays meet a flat ellipse at a slant, so a radial distance is up to a / b times the geometric
    one. The search is Nelder and Mead's simplex of 1965 (10.1093/comjnl/7.4.308), as in MATLAB's
    fmins: first simplex 5 % of each unknown, reflection, expansion, contraction, shrinking by
    1, 2, 1/2, 1/2. It is started again where it ends until that no longer helps, since a simplex
    may collapse short of the minimum. Its start, which the thesis leaves open, is the ellipse
    with the points' mean squares, exact for points spread evenly by angle of the parameter.

    Sides of a rectangle are not its axes: see `rectangle_from_ellipse`.
    """
    x, y = points.xy_cm[:, 0] - axis.x_cm, points.xy_cm[:, 1] - axis.y_cm
    n = len(x)
    status, a, b, rms, rounds = origin_fit(x, y, tolerance, max_iterations)
    if status != OK:
        raise Degenerate(_why(x, y, status, rounds))
    found = Oriented(axis.x_cm, axis.y_cm, a, b, axis.angle_rad)
    return ellipse_of(found, rms, n, rounds)


def _why(x: Values, y: Values, status: int, rounds: int) -> str:
    n = len(x)
    points = "1 point" if n == 1 else f"{n} points"
    if n < 2:
        return f"{points}: an ellipse about a known centre needs at least 2"
    bad = n - int((np.isfinite(x) & np.isfinite(y)).sum())
    if bad:
        return f"{bad} of {points} not finite: no ellipse fits"
    if status == NOT_SETTLED:
        return f"{points}: no ellipse found within {rounds} steps of the simplex"
    return f"{points} on one line through the centre: no ellipse fits"


@compiled_later
def radial_error(r: Values, cos2: Values, sin2: Values, a: float, b: float, off: Values) -> float:
    """Return the sum of squared radial distances (D.9) of points r (cos, sin) into ``off``."""
    ia, ib = 1.0 / (a * a), 1.0 / (b * b)
    for i in range(r.shape[0]):
        off[i] = r[i] - 1.0 / math.sqrt(cos2[i] * ia + sin2[i] * ib)
    total = other = 0.0
    for i in range(0, r.shape[0] - 1, 2):  # two sums, so that one does not wait for the other
        total += off[i] * off[i]
        other += off[i + 1] * off[i + 1]
    if r.shape[0] % 2:
        total += off[-1] * off[-1]
    return total + other


@compiled_later
def simplex_search(
    points: Polar, a: float, b: float, tolerance: float, most: int
) -> tuple[bool, float, float, float, int]:
    """Return whether it settled, a, b, the error there, and the steps of one simplex search."""
    r, cos2, sin2 = points
    off = np.empty(r.shape[0])
    # Best, middle and worst corner: a, b, error. The error does not mind the sign of a and b.
    s = np.empty((3, 3))
    s[0, 0], s[0, 1] = a, b
    s[1, 0], s[1, 1] = 1.05 * a, b
    s[2, 0], s[2, 1] = a, 1.05 * b
    for k in range(3):
        s[k, 2] = radial_error(r, cos2, sin2, s[k, 0], s[k, 1], off)
    for step in range(1, most + 1):
        for k in (1, 0, 1):  # bubbles: three corners in order of their error
            if s[k + 1, 2] < s[k, 2]:
                for c in range(3):
                    s[k, c], s[k + 1, c] = s[k + 1, c], s[k, c]
        size = 0.0
        for k in (1, 2):
            size = max(size, abs(s[k, 0] / s[0, 0] - 1.0), abs(s[k, 1] / s[0, 1] - 1.0))
        # The error of a perfect fit is all rounding: the second term is what that may come to.
        level = tolerance * (s[0, 2] + 10.0 * tolerance * r.shape[0])
        if size <= tolerance and s[2, 2] - s[0, 2] <= level:
            return True, abs(s[0, 0]), abs(s[0, 1]), s[0, 2], step
        ma, mb = 0.5 * (s[0, 0] + s[1, 0]), 0.5 * (s[0, 1] + s[1, 1])
        da, db = ma - s[2, 0], mb - s[2, 1]
        found = radial_error(r, cos2, sin2, ma + da, mb + db, off)
        share = 1.0
        if found < s[0, 2]:
            further = radial_error(r, cos2, sin2, ma + 2.0 * da, mb + 2.0 * db, off)
            if further < found:
                found, share = further, 2.0
        elif found >= s[1, 2]:
            share = 0.5 if found < s[2, 2] else -0.5
            limit = min(found, s[2, 2])
            found = radial_error(r, cos2, sin2, ma + share * da, mb + share * db, off)
            if found > limit:
                for k in (1, 2):
                    s[k, 0] = 0.5 * (s[0, 0] + s[k, 0])
                    s[k, 1] = 0.5 * (s[0, 1] + s[k, 1])
                    s[k, 2] = radial_error(r, cos2, sin2, s[k, 0], s[k, 1], off)
                continue
        s[2, 0], s[2, 1], s[2, 2] = ma + share * da, mb + share * db, found
    return False, abs(s[0, 0]), abs(s[0, 1]), s[0, 2], most


@compiled_later
def polar(x: Values, y: Values) -> tuple[float, float, float, Polar]:
    """Return the scale, the start a and b, and the points' distances and angles, all scaled.

    The scale is 0 where no ellipse fits: too few points, not finite, or on one line.
    """
    n = x.shape[0]
    r, cos2, sin2 = np.empty(n), np.empty(n), np.empty(n)
    largest = 0.0
    finite = n >= 2
    for i in range(n):
        finite &= math.isfinite(x[i]) and math.isfinite(y[i])
        largest = max(largest, abs(x[i]), abs(y[i]))
    if not finite or not 1e-150 < largest < 1e150:
        return 0.0, 0.0, 0.0, Polar(r, cos2, sin2)
    xx = xy = yy = 0.0
    for i in range(n):
        u, v = x[i] / largest, y[i] / largest
        xx += u * u
        xy += u * v
        yy += v * v
        rr = u * u + v * v
        r[i] = math.sqrt(rr)
        cos2[i] = u * u / rr if rr > 0.0 else 1.0
        sin2[i] = v * v / rr if rr > 0.0 else 0.0
    if xx * yy - xy * xy <= 1e-14 * (xx + yy) ** 2:
        return 0.0, 0.0, 0.0, Polar(r, cos2, sin2)
    a, b = math.sqrt(2.0 * xx / n), math.sqrt(2.0 * yy / n)
    return largest, a, b, Polar(r, cos2, sin2)


@compiled_later
def origin_fit(
    x: Values, y: Values, tolerance: float, most: int
) -> tuple[int, float, float, float, int]:
    """Return status, half axes along x and y, rms in cm, and the steps of all searches."""
    scale, a, b, points = polar(x, y)
    if scale == 0.0:
        return NO_SPREAD, 0.0, 0.0, 0.0, 0
    settled, a, b, error, steps = simplex_search(points, a, b, tolerance, most)
    while settled:
        settled, new_a, new_b, new_error, more = simplex_search(
            points, a, b, tolerance, most - steps
        )
        steps += more
        moved = max(abs(new_a / a - 1.0), abs(new_b / b - 1.0))
        a, b, error = new_a, new_b, min(error, new_error)
        if settled and moved <= 1e3 * tolerance:
            if not FLATTEST * a < b < a / FLATTEST:
                return NO_SPREAD, a, b, 0.0, steps
            return OK, scale * a, scale * b, scale * math.sqrt(error / x.shape[0]), steps
    return NOT_SETTLED, a, b, 0.0, steps
