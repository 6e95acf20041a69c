"""Which steps have a reference, and what it says of a case."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
from numpy.typing import NDArray

from tactile_graph_stress.references import circles, ellipses
from tactile_graph_stress.references.axis import main_axis
from tactile_graph_stress.references.stationary import Fit, Solved, shape_of, solve

Values = NDArray[np.float64]

CIRCLES: dict[str, tuple[Fit, ...]] = {
    "fit_circle_kasa": (circles.KASA,),
    "fit_circle_taubin": (circles.KASA, circles.TAUBIN),
    "fit_circle_hyper": (circles.KASA, circles.HYPER),
    "fit_circle": (circles.KASA, circles.HYPER, circles.GEOMETRIC),
    "fit_circle_thesis": (circles.KASA, circles.HYPER, circles.GEOMETRIC),
}
"""For each step the fits that lead to its own, each starting where the one before ended."""

ELLIPSES = {"fit_ellipse": ellipses.GEOMETRIC, "fit_ellipse_direct": ellipses.DIRECT}

HULLS = ("hull", "hull_beneath_beyond", "hull_graham", "hull_qhull")


def reference_of(step: str) -> Callable[[Values, Any], Solved | None] | None:
    """Return the function from points and the step's own answer to the right one, if there is."""
    if step in CIRCLES:
        return lambda xy, value: _circle(CIRCLES[step], xy, value)
    if step in ELLIPSES:
        return lambda xy, value: solve(ELLIPSES[step], xy, [parts_of(value)])
    if step == "orientation":
        return lambda xy, value: main_axis(xy)
    return None


def parts_of(value: Any) -> list[float]:
    """Return a step's answer as references order it: x, y, lengths, angle with y running down."""
    if hasattr(value, "radius_cm"):
        return [value.x_cm, value.y_cm, value.radius_cm]
    lengths = [value.semi_major_cm, value.semi_minor_cm] if hasattr(value, "semi_major_cm") else []
    return [value.x_cm, value.y_cm, *lengths, -value.angle_rad]


def _circle(fits: tuple[Fit, ...], xy: Values, value: Any) -> Solved | None:
    """Return the best answer found, from the step's own and from others' to the same points."""
    middle = xy.mean(axis=0) if np.abs(xy).max() < 1e150 else xy[0]
    start: list[Any] = [*middle.tolist(), 1.0]
    mine = parts_of(value)
    starts: list[list[Any]] = []
    for fit in fits:
        starts = [start]
        found = shape_of(fit, xy, starts)
        if found is None or not _near(found, mine):  # there are other roots: which is best?
            starts = [start, mine]
            found = shape_of(fit, xy, starts)
        if found is None:
            return None
        start = found
    return solve(fits[-1], xy, starts)


def _near(found: list[Any], mine: list[float]) -> bool:
    """Return whether two circles differ by no more than a millionth of their radius."""
    pairs = zip(found, mine, strict=True)
    return bool(max(abs(a - b) for a, b in pairs) <= 1e-6 * abs(found[2]))
