"""``fit_ellipse``: the ellipse nearest to points, by geometric least squares."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from tactile_graph.compiled import compiled_as_is
from tactile_graph.errors import Degenerate
from tactile_graph.wires import Points
from tactile_graph_fitters.damped_steps import damped_step
from tactile_graph_fitters.fit_ellipse_direct import direct_shape, framed, in_pad
from tactile_graph_fitters.fitted_ellipse import FittedEllipse
from tactile_graph_fitters.nearest_on_ellipse import nearest

ROUNDS = 200
STEP = 1e-11  # of the points' extent
SETTLING = 8  # steps at the end, each less than half the one before
LARGEST = 1e3  # half axes, in extents of the points, beyond which they are no ellipse's

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
        as where a parabola fits as well as any ellipse.

    Notes
    -----
    Minimises the sum of squared orthogonal distances over centre, half axes and angle by
    Levenberg and Marquardt's iteration; the nearest point of the ellipse is found for each
    point in each round, and the distances' slopes are exact. With noise of standard deviation s
    the half axes come out too large by about s**2 / (2 r), r being the radius of curvature there.
    Source: Ahn, Rauh and Warnecke 2001, 10.1016/S0031-3203(00)00152-7.
    """
    xy = np.ascontiguousarray(points.xy_cm, dtype=np.float64)
    uv, frame = framed(xy)
    p = np.array(direct_shape(uv))
    rms, rounds = refined(uv, p, STEP)
    n = len(xy)
    if rounds <= 0:
        raise Degenerate(f"{n} points: no ellipse found within {-rounds} rounds; "
                         "a parabola or a line fits as well")  # fmt: skip
    u, v, a, b, angle = p.tolist()
    return in_pad((u, v, a, b, angle), frame, rms, n, rounds)


@compiled_as_is
def equations(uv: Values, p: Values, normal: Values, slope: Values) -> float:
    """Return the sum of squared distances; write the normal matrix and the slope of half of it."""
    a, b = p[2], p[3]
    cos, sin = math.cos(p[4]), math.sin(p[4])
    row = np.empty(5)
    for k in range(5):
        slope[k] = 0.0
        for m in range(5):
            normal[k, m] = 0.0
    total = 0.0
    for i in range(uv.shape[1]):
        du, dv = uv[0, i] - p[0], uv[1, i] - p[1]
        x, y = du * cos + dv * sin, dv * cos - du * sin
        fx, fy = nearest(a, b, x, y)
        # The outward normal at the nearest point, along which the distance is measured.
        nx, ny = fx / (a * a), fy / (b * b)
        size = math.hypot(nx, ny)
        nx, ny = nx / size, ny / size
        distance = (x - fx) * nx + (y - fy) * ny
        total += distance * distance
        row[0], row[1] = ny * sin - nx * cos, -nx * sin - ny * cos
        row[2], row[3] = -nx * fx / a, -ny * fy / b
        row[4] = nx * fy - ny * fx
        for k in range(5):
            slope[k] += distance * row[k]
            for m in range(k + 1):
                normal[k, m] += row[k] * row[m]
    for k in range(5):
        for m in range(k):
            normal[m, k] = normal[k, m]
    return total


@compiled_as_is
def refined(uv: Values, p: Values, least: float) -> tuple[float, int]:
    """Bring ``p`` to the minimum; return the rms and the rounds made, < 0 if none was found.

    The search ends with a step below ``least`` of the larger half axis.
    """
    normal, slope, step = np.empty((5, 5)), np.empty(5), np.empty(5)
    new_normal, new_slope, trial = np.empty((5, 5)), np.empty(5), np.empty(5)
    n = uv.shape[1]
    now = equations(uv, p, normal, slope)
    damping = 1e-4
    for rounds in range(1, ROUNDS + 1):
        # On a circle the angle has no slope: a ridge, far below any other's, leaves it alone.
        ridge = 1e-12 * (normal[0, 0] + normal[1, 1])
        for k in range(5):
            normal[k, k] += ridge
        size = np.inf
        new = np.inf
        if damped_step(normal, slope, damping, step):
            size = 0.0
            for k in range(4):
                trial[k] = p[k] + step[k]
                size = max(size, abs(step[k]))
            trial[4] = p[4] + step[4]
            size = max(size, abs(step[4]) * abs(p[2] - p[3]))
            if min(trial[2], trial[3]) > 0.0:
                new = equations(uv, trial, new_normal, new_slope)
        for k in range(5):
            normal[k, k] -= ridge
        if new <= now + 1e-15 * n * (p[2] * p[2] * 1e-15 + now / n):
            for k in range(5):
                p[k], slope[k] = trial[k], new_slope[k]
                for m in range(5):
                    normal[k, m] = new_normal[k, m]
            now = min(now, new)
            damping = 0.1 * damping if damping > 1e-14 else 0.0
            if max(p[2], p[3]) > LARGEST:
                return 0.0, -rounds
        else:
            damping = max(10.0 * damping, 1e-8)
        if size <= least * max(p[2], p[3]) or damping > 1e14:
            return math.sqrt(_settled(uv, p, now) / n), rounds
    return 0.0, -ROUNDS


@compiled_as_is
def _settled(uv: Values, p: Values, now: float) -> float:
    """Take undamped steps as long as they halve; return the sum of squared distances.

    At the minimum the sum is too coarse to judge a step by, but a step that is less than half
    the one before still leads nearer.
    """
    normal, slope, step = np.empty((5, 5)), np.empty(5), np.empty(5)
    last = 1e-6 * max(p[2], p[3])
    for _ in range(SETTLING):
        new = equations(uv, p, normal, slope)
        ridge = 1e-12 * (normal[0, 0] + normal[1, 1])
        for k in range(5):
            normal[k, k] += ridge
        if not damped_step(normal, slope, 0.0, step):
            break
        size = abs(step[4]) * abs(p[2] - p[3])
        for k in range(4):
            size = max(size, abs(step[k]))
        if size > 0.5 * last or size == 0.0:
            break
        now, last = min(now, new), size
        for k in range(5):
            p[k] += step[k]
    return now
