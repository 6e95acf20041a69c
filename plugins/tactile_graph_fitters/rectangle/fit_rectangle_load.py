"""``fit_rectangle_load``: the rectangle under which a footprint and its load are most likely."""

from __future__ import annotations

import math
from typing import Annotated

import numpy as np
from annotated_types import Gt, Lt
from numpy.typing import NDArray

from tactile_graph.compiled import compiled_later
from tactile_graph.errors import Degenerate
from tactile_graph.steps.rules import Grid, require_same_shape
from tactile_graph.wires import Image, Mask
from tactile_graph_fitters.orientation.orientation import (
    points_scatter,
    principal_variances,
    seen_angle,
)
from tactile_graph_fitters.orientation.oriented import Oriented
from tactile_graph_fitters.rectangle.fitted_rectangle import FittedRectangle, rectangle_of
from tactile_graph_fitters.rectangle.quasi_newton import minimise
from tactile_graph_fitters.rectangle.rectangle_likelihood import OFF, ON, UNKNOWN, Window
from tactile_graph_hull.parts import several_parts

AROUND = 2  # cells looked at around the footprint
SOFT_CELLS = 0.92  # over which a cell's coverage rises, as the outline passes it
TOLERANCE = 1e-3  # of the logarithm of the likelihood, at which the search ends
ROUNDS = 80
SLENDER = 0.7  # breadth over length from which on other angles are tried too

Values = NDArray[np.float64]
Share = Annotated[float, Gt(0), Lt(1)]


class FitRectangleLoad:
    """Return the rectangle under which a footprint and its load are most likely.

    Parameters
    ----------
    unevenness : float
        Standard deviation of the logarithm of the elements' gains.
    voids : float
        Share of covered elements that read nothing.
    strays : float
        Likelihood of a touched cell that the rectangle does not explain.
    shows_from : float
        Least load that shows, over that of a fully covered element: a cell counts as covered
        once so much of it is.
    load_power : float
        Power of the load that a reading goes with, where the image is not in grams; about 1.5
        for volts of the thesis' divider.

    Notes
    -----
    Minimises over position, angle and sides the negative logarithm of the likelihood of all cells
    (maximum likelihood): a cell covered by the share c reads c times a typical full load times a
    lognormal gain, or nothing, with the probability of a void; cells outside the image read
    nothing, since the whole object lies on the pad. The typical full load is the median of the
    footprint. Coverage is taken as the product of two ramps 0.92 cells wide across the sides,
    exact to a few hundredths along the sides, less so in corners. The search is by quasi-Newton
    steps with exact slopes from the rectangle with the footprint's moments; near-squares are
    tried at four angles.

    ``misfit`` is the cost per touched cell; it can be negative. Without ``image`` only which cells
    are touched counts (an area overlap); errors are then up to twice as large. Against
    least squares on boundary points (`fit_rectangle`) see ``benchmarks/rectangles.py``. Fits a
    rectangle directly, as thesis 4.3.1 and 6.1.3 leave to future work.
    """

    stateless = True
    notice = staticmethod(several_parts)

    def __init__(
        self,
        *,
        unevenness: Annotated[float, Gt(0)] = 0.5,
        voids: Share = 0.17,
        strays: Share = 1e-3,
        shows_from: Share = 0.16,
        load_power: Annotated[float, Gt(0)] = 1.0,
    ) -> None:
        self._law = (unevenness, voids, -math.log(shows_from), strays)
        self._power = load_power

    def __call__(
        self, mask: Mask, image: Annotated[Image | None, Grid.like("mask")] = None
    ) -> FittedRectangle:
        """Return the rectangle.

        Parameters
        ----------
        mask : Mask
            The footprint; what is not the object's own should have been removed.
        image : Image, optional
            Its readings; invalid cells say nothing either way.

        Raises
        ------
        RuleError
            If image and mask differ in shape.
        Degenerate
            If fewer than 3 cells are on, none of them has a valid reading or bears a load, all are
            in one line, or no minimum is found.
        """
        if image is not None:
            require_same_shape(image=image, mask=mask)
        window = _window(mask, image, self._power)
        (px, py), law = mask.pitch_cm, self._law
        cell = math.sqrt(px * py)
        full = np.array([*law, SOFT_CELLS * cell, 0.0 if image is None else 1.0])
        status, x, y, first, second, angle, found, rounds = likeliest(window, full, cell)
        n = len(window.cells_cm)
        if status:
            raise Degenerate(_why(n, status, rounds))
        sides = Oriented(x, y, 2.0 * first, 2.0 * second, angle)
        return rectangle_of(sides, found / n, n, rounds, cell)


