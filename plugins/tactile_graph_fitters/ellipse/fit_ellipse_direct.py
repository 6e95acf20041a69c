"""``fit_ellipse_direct``: the algebraic ellipse of Fitzgibbon, made stable by Halíř and Flusser."""

from __future__ import annotations

from tactile_graph.wires import Points
from tactile_graph_fitters.ellipse.direct_ellipse import direct_fit
from tactile_graph_fitters.ellipse.ellipse_outcome import ellipse_from
from tactile_graph_fitters.ellipse.fitted_ellipse import FittedEllipse


def fit_ellipse_direct(points: Points) -> FittedEllipse:
    """Return the ellipse of least squared conic values, the solution of a small eigenproblem.

    Parameters
    ----------
    points : Points
        At least 5 distinct ones, not on a line or two.

    Returns
    -------
    FittedEllipse
        Its ``rms_cm`` is of geometric distances, not of what is minimised.

    Raises
    ------
    Degenerate
        If there are fewer than 5 distinct points, some are not finite, or they lie on a line, on
        two lines, or on a parabola or hyperbola so that no ellipse is left.

    Notes
    -----
    Minimises the sum of (A u**2 + B u v + C v**2 + D u + E v + F)**2 with 4 A C - B**2 = 1, which
    only ellipses meet; points scaled and on main axes. A conic's value grows faster
    outwards than inwards: on noisy short arcs the ellipse comes out too small and too flat.
    Source: Fitzgibbon, Pilu and Fisher 1999, 10.1109/34.765658; Halíř and Flusser 1998, Numerically
    stable direct least squares fitting of ellipses, WSCG.
    """
    return ellipse_from(points.xy_cm, direct_fit)
