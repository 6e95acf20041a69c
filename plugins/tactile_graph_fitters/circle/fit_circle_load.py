"""``fit_circle_load``: the disc that would bear an image's load if it bore it evenly."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Annotated, Any, ClassVar

import numpy as np
from annotated_types import Ge

from tactile_graph.errors import DataError, Degenerate, RuleError
from tactile_graph.steps.rules import Grid, Quantity, require_square
from tactile_graph.wires import Circle, Image
from tactile_graph_fitters.circle.even_load import (
    MOST_ROUNDS,
    OK,
    TOO_FEW,
    UNDETERMINED,
    Readings,
    even_disc,
)


@dataclass(frozen=True)
class EvenCircle(Circle):
    """A disc under even load, and how far the image is from that.

    Parameters
    ----------
    x_cm, y_cm, radius_cm : float
    uneven : float
        Root mean square of the elements' loads off the disc's, each over what it should bear: a
        few hundredths where only the readings scatter.
    centre_std_cm, radius_std_cm : float
        Standard deviations of centre and radius, by that scatter and by what the elements tell.
    full_load : float
        Load of a fully covered element, in the image's unit.
    n_cells : int
        Elements that entered.
    iterations : int
    """

    uneven: float
    centre_std_cm: float
    radius_std_cm: float
    full_load: float
    n_cells: int
    iterations: int
    columns_shown: ClassVar[tuple[str, ...]] = (*Circle.columns_shown, "uneven", "centre_std_cm")


class FitCircleLoad:
    """Return the disc that would bear an image's load if it bore it evenly.

    Parameters
    ----------
    pad : str or mapping
        Name of a pad, its YAML file, or the pad itself: gap and least load that shows come from
        it, unless given here.
    gap_cm : float, optional
        Distance of neighbouring elements' edges.
    shows_from : float, optional
        Readings below it count as nothing, in the image's unit.

    Notes
    -----
    Least squares of the loads over x, y, radius and the load of a fully covered element, by damped
    Gauss-Newton steps from the disc with the load's moments; an element bears the exact share of
    it that the disc covers. Residuals are weighed by what the element should bear, since readings
    scatter in proportion, down to 0.3 of a full load. Elements that read nothing count only if
    the disc would make them read something.

    Cheap, and good where load is even: then partly covered elements tell the outline to a
    hundredth of an element. On an uneven pad it is no good, and ``uneven`` says so; the likelihood
    (`footprint_disc`) is made for those.
    """

    stateless = True

    def __init__(
        self,
        *,
        pad: str | dict[str, Any] = "thesis",
        gap_cm: Annotated[float, Ge(0)] | None = None,
        shows_from: Annotated[float, Ge(0)] | None = None,
    ) -> None:
        from tactile_graph_pads.pad import load_pad

        known = load_pad(pad)
        self._gap_cm = float(known.geometry.gap_cm if gap_cm is None else gap_cm)
        self._least = float(0.5 * known.law.turn_on_g if shows_from is None else shows_from)

    def __call__(
        self,
        image: Annotated[
            Image, Quantity("gram", "kilopascal", "raw", "counts", "level"), Grid(square_to=0.0)
        ],
    ) -> EvenCircle:
        """Return the disc.

        Parameters
        ----------
        image : Image
            Loads; invalid cells say nothing.

        Raises
        ------
        RuleError
            If the cells are not square, or the gap leaves no element.
        DataError
            If a valid cell is not finite.
        Degenerate
            If fewer than 4 elements bear a load, these leave the disc open, or a load is too large
            to be summed.
        """
        require_square(image)
        (across, _), (x, y) = image.pitch_cm, image.origin_cm
        if not self._gap_cm < across:
            raise RuleError(
                f"gap_cm: must be below the pitch of {across:g} cm, got {self._gap_cm:g}"
            )
        loads = np.array(image.values, np.float64)
        usable = np.ones(loads.shape, np.bool_) if image.valid is None else image.valid.copy()
        loads[~usable] = 0.0
        if not np.isfinite(loads).all():
            raise DataError("image", "a valid cell holds NaN or infinity")
        if loads.size and loads.max() > np.finfo(np.float64).max / loads.size**2:
            raise Degenerate(f"loads of up to {loads.max():.3g} are too large for their moments")
        loads[loads < self._least] = 0.0
        half = 0.5 * self._gap_cm
        grid = np.array([x + half, y + half, across, across - self._gap_cm])
        status, *measures, n, rounds = even_disc.call(Readings(loads, usable, grid, self._least))
        if status != OK:
            raise Degenerate(_why(status, n))
        x, y, radius, full, uneven, centre_std, radius_std = map(float, measures)
        return EvenCircle(x, y, radius, uneven, centre_std, radius_std, full, n, rounds)


def _why(status: int, n: int) -> str:
    cells = "1 element bears" if n == 1 else f"{n} elements bear"
    if status == TOO_FEW:
        return f"{cells} a load: a disc needs at least 4"
    if status == UNDETERMINED:
        return f"{cells} a load, which leaves the disc open"
    return f"no even disc found within {MOST_ROUNDS} rounds"
