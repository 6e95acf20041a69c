"""From a kernel's numbers to a ``FittedEllipse`` or to words about why there is none."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from tactile_graph.compiled import Kernel
from tactile_graph.errors import Degenerate
from tactile_graph_fitters.circle.principal_axes import NOT_FINITE, NOT_SETTLED, OUT_OF_RANGE
from tactile_graph_fitters.ellipse.direct_ellipse import FLAT, OTHER_CONIC, Found
from tactile_graph_fitters.ellipse.fitted_ellipse import FittedEllipse, ellipse_of
from tactile_graph_fitters.orientation.oriented import Oriented

Values = NDArray[np.float64]


def ellipse_from(xy_cm: Values, fit: Kernel[[Values], Found]) -> FittedEllipse:
    """Return the ellipse that ``fit`` finds for points of shape (N, 2) in cm.

    Raises
    ------
    Degenerate
        If it finds none, or one too large for a number; the text says why and how many points
        there were.
    """
    xy = np.ascontiguousarray(xy_cm, dtype=np.float64)
    status, x, y, first, second, angle, rms, rounds = fit.call(xy)
    if status == OUT_OF_RANGE:
        return _rescaled(xy, fit)
    if status:
        raise Degenerate(why(xy, status, rounds))
    return ellipse_of(Oriented(x, y, first, second, angle), rms, len(xy), rounds)


def _rescaled(xy: Values, fit: Kernel[[Values], Found]) -> FittedEllipse:
    """Fit points so large or small that their squares are no numbers, by a power of two."""
    _, exponent = math.frexp(float(np.abs(xy).max()))
    status, *lengths, angle, rms, rounds = fit.call(np.ldexp(xy, -exponent))
    if status:
        raise Degenerate(why(xy, status, rounds))
    try:
        x, y, first, second, rms = (math.ldexp(v, exponent) for v in (*lengths, rms))
    except OverflowError:
        raise Degenerate(f"{len(xy)} points: their ellipse is too large for a number") from None
    return ellipse_of(Oriented(x, y, first, second, angle), rms, len(xy), rounds)


def why(xy: Values, status: int, rounds: int) -> str:
    """Return in words why no ellipse fits the points."""
    n = len(xy)
    points = "1 point" if n == 1 else f"{n} points"
    if status == NOT_FINITE:
        bad = n - int(np.isfinite(xy).all(axis=1).sum())
        return f"{bad} of {points} not finite: no ellipse fits"
    if status == OTHER_CONIC:
        return f"{points}: no ellipse is near them, but another conic"
    if status == FLAT:
        return "the points lie nearly on one line: no ellipse fits"
    if status == NOT_SETTLED:
        return (
            f"{points}: no ellipse found within {rounds} rounds; a parabola or a line fits as well"
        )
    return f"{points}: an ellipse needs at least 5 distinct ones, not on one line"
