"""From a kernel's numbers to a ``FittedCircle`` or to words about why there is none."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any, TypeAlias

import numpy as np
from numpy.typing import NDArray

from tactile_graph.errors import Degenerate
from tactile_graph.wires import Points
from tactile_graph.wires.stacks import Answered, PointsStack, RecordStack
from tactile_graph_fitters.circle.fitted_circle import FittedCircle
from tactile_graph_fitters.circle.principal_axes import (
    ALL_EQUAL,
    NOT_FINITE,
    OUT_OF_RANGE,
    TOO_FEW,
)

DOUBLE = np.dtype(np.float64)
LEAST_BEND = 2.0
"""Root mean squares of the points' distances by which their arc must bend to be told from a line.
"""

Found: TypeAlias = tuple[int, float, float, float, float, int]
"""Status, centre x and y, radius, rms, iterations."""


def circle_from(
    xy_cm: NDArray[np.float64], fit: Callable[..., Found], *settings: float
) -> FittedCircle:
    """Return the circle that ``fit(xy, *settings)`` finds for points of shape (N, 2) in cm.

    Raises
    ------
    Degenerate
        If ``fit`` finds none; the text says why and how many points there were.
    """
    xy = xy_cm
    if xy.dtype is not DOUBLE or not xy.flags.c_contiguous:
        xy = np.ascontiguousarray(xy_cm, dtype=np.float64)
    if xy.ndim != 2:
        raise ValueError(f"points must be of shape (N, 2), got {xy.shape}")
    # A call that spreads out what may be nothing takes twice as long.
    status, x, y, radius, rms, iterations = fit(xy, *settings) if settings else fit(xy)
    if status:
        if status != OUT_OF_RANGE:
            raise Degenerate(why(xy, status, radius, iterations))
        return _rescaled(xy, fit, *settings)
    return FittedCircle.quickly(x, y, radius, rms, len(xy), iterations)


def circles_from(points: PointsStack, fit_each: Callable[..., None]) -> Answered:
    """Return the circles of several frames' points; frames for which ``fit_each`` finds none are
    not done.
    """
    n = len(points)
    numbers, counts = np.empty((n, 4)), np.empty((n, 3), np.int64)
    fit_each(points.xy_cm, points.starts, numbers, counts)
    columns: dict[str, NDArray[Any]] = {
        name: numbers[:, k] for k, name in enumerate(("x_cm", "y_cm", "radius_cm", "rms_cm"))
    }
    columns |= {"n_points": counts[:, 1], "iterations": counts[:, 2]}
    return Answered(RecordStack(FittedCircle.quickly, columns), counts[:, 0] == 0)


def _rescaled(xy: NDArray[np.float64], fit: Callable[..., Found], *settings: float) -> FittedCircle:
    """Fit points so large or small that their squares are no numbers, by a power of two."""
    _, exponent = math.frexp(float(np.abs(xy).max()))
    status, x, y, radius, rms, iterations = fit(np.ldexp(xy, -exponent), *settings)
    if status:
        raise Degenerate(why(xy, status, radius, iterations))
    try:
        x, y, radius, rms = (math.ldexp(v, exponent) for v in (x, y, radius, rms))
    except OverflowError:
        raise Degenerate(f"{len(xy)} points: their circle is too large for a number") from None
    return FittedCircle.quickly(x, y, radius, rms, len(xy), iterations)


def hardly_bends(points: Points, value: FittedCircle) -> str:
    """Return what to say of a circle whose points may as well lie along a line; else empty."""
    (x, y), rms = (points.xy_cm - (value.x_cm, value.y_cm)).T, value.rms_cm
    angles = np.sort(np.arctan2(y, x))
    open_rad = max(float(np.diff(angles).max(initial=0.0)), 2.0 * math.pi - float(np.ptp(angles)))
    bend = 2.0 * value.radius_cm * math.sin(0.25 * (2.0 * math.pi - open_rad)) ** 2
    if not bend < LEAST_BEND * rms:
        return ""
    return (
        f"over its {len(points.xy_cm)} points the circle bends by {bend:.2g} cm, and they lie "
        f"{rms:.2g} cm off it: these are no points of a disc, whose centre and radius they would "
        "tell"
    )


def why(xy: NDArray[np.float64], status: int, radius: float, iterations: int) -> str:
    """Return in words why no circle fits the points."""
    n = len(xy)
    points = "1 point" if n == 1 else f"{n} points"
    if status == TOO_FEW:
        return f"{points}: a circle needs at least 3 that are not on one line"
    if status == NOT_FINITE:
        bad = n - int(np.isfinite(xy).all(axis=1).sum())
        return f"{bad} of {points} not finite: no circle fits"
    if status == ALL_EQUAL:
        return f"{points}, all at one place: no circle fits"
    if iterations:
        return (
            f"{points}: no circle found within {iterations} iterations; they cover too little "
            "of one, or lie too far from any"
        )
    distinct = len(np.unique(xy, axis=0))
    if distinct < 3:
        return f"{points} at {distinct} places: a circle needs at least 3 that are not on one line"
    if radius > 0.0:
        return f"{points} nearly on one line: a straight line fits as well as any circle"
    return f"{points} on one line: no circle fits"
