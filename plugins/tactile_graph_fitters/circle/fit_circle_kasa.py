"""``fit_circle_kasa``: the circle of least squared powers; the simplest fit, too small on arcs."""

from __future__ import annotations

from tactile_graph.wires import Points
from tactile_graph_fitters.circle.algebraic import KASA, algebraic_fit
from tactile_graph_fitters.circle.circle_outcome import circle_from, hardly_bends
from tactile_graph_fitters.circle.fitted_circle import FittedCircle


def fit_circle_kasa(points: Points) -> FittedCircle:
    """Return Kåsa's circle, the solution of a linear least squares problem.

    Parameters
    ----------
    points : Points
        At least 3 that are not on one line.

    Returns
    -------
    FittedCircle
        Its ``rms_cm`` is of geometric distances, not of what is minimised.

    Raises
    ------
    Degenerate
        If there are fewer than 3 distinct points, all are on one line or some are not finite.

    Notes
    -----
    Minimises sum (d**2 - R**2)**2, the points' powers. A power is about 2 R times the distance, so
    a small circle is cheap: on short arcs the radius comes out far too small (on 60 degrees of
    radius 100 with noise 2, about 82). Good on full circles only. Source: I. Kåsa 1976,
    10.1109/TIM.1976.6312298.
    """
    return circle_from(points.xy_cm, algebraic_fit, KASA)


fit_circle_kasa.notice = hardly_bends  # type: ignore[attr-defined]