def _window(mask: Mask, image: Image | None, power: float) -> Window:
    rows, columns = np.nonzero(mask.values)
    if len(rows) == 0:
        raise Degenerate("no cell is on: no rectangle fits")
    top, left = int(rows[0]) - AROUND, int(columns.min()) - AROUND
    height, width = int(rows[-1]) + AROUND + 1 - top, int(columns.max()) + AROUND + 1 - left
    (x, y), (px, py) = mask.origin_cm, mask.pitch_cm
    states = np.full((height, width), OFF, np.uint8)
    logs = np.zeros((height, width))
    at = rows - top, columns - left
    states[at] = ON
    if image is not None:
        readings = image.values[rows, columns]
        bears = readings > 0.0
        if image.valid is not None and not image.valid[rows, columns].any():
            raise Degenerate(
                f"none of {len(rows)} cells that are on has a valid reading: nothing to fit"
            )
        if not bears.any():
            raise Degenerate(f"none of {len(rows)} cells that are on bears a load: nothing to fit")
        found = np.log(readings[bears], dtype=np.float64)
        logs[at[0][bears], at[1][bears]] = (found - _median(found)) / power
        states[at[0][~bears], at[1][~bears]] = UNKNOWN
        if image.valid is not None:
            bad_rows, bad_columns = np.nonzero(~image.valid)
            bad = bad_rows - top, bad_columns - left
            near = (bad[0] >= 0) & (bad[0] < height) & (bad[1] >= 0) & (bad[1] < width)
            states[bad[0][near], bad[1][near]] = UNKNOWN
    xs: Values = x + (np.arange(left, left + width, dtype=np.float64) + 0.5) * px
    ys: Values = y + (np.arange(top, top + height, dtype=np.float64) + 0.5) * py
    cells = np.empty((len(rows), 2))
    cells[:, 0], cells[:, 1] = xs[at[1]], ys[at[0]]
    return Window(cells, logs, states, xs, ys)


def _median(values: Values) -> float:
    """Return the median; `numpy.median` takes five times as long on so few."""
    n = len(values)
    parts = np.sort(values)
    return float(0.5 * (parts[(n - 1) // 2] + parts[n // 2]))


def _why(n: int, status: int, rounds: int) -> str:
    cells = "1 cell" if n == 1 else f"{n} cells"
    if status == NOT_SETTLED:
        return f"{cells}: no rectangle found within {rounds} rounds"
    return f"{cells}: a rectangle needs at least 3 that are not in one line"


OK, ONE_LINE, NOT_SETTLED = range(3)

Found = tuple[int, float, float, float, float, float, float, int]


@compiled_later
def likeliest(window: Window, law: Values, cell: float) -> Found:
    """Return status, centre (x, y), half sides, angle of the first, cost and rounds."""
    n, x, y, xx, xy, yy = points_scatter(window.cells_cm)
    larger, smaller = principal_variances(xx / max(n, 1), xy / max(n, 1), yy / max(n, 1))
    if n < 3 or smaller <= 0.0:
        return ONE_LINE, x, y, 0.0, 0.0, 0.0, 0.0, 0
    angle = seen_angle(xx, xy, yy)
    half, other = math.sqrt(3.0 * larger), math.sqrt(3.0 * smaller)
    tries = 4 if other > SLENDER * half else 1
    best, p = np.empty(5), np.empty(5)
    least, rounds, settled = np.inf, 0, False
    for k in range(tries):
        p[0], p[1], p[2], p[3] = x, y, half + 0.2 * cell, other + 0.2 * cell
        p[4] = angle + k * math.pi / 8.0
        found, made = minimise(p, window, law, cell, TOLERANCE, ROUNDS)
        rounds += abs(made)
        if found < least:
            least, settled = found, made > 0
            best[:] = p
    status = OK if settled else NOT_SETTLED
    return status, best[0], best[1], best[2], best[3], best[4], least, rounds
