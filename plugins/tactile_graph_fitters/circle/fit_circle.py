"""``fit_circle``: the circle nearest to points, by geometric least squares."""

from __future__ import annotations

from tactile_graph.steps import Linked
from tactile_graph.wires import Points
from tactile_graph.wires.stacks import Answered, PointsStack
from tactile_graph_fitters.circle.circle_outcome import circle_from, circles_from, hardly_bends
from tactile_graph_fitters.circle.fitted_circle import CircleParts, FittedCircle
from tactile_graph_fitters.circle.geometric import (
    geometric_fit,
    geometric_fit_each,
    geometric_fit_of_parts,
)


def fit_circle(points: Points) -> FittedCircle:
    """Return the circle with the least sum of squared distances from the points.

    Parameters
    ----------
    points : Points
        At least 3 that are not on one line.

    Returns
    -------
    FittedCircle

    Raises
    ------
    Degenerate
        If there are fewer than 3 distinct points, if all are on one line (to within rounding, or
        because a line fits noisy points as well as any circle does), if some are not finite, or
        if no minimum is found.

    Notes
    -----
    Minimises sum (d - R)**2 over centre and radius, d being the distances of the points from the
    centre (thesis equations 4.3 and B.3). With noise of standard deviation s the radius comes
    out too large by about s**2 / (2 R) on a full circle and by more on a short arc; the centre
    has no bias on a full circle. Best radius for a given centre is the mean of d, so two unknowns
    are left; Levenberg and Marquardt's iteration with the exact second derivatives starts from
    the hyper fit. Where that leaves an rms above a tenth of the radius, as on points that are of no
    circle, the minimum found may be a local one: another circle may have a sum less still. Source:
    N. Chernov 2010, Circular and Linear Regression, chapter 4; G. Taubin 1991,
    10.1109/34.103273, and the sources of `fit_circle_hyper` for the start.

    Points that are centres of boundary cells lie half a cell inside the outline: so does the
    circle.
    """
    return circle_from(points.xy_cm, geometric_fit.direct)


def fit_circle_stacked(points: PointsStack) -> Answered:
    """Return the circles of several frames' points; where there is none the frame is not done."""
    return circles_from(points, geometric_fit_each.call)


def fit_circle_linked() -> Linked:
    """Return the form for points as machine code hands them on."""
    return Linked(geometric_fit_of_parts, CircleParts, FittedCircle.quickly)


fit_circle.notice = hardly_bends  # type: ignore[attr-defined]
fit_circle.stacked = fit_circle_stacked  # type: ignore[attr-defined]
fit_circle.linked = fit_circle_linked  # type: ignore[attr-defined]
