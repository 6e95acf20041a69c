"""``fit_ellipse``: the ellipse nearest to points, by geometric least squares."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from tactile_graph.compiled import compiled_later
from tactile_graph.errors import Degenerate
from tactile_graph.wires import Points
from tactile_graph_fitters.circle.principal_axes import NOT_SETTLED, OK
from tactile_graph_fitters.ellipse.damped_steps import damped_step
from tactile_graph_fitters.ellipse.direct_ellipse import Found, direct_shape, ellipse_frame, in_pad
from tactile_graph_fitters.ellipse.ellipse_outcome import ellipse_from
from tactile_graph_fitters.ellipse.fitted_ellipse import FittedEllipse
from tactile_graph_fitters.ellipse.nearest_on_ellipse import along_axes, feet
from tactile_graph_fitters.ellipse.newton_ellipse import newton

ROUNDS = 200
NEWTON = 12  # rounds at most of Newton's method, which is for the last ones
AGAIN = 4  # rounds after which it is tried again
STEP = 1e-11  # of the points' extent
SETTLING = 8  # steps at the end, each less than half the one before
LONG = 10.0  # half axes, in extents of the points, that are tried doubled
PAUSE = 8  # rounds after which they are again, where that led nowhere
LARGEST = 1e3  # half axes, in extents of the points, beyond which they are no ellipse's
DOUBTED = 1.5  # half axes, in extents of the points, from which on it is asked how sure they are
UNSURE = 0.2  # standard deviation of such a half axis, in itself, from which on it says nothing

Values = NDArray[np.float64]


def fit_ellipse(points: Points) -> FittedEllipse:
    """Return the ellipse with the least sum of squared distances from the points.

    Parameters
    ----------
    points : Points
        At least 5 distinct ones, not on a line or two.

    Returns
    -------
    FittedEllipse
        ``rms_cm`` is the root mean square distance, what is minimised.

    Raises
    ------
    Degenerate
        As `fit_ellipse_direct`, from whose ellipse the search starts; or if no minimum is found,
        or one longer than the points reach by an amount they leave open (standard deviation above a
        fifth of it): a parabola fits as well.

    Notes
    -----
    Minimises the sum of squared orthogonal distances over centre, half axes and angle by
    Newton's method on these and the places of all nearest points together; where the points are
    too far from an ellipse for it, by Levenberg and Marquardt's iteration, in which the nearest
    points are found in each round. With noise of standard deviation s the half axes come out too
    large by about s**2 / (2 r), r being the radius of curvature there. Source: Ahn, Rauh and
    Warnecke 2001, 10.1016/S0031-3203(00)00152-7.
    """
    found = ellipse_from(points.xy_cm, geometric_fit)
    xy = points.xy_cm
    if found.semi_major_cm > DOUBTED * float((xy.max(axis=0) - xy.min(axis=0)).max()):
        std_cm = semi_major_std_cm(found, xy)
        if not std_cm <= UNSURE * found.semi_major_cm:
            raise Degenerate(
                f"{found.n_points} points: no ellipse, a parabola fits as well (half axis "
                f"{found.semi_major_cm:.3g} cm, standard deviation {std_cm:.3g} cm)"
            )
    return found


def semi_major_std_cm(found: FittedEllipse, xy_cm: Values) -> float:
    """Return the standard deviation of the major half axis, by the slopes of the distances.

    Parameters
    ----------
    found : FittedEllipse
        The nearest ellipse; its distances say how far points are off.
    xy_cm : ndarray, shape (N, 2)
        The points that it was fitted to.

    Returns
    -------
    float
        0 for points on the ellipse; infinite where they say nothing of its length.
    """
    a, b = found.semi_major_cm, found.semi_minor_cm
    cos, sin = math.cos(found.angle_rad), math.sin(found.angle_rad)
    x, y = xy_cm[:, 0] - found.x_cm, xy_cm[:, 1] - found.y_cm
    u, v = (x * cos - y * sin) / a, (x * sin + y * cos) / b  # 1 from the centre on the ellipse
    steep = np.hypot(u / a, v / b)
    # Each half of what the equation of the ellipse changes by; lengths in half axes, so that the
    # columns are alike in size.
    along = (-u * u, -v * v, -u, -v, u * v * (b / a - a / b))
    slopes = np.column_stack(along) / steep[:, None]
    singular, rows = np.linalg.svd(slopes, full_matrices=False)[1:]
    if not singular[-1] > 0.0:
        return math.inf
    n = len(xy_cm)
    off_cm = found.rms_cm * math.sqrt(n / max(n - 5, 1))
    return float(off_cm * np.linalg.norm(rows[:, 0] / singular) * a)


@compiled_later
def geometric_fit(xy: Values) -> Found:
    """Return the nearest ellipse of points, shape (N, 2), in cm, and the rounds it took."""
    status, uv, frame = ellipse_frame(xy)
    if status != OK:
        return status, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0
    p = np.empty(5)
    status, p[0], p[1], p[2], p[3], p[4] = direct_shape(uv)
    if status != OK:
        return status, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0
    rms, rounds = refined(uv, p, STEP)
    if rounds <= 0:
        return NOT_SETTLED, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, -rounds
    return in_pad(frame, (p[0], p[1], p[2], p[3], p[4]), rms, rounds)


@compiled_later
def equations(uv: Values, p: Values, normal: Values, slope: Values) -> float:
    """Return the sum of squared distances; write the normal matrix and the slope of half of it."""
    a, b = p[2], p[3]
    cos, sin = math.cos(p[4]), math.sin(p[4])
    n = uv.shape[1]
    xy = along_axes(uv, p[0], p[1], p[4])
    cs = feet(xy, a, b)
    rows = np.empty((6, n))
    for i in range(n):
        c, s = cs[0, i], cs[1, i]
        # The outward normal at the nearest point, along which the distance is measured.
        nx, ny = b * c, a * s
        size = 1.0 / math.sqrt(nx * nx + ny * ny)
        nx, ny = nx * size, ny * size
        rows[0, i], rows[1, i] = ny * sin - nx * cos, -nx * sin - ny * cos
        rows[2, i], rows[3, i], rows[4, i] = -nx * c, -ny * s, nx * b * s - ny * a * c
        rows[5, i] = (xy[0, i] - a * c) * nx + (xy[1, i] - b * s) * ny
    total = 0.0
    for i in range(n):
        total += rows[5, i] * rows[5, i]
    for k in range(5):
        a_0 = a_1 = a_2 = a_3 = a_4 = a_5 = 0.0
        for i in range(n):
            row = rows[k, i]
            a_0 += row * rows[0, i]
            a_1 += row * rows[1, i]
            a_2 += row * rows[2, i]
            a_3 += row * rows[3, i]
            a_4 += row * rows[4, i]
            a_5 += row * rows[5, i]
        normal[k, 0], normal[k, 1], normal[k, 2] = a_0, a_1, a_2
        normal[k, 3], normal[k, 4], slope[k] = a_3, a_4, a_5
    return total


@compiled_later
def refined(uv: Values, p: Values, least: float) -> tuple[float, int]:
    """Bring ``p`` to the minimum; return the rms and the rounds made, < 0 if none was found.

    Newton's method finds it where it is near; else Levenberg and Marquardt's goes on from where it
    was until it is. The search ends with a step below ``least`` of the larger half axis.
    """
    n = uv.shape[1]
    small = np.empty((13, 5))
    normal, slope, trial = small[:5], small[5], small[12]
    for k in range(5):
        trial[k] = p[k]
    now, size, damping, ends = np.inf, np.inf, 1e-3, False
    rounds, leap_from = 0, 1
    while rounds <= ROUNDS:
        if ends or rounds % AGAIN == 0:
            found, more = newton(uv, p, NEWTON)
            if more > 0:
                return math.sqrt(found / n), rounds + more
        if ends:
            return math.sqrt(_settled(uv, p, now) / n), rounds
        leap = rounds >= leap_from and max(p[2], p[3]) > LONG
        if leap:
            _lengthened(p, trial)
        elif rounds > 0:
            size = _stepped(p, normal, slope, damping, trial)
        taken, now = _taken(uv, p, trial, leap, now, small)
        if taken and max(p[2], p[3]) > LARGEST:
            return 0.0, -max(rounds, 1)
        if leap:
            leap_from = leap_from if taken else rounds + PAUSE
            continue
        if not taken:
            damping = max(10.0 * damping, 1e-8)
        else:
            damping = 0.1 * damping if damping > 1e-14 else 0.0
        ends = size <= least * max(p[2], p[3]) or damping > 1e14
        rounds += 1
    return 0.0, -ROUNDS


@compiled_later
def _taken(
    uv: Values, p: Values, trial: Values, leap: bool, now: float, small: Values
) -> tuple[bool, float]:
    """Go to a trial if it is no worse, or for a leap better; return whether it is, and the sum.

    The first six rows of ``small`` are the normal matrix and the slope there, the next six room.
    """
    n = uv.shape[1]
    new = np.inf
    if min(trial[2], trial[3]) > 0.0:
        new = equations(uv, trial, small[6:11], small[11])
    # Rounding of the sum is let pass, but for it nothing is made longer.
    rounding = 1e-15 * n * (p[2] * p[2] * 1e-15 + now / n)
    if not new <= (now - rounding if leap else now + rounding):
        return False, now
    for k in range(5):
        p[k] = trial[k]
    for k in range(6):
        for m in range(5):
            small[k, m] = small[k + 6, m]
    return True, min(now, new)


@compiled_later
def _lengthened(p: Values, trial: Values) -> None:
    """Write an ellipse twice as long with the same end and curvature near the points' middle.

    So a parabola is soon reached where one fits better, which steps do in hundreds.
    """
    long = 2 if p[2] > p[3] else 3
    turn = p[4] + (0.0 if long == 2 else 0.5 * math.pi)
    u, v = p[long] * math.cos(turn), p[long] * math.sin(turn)
    side = 1.0 if u * p[0] + v * p[1] > 0.0 else -1.0
    trial[0], trial[1], trial[4] = p[0] + side * u, p[1] + side * v, p[4]
    trial[2], trial[3] = math.sqrt(2.0) * p[2], math.sqrt(2.0) * p[3]
    trial[long] = 2.0 * p[long]


@compiled_later
def _stepped(p: Values, normal: Values, slope: Values, damping: float, trial: Values) -> float:
    """Write where a damped step leads to; return its size. Without one: nowhere, and infinity."""
    # On a circle the angle has no slope: a ridge, far below any other's, leaves it alone.
    ridge = 1e-12 * (normal[0, 0] + normal[1, 1])
    for k in range(5):
        normal[k, k] += ridge
    found = damped_step(normal, slope, damping, trial)
    for k in range(5):
        normal[k, k] -= ridge
    if not found:
        trial[2] = 0.0
        return np.inf
    size = abs(trial[4]) * abs(p[2] - p[3])
    for k in range(4):
        size = max(size, abs(trial[k]))
    for k in range(5):
        trial[k] += p[k]
    return float(size)


@compiled_later
def _settled(uv: Values, p: Values, now: float) -> float:
    """Take undamped steps as long as they halve; return the sum of squared distances.

    At the minimum the sum is too coarse to judge a step by, but a step that is less than half
    the one before still leads nearer.
    """
    normal, slope, trial = np.empty((5, 5)), np.empty(5), np.empty(5)
    last = 1e-6 * max(p[2], p[3])
    for _ in range(SETTLING):
        new = equations(uv, p, normal, slope)
        size = _stepped(p, normal, slope, 0.0, trial)
        if not 0.0 < size <= 0.5 * last:
            break
        now, last = min(now, new), size
        for k in range(5):
            p[k] = trial[k]
    return now
