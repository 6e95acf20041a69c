"""``rectangle_from_ellipse``: the sides of a rectangle, read off an ellipse as the thesis does."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Annotated, ClassVar

import numpy as np
from annotated_types import Gt
from pydantic import AllowInfNan

from tactile_graph.errors import Degenerate
from tactile_graph.wires import Ellipse, Image, Rectangle
from tactile_graph_fitters.ellipse.fitted_ellipse import FittedEllipse
from tactile_graph_fitters.orientation.element_pitch import THESIS_PITCH_CM, element_pitch_cm
from tactile_graph_fitters.rectangle.fitted_rectangle import alike

# Half axes a, b of the ellipse that `fit_ellipse_origin` fits to the evenly covered outline of a
# rectangle with half sides p, q: the columns are b / a, p / a, q / b, for q / p from 0.02 to 1.
BIAS = np.array([
    (0.01742068, 0.74045501, 0.85001654),
    (0.04915764, 0.80993926, 0.82381811),
    (0.10504649, 0.85042946, 0.80956425),
    (0.16122302, 0.86719545, 0.80682727),
    (0.21643484, 0.87557572, 0.80908775),
    (0.27035634, 0.88004723, 0.81378334),
    (0.32302200, 0.88243942, 0.81954640),
    (0.42526642, 0.88404379, 0.83152005),
    (0.52454810, 0.88352808, 0.84218105),
    (0.62186350, 0.88194212, 0.85093472),
    (0.71779946, 0.87972881, 0.85791360),
    (0.81268598, 0.87711927, 0.86342921),
    (0.90671327, 0.87425648, 0.86779002),
    (1.00000000, 0.87123676, 0.87123676),
])  # fmt: skip


@dataclass(frozen=True)
class EllipseRectangle(Rectangle):
    """A rectangle read off an ellipse fitted to its outline.

    ``length_cm`` and ``breadth_cm`` are the full axes, as the thesis reports them;
    ``corrected_length_cm`` and ``corrected_breadth_cm`` the sides of the rectangle to whose
    outline that ellipse is fitted. ``rms_cm`` is the ellipse's, 0 where it has none; ``ambiguous``
    says that the sides are too alike for the angle to mean anything.
    """

    corrected_length_cm: float
    corrected_breadth_cm: float
    rms_cm: float = 0.0
    n_points: int = 0
    ambiguous: bool = False
    columns_shown: ClassVar[tuple[str, ...]] = (
        *Rectangle.columns_shown,
        "corrected_length_cm",
        "corrected_breadth_cm",
        "rms_cm",
    )

    @property
    def corrected(self) -> Rectangle:
        """The rectangle with the corrected sides."""
        return Rectangle(
            self.x_cm,
            self.y_cm,
            self.corrected_length_cm,
            self.corrected_breadth_cm,
            self.angle_rad,
        )


def rectangle_from_ellipse(
    ellipse: Ellipse,
    elements: Image | None = None,
    *,
    inside_cm: Annotated[float, AllowInfNan(False)] | None = None,
    inside_cells: Annotated[float, AllowInfNan(False)] = 0.0,
    cell_cm: Annotated[float | None, Gt(0), AllowInfNan(False)] = None,
) -> EllipseRectangle:
    """Return the rectangle an ellipse fitted to a rectangular outline stands for.

    Parameters
    ----------
    ellipse : Ellipse
        From `fit_ellipse_origin`.
    elements : Image, optional
        What was read, as it was read: not subdivided.
    inside_cm : float, optional
        How far inside the object's outline the fitted points lie, for the corrected sides;
        below 0 where they lie outside. Centres of boundary cells lie half a cell inside the cells'
        outline, and the cells' outline, where a covered fifth turns a cell on, as much as 0.3 cm
        (on the thesis' pad) outside the object's.
    inside_cells : float
        The same in elements' pitches, where ``inside_cm`` is not given.
    cell_cm : float, optional
        Pitch of the elements that were read, for `ambiguous` and ``inside_cells``; that of
        ``elements`` if not given, or 1.3, the thesis' pad's.

    Returns
    -------
    EllipseRectangle
        ``length_cm`` and ``breadth_cm`` are the full axes 2 a and 2 b (thesis 4.3.5 and 4.3.6).

    Raises
    ------
    Degenerate
        If the ellipse encloses nothing, or what the points lie inside leaves no side.

    Notes
    -----
    An ellipse nearest to the outline of a rectangle cuts its sides and passes inside its
    corners, so its axes are longer than the sides: by 13 to 15 % along (more where the rectangle is
    thinner than 1 : 10) and 15 to 24 % across. With the radial distance of appendix D and an
    evenly covered outline the ratios depend on the sides' ratio alone; they are tabulated
    and read by the axes' ratio. Flatter ellipses than b / a = 0.017 are treated as of that.
    """
    a, b = ellipse.semi_major_cm, ellipse.semi_minor_cm
    if not a > 0.0:
        raise Degenerate(f"half axes of {a:.3g} by {b:.3g} cm enclose nothing: no rectangle")
    ratio = b / a
    cell_cm = element_pitch_cm(elements, cell_cm)
    inside_cm = inside_cells * cell_cm if inside_cm is None else inside_cm
    length = 2.0 * a * float(np.interp(ratio, BIAS[:, 0], BIAS[:, 1])) + 2.0 * inside_cm
    breadth = 2.0 * b * float(np.interp(ratio, BIAS[:, 0], BIAS[:, 2])) + 2.0 * inside_cm
    if not min(length, breadth) > 0.0:
        raise Degenerate(
            f"sides of {length - 2.0 * inside_cm:.3g} by {breadth - 2.0 * inside_cm:.3g} cm leave "
            f"nothing {-2.0 * inside_cm:.3g} cm further in (told to lie {inside_cm:g} cm inside)"
        )
    quality = (ellipse.rms_cm, ellipse.n_points) if isinstance(ellipse, FittedEllipse) else (0.0, 0)
    return EllipseRectangle(
        ellipse.x_cm,
        ellipse.y_cm,
        2.0 * a,
        2.0 * b,
        ellipse.angle_rad,
        length,
        breadth,
        *quality,
        alike(length, breadth, cell_cm),
    )


rectangle_from_ellipse.usual_cm = {"cell_cm": THESIS_PITCH_CM}  # type: ignore[attr-defined]
