"""``shape_decision``: whether an outline is a disc, an ellipse, a rectangle or a polygon."""

from __future__ import annotations

import math
from typing import Annotated, NamedTuple, TypeAlias

import numpy as np
from annotated_types import Ge, Gt, Le
from numpy.typing import NDArray

from tactile_graph.errors import Degenerate
from tactile_graph.wires import Circle, Ellipse, Image, Points, Polygon, Rectangle
from tactile_graph_fitters.circle.fitted_circle import FittedCircle
from tactile_graph_fitters.ellipse.fitted_ellipse import ellipse_of
from tactile_graph_fitters.orientation.element_pitch import THESIS_PITCH_CM, element_pitch_cm
from tactile_graph_fitters.orientation.oriented import Oriented
from tactile_graph_fitters.rectangle.fitted_rectangle import rectangle_of
from tactile_graph_fitters.shape.shape_confidence import (
    KINDS,
    MOST_CORNERS,
    Kind,
    confidences,
    features,
)
from tactile_graph_fitters.shape.shape_fits import DISC, FEWEST_CORNERS, RECTANGLE, shape_fits

Values: TypeAlias = NDArray[np.float64]
AnyShape: TypeAlias = Circle | Ellipse | Rectangle | Polygon

PER_CELL = 2.0  # points of the hull's outline, evenly spread, that are compared
FLOOR_CELLS = 0.12  # rms distance from a polygon, in cells, below which closer is not better
MOST_CELLS = 1e5  # that an outline may span
EVIDENCE = 0.6  # independent measurements per cell's length of outline


class ShapeDecision(NamedTuple):
    """What an outline is, and how sure that is.

    ``confidence`` is that of ``kind``; ``disc``, ``ellipse``, ``rectangle`` and ``polygon`` hold
    that of each and sum to 1. ``corners`` counts those of a rectangle or polygon, 0 for others.
    """

    kind: Kind
    confidence: float
    shape: AnyShape
    corners: int
    disc: float
    ellipse: float
    rectangle: float
    polygon: float


class Fits(NamedTuple):
    """What `shape_fits` returns."""

    n: int
    length_cm: float
    mean_squares_cm2: Values
    shapes: Values
    polygons: Values


def shape_decision(
    points: Points,
    elements: Image | None = None,
    *,
    cell_cm: Annotated[float | None, Gt(0)] = None,
    max_corners: Annotated[int, Ge(3), Le(12)] = MOST_CORNERS,
    temperature: Annotated[float, Gt(0)] = 1.0,
) -> ShapeDecision:
    """Return the kind of shape that an outline is most likely of, with its confidence.

    Parameters
    ----------
    points : Points
        Of the boundary.
    elements : Image, optional
        What was read, as it was read: not subdivided.
    cell_cm : float, optional
        Pitch of the elements that were read; that of ``elements`` if not given, or 1.3, the
        thesis' pad's.
    max_corners : int
        A polygon is given 3 up to so many corners.
    temperature : float
        Above 1 all confidences come out more alike, below 1 less; 1 is calibrated.

    Returns
    -------
    ShapeDecision

    Raises
    ------
    Degenerate
        If the points' hull has no area, or nothing can be fitted to it.

    Notes
    -----
    A disc, an ellipse, a rectangle and polygons are fitted to the convex hull of the points, its
    outline evenly sampled. Confidences are those of a logistic regression on the logarithms of
    the mean squared distances and of the outline's length in cells, fitted to objects of all kinds,
    equally frequent, on the simulated pad: ``benchmarks/shape_confidence.py``. Where some kinds are
    likelier beforehand, multiply by how much and normalise. The number of a polygon's corners is
    that of Schwarz' least criterion n ln(rms**2 + f**2) + k ln n with k unknowns, two a corner, n
    0.6 times the outline's length in cells and f = 0.12 cells. Source: G. Schwarz 1978,
    10.1214/aos/1176344136.
    """
    from tactile_graph_hull.hull import hull

    outline = hull(points)
    cell_cm = element_pitch_cm(elements, cell_cm)
    _refuse_far_apart(outline, cell_cm)
    if outline.count < 3 or outline.area_cm2 <= 0.0:
        raise Degenerate(f"{points.count} points on one line: no shape to decide on")
    most = max(max_corners, MOST_CORNERS)
    fits = Fits(*shape_fits(outline.xy_cm, cell_cm / PER_CELL, most, cell_cm))
    share = confidences(features(fits.length_cm, fits.mean_squares_cm2, cell_cm), temperature)
    rows = [*range(FEWEST_CORNERS), _best_polygon(fits, max_corners, cell_cm)]
    able = [k for k, row in enumerate(rows) if fits.mean_squares_cm2[row] < math.inf]
    if not able:
        raise Degenerate(f"{points.count} points: no shape can be fitted to their hull")
    best = max(able, key=lambda k: share[k])
    corners = (0, 0, 4, rows[3])[best]
    shape = _shape(fits, rows[best], cell_cm)
    return ShapeDecision(KINDS[best], share[best], shape, corners, *share)


shape_decision.usual_cm = {"cell_cm": THESIS_PITCH_CM}  # type: ignore[attr-defined]


def _refuse_far_apart(outline: Polygon, cell_cm: float) -> None:
    """Raise where the outline spans so many cells that it can be of no pad."""
    if outline.count == 0:
        return
    reach = MOST_CELLS * cell_cm
    # halves: the difference of the largest numbers is none
    half = 0.5 * outline.xy_cm.max(axis=0) - 0.5 * outline.xy_cm.min(axis=0)
    if half.max() > 0.5 * reach:
        raise Degenerate(
            f"the points lie more than {MOST_CELLS:,.0f} cells of {cell_cm:g} cm apart; "
            "is cell_cm right?"
        )


def _best_polygon(fits: Fits, most: int, cell_cm: float) -> int:
    """Return the number of corners, 3 to ``most``, of the least criterion."""
    n = max(fits.length_cm / cell_cm * EVIDENCE, 2.0)
    floor = (FLOOR_CELLS * cell_cm) ** 2
    mean_squares = fits.mean_squares_cm2[: most + 1].tolist()
    return min(
        range(FEWEST_CORNERS, most + 1),
        key=lambda k: n * math.log(mean_squares[k] + floor) + 2 * k * math.log(n),
    )


def _shape(fits: Fits, row: int, cell_cm: float) -> AnyShape:
    rms = math.sqrt(fits.mean_squares_cm2[row])
    if row > RECTANGLE:
        return Polygon(fits.polygons[row, :row].copy())
    x, y, first, second, angle = fits.shapes[row].tolist()
    if row == DISC:
        return FittedCircle(x, y, first, rms, fits.n)
    if row == RECTANGLE:
        sides = Oriented(x, y, 2.0 * first, 2.0 * second, angle)
        return rectangle_of(sides, rms, fits.n, 0, cell_cm)
    # As seen angles run against those of (x, y) with y down.
    return ellipse_of(Oriented(x, y, first, second, -angle), rms, fits.n, 0)
