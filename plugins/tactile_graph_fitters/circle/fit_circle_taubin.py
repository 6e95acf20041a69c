"""``fit_circle_taubin``: powers weighed by their gradient; closed form, good on arcs."""

from __future__ import annotations

from tactile_graph.wires import Points
from tactile_graph_fitters.circle.algebraic import TAUBIN, algebraic_fit
from tactile_graph_fitters.circle.circle_outcome import circle_from, hardly_bends
from tactile_graph_fitters.circle.fitted_circle import FittedCircle


def fit_circle_taubin(points: Points) -> FittedCircle:
    """Return Taubin's circle, an algebraic fit nearly as good as the geometric one.

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
    Minimises sum (d**2 - R**2)**2 / sum d**2: powers over their mean squared gradient. With noise
    of standard deviation s on N points the part of its bias that does not fall with N is twice
    the geometric fit's for the radius, about s**2 / R on a full circle. Source: G. Taubin 1991,
    10.1109/34.103273; Al-Sharadqah and Chernov 2009, 10.1214/09-EJS419.
    """
    return circle_from(points.xy_cm, algebraic_fit, TAUBIN)


fit_circle_taubin.notice = hardly_bends  # type: ignore[attr-defined]
