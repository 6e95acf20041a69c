"""``fit_circle_thesis``: the thesis' own iteration towards the geometric circle fit."""

from __future__ import annotations

import math
from typing import Annotated

import numpy as np
from annotated_types import Ge, Gt
from numpy.typing import NDArray

from tactile_graph.compiled import compiled_later
from tactile_graph.wires import Points
from tactile_graph_fitters.circle.algebraic import back, distance_from_circle
from tactile_graph_fitters.circle.circle_outcome import circle_from, hardly_bends
from tactile_graph_fitters.circle.fitted_circle import FittedCircle
from tactile_graph_fitters.circle.principal_axes import NOT_SETTLED, OK, ONE_LINE, into_frame


def fit_circle_thesis(
    points: Points,
    *,
    max_iterations: Annotated[int, Ge(1)] = 1000,
    tolerance: Annotated[float, Gt(0)] = 1e-8,
) -> FittedCircle:
    """Return the circle on which the thesis' fixed-point iteration settles.

    Parameters
    ----------
    points : Points
        At least 3 that are not on one line.
    max_iterations : int
        Rounds after which the iteration is given up.
    tolerance : float
        The iteration has settled when a round changes centre and radius by no more than so many
        radii.

    Returns
    -------
    FittedCircle

    Raises
    ------
    Degenerate
        If the iteration has not settled after ``max_iterations``, or has on a circle that fits
        worse than a straight line does, as it may on nearly straight points; if there are fewer
        than 3 distinct points, all are on one line or some are not finite.

    Notes
    -----
    Minimises sum (d - R)**2, as `fit_circle` does and with the same bias, where it settles. Each
    round puts the last circle into equations B.8 to B.10, read as X = mean x + R mean((X - x) / d)
    and R = mean d: B.10 lacks the 1/n. It starts at the centroid. Solving B.8 for all its X at
    once instead divides by n - R sum(1/d), which is zero on a perfect circle. A round halves the
    error on a full circle; on an arc of 60 degrees it takes off 0.2 %, so that arcs shorter than
    about 120 degrees do not settle. Source: thesis 4.2.4 and appendix B.
    """
    return circle_from(points.xy_cm, thesis_fit, max_iterations, tolerance)


fit_circle_thesis.notice = hardly_bends  # type: ignore[attr-defined]


@compiled_later
def iterated(
    uv: NDArray[np.float64], max_iterations: int, tolerance: float
) -> tuple[bool, float, float, float, int]:
    """Return whether it settled, centre (u, v), radius and rounds made."""
    n = uv.shape[1]
    x = y = radius = 0.0
    for i in range(n):
        radius += math.sqrt(uv[0, i] * uv[0, i] + uv[1, i] * uv[1, i])
    radius /= n
    for rounds in range(1, max_iterations + 1):
        s_u = s_v = s_d = 0.0
        for i in range(n):
            du, dv = x - uv[0, i], y - uv[1, i]
            d = math.sqrt(du * du + dv * dv)
            if d > 0.0:
                s_u += du / d
                s_v += dv / d
            s_d += d
        new_x, new_y, new_radius = radius * s_u / n, radius * s_v / n, s_d / n
        change = max(abs(new_x - x), abs(new_y - y), abs(new_radius - radius))
        x, y, radius = new_x, new_y, new_radius
        if change <= tolerance * radius:
            return True, x, y, radius, rounds
    return False, x, y, radius, max_iterations


@compiled_later
def thesis_fit(
    xy: NDArray[np.float64], max_iterations: int, tolerance: float
) -> tuple[int, float, float, float, float, int]:
    """Return status, centre (x, y), radius and rms in cm, iterations."""
    status, uv, frame = into_frame(xy)
    if status != OK:
        return status, 0.0, 0.0, 0.0, 0.0, 0
    settled, u, v, radius, rounds = iterated(uv, max_iterations, tolerance)
    rms = distance_from_circle(uv, u, v, radius)
    line = 0.0
    for i in range(uv.shape[1]):
        line += uv[1, i] * uv[1, i]
    if settled and rms * rms * uv.shape[1] > line:
        return ONE_LINE, 0.0, 0.0, frame[2] * radius, 0.0, 0
    x, y, radius, rms = back(frame, u, v, radius, rms)
    return OK if settled else NOT_SETTLED, x, y, radius, rms, rounds
