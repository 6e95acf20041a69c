"""``fit_circle_hyper``: the algebraic fit without essential bias; closed form."""

from __future__ import annotations

from tactile_graph.wires import Points
from tactile_graph_fitters.circle.algebraic import HYPER, algebraic_fit
from tactile_graph_fitters.circle.circle_outcome import circle_from, hardly_bends
from tactile_graph_fitters.circle.fitted_circle import FittedCircle


def fit_circle_hyper(points: Points) -> FittedCircle:
    """Return the hyper circle, the algebraic fit whose essential bias is zero.

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
    Minimises sum (A w + B x + C y + D)**2 with w = x**2 + y**2, under that quadratic constraint
    on A, B, C, D for which the part of the bias that does not fall with the number of points
    vanishes to second order of the noise; bias of order s**2 / N remains. Source: Al-Sharadqah
    and Chernov 2009, 10.1214/09-EJS419.
    """
    return circle_from(points.xy_cm, algebraic_fit, HYPER)


fit_circle_hyper.notice = hardly_bends  # type: ignore[attr-defined]
