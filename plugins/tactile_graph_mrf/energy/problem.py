"""``Problem``: the energy of one image as tables, and `energy`, what a restoration costs."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from tactile_graph.wires import Image
from tactile_graph_mrf.energy.line_field import no_lines
from tactile_graph_mrf.energy.total import total

if TYPE_CHECKING:
    from tactile_graph_mrf.energy.model import Model


@dataclass(frozen=True, eq=False)
class Problem:
    """The energy of one image as tables; made by `Model.prepare`.

    A label k means the value ``low + step * k``. The cost of label x at cell s, all that depends
    on s alone, is ``curvature[s] (x - centre[s])² + table[row[s], x]``.

    Parameters
    ----------
    model : Model
    image : Image
        As observed.
    low, step : float
        Value of label 0 and of the distance of two labels; ``step`` is 0 for a constant image.
    observed : ndarray of float64, shape (rows, columns)
        In levels; 0 where there is no data.
    has_data, in_field : ndarray of bool, shape (rows, columns)
        Cells with a data term; cells that are sites. Cells that no data reaches are none.
    curvature, centre : ndarray of float64, shape (rows, columns)
        Quadratic part of a cell's own cost.
    table : ndarray of float64, shape (kinds, L)
        Further costs; row 0 holds zeros.
    row : ndarray of int64, shape (rows, columns)
        Row of ``table`` of each cell.
    smooth : ndarray of float64, shape (L,)
        lambda_d * rho of a difference; with ``marginal`` lines at most the price of a line.
    bare_smooth : ndarray of float64, shape (L,)
        The same without lines.
    offsets : ndarray of int64, shape (K, 2)
        (row, column) steps of the pair cliques.
    weights : ndarray of float64, shape (K,)
    pattern : ndarray of float64, shape (16,)
        lambda_l * V_l4 by pattern: bit 1 for the line up, 2 down, 4 left, 8 right.
    parallel, one : float
        lambda_l * V_l2 and lambda_l * V_l1.
    """

    model: Model
    image: Image
    low: float
    step: float
    observed: NDArray[np.float64]
    has_data: NDArray[np.bool_]
    in_field: NDArray[np.bool_]
    curvature: NDArray[np.float64]
    centre: NDArray[np.float64]
    table: NDArray[np.float64]
    row: NDArray[np.int64]
    smooth: NDArray[np.float64]
    bare_smooth: NDArray[np.float64]
    offsets: NDArray[np.int64]
    weights: NDArray[np.float64]
    pattern: NDArray[np.float64]
    parallel: float
    one: float

    @property
    def n_levels(self) -> int:
        """Size of the state space."""
        return self.model.n_levels

    @property
    def shape(self) -> tuple[int, int]:
        """Rows and columns."""
        return self.image.shape

    @property
    def idle(self) -> bool:
        """Whether there is nothing to restore: a constant image, or no cell in the field."""
        return self.step == 0.0 or not self.in_field.any()

    @property
    def gaussian(self) -> bool:
        """Whether every cell's conditional distribution is a discretised Gaussian."""
        model = self.model
        free = model.lines != "marginal" and model.smoothness == "quadratic"
        return model.noise == "gaussian" and (free or model.lambda_d == 0.0)

    @property
    def levels_per_draw(self) -> int:
        """How many levels a sampler looks at for one draw, about."""
        return 1 if self.gaussian else self.n_levels

    def unary(self) -> NDArray[np.float64]:
        """Return each cell's own cost of each label, shape (rows, columns, L); 0 off the field."""
        level = np.arange(self.n_levels, dtype=np.float64)
        square = (level - self.centre[..., None]) ** 2
        return np.asarray(self.curvature[..., None] * square + self.table[self.row])

    def start(self) -> NDArray[np.int64]:
        """Return the labels nearest to the observations; the mean where there are none."""
        labels = np.where(self.has_data, self.observed, 0.0)
        if not self.has_data.all() and self.has_data.any():
            labels = np.where(self.has_data, labels, self.observed[self.has_data].mean())
        return np.clip(np.rint(labels), 0, self.n_levels - 1).astype(np.int64)

    def sites(self) -> tuple[NDArray[np.bool_], NDArray[np.bool_]]:
        """Return where there are horizontal and vertical line sites: between cells in the field."""
        on = self.in_field
        return on[:-1] & on[1:], on[:, :-1] & on[:, 1:]

    def lines_of(self, labels: NDArray[np.int64]) -> tuple[NDArray[np.bool_], NDArray[np.bool_]]:
        """Return the lines that pay by themselves: a step costs more than a straight line."""
        across, down = self.sites()
        dearer = self.bare_smooth > self.model.line_price
        return (
            across & dearer[np.abs(np.diff(labels, axis=0))],
            down & dearer[np.abs(np.diff(labels, axis=1))],
        )

    def restored(self, labels: NDArray[np.int64] | NDArray[np.float64]) -> Image:
        """Return labels (whole or not) as an image; cells off the field stay as they were."""
        image = self.image
        known = np.isfinite(image.values) if image.valid is None else image.valid
        kept = np.where(known, image.values, 0.0)
        found = 2.0 * (0.5 * self.low + 0.5 * self.step * labels)  # halves do not overflow
        values = np.where(self.in_field, found, kept)
        return image.with_values(values, valid=self.in_field | known)


def energy(
    problem: Problem,
    labels: NDArray[np.int64],
    lines_h: NDArray[np.bool_] | None = None,
    lines_v: NDArray[np.bool_] | None = None,
) -> float:
    """Return the energy of a restoration, in squared levels: what every restorer is judged by.

    Parameters
    ----------
    problem : Problem
    labels : ndarray of int64, shape (rows, columns)
        0 to L - 1.
    lines_h, lines_v : ndarray of bool, optional
        Horizontal and vertical lines as in `LineField`; all off if not given. Lines without a
        site do not count; with ``marginal`` lines none do, for there they follow from the labels.

    Returns
    -------
    float
    """
    across, down = no_lines(problem.shape)
    if problem.model.lines != "marginal":
        sites_h, sites_v = problem.sites()
        across = across if lines_h is None else np.ascontiguousarray(lines_h & sites_h)
        down = down if lines_v is None else np.ascontiguousarray(lines_v & sites_v)
    return float(total.call(*terms(problem), np.ascontiguousarray(labels, np.int64), across, down))


def terms(problem: Problem) -> tuple[Any, ...]:
    """Return the arrays of a problem in the order in which the kernels take them."""
    p = problem
    return (
        *(p.in_field, p.curvature, p.centre, p.table, p.row),
        *(p.smooth, p.offsets, p.weights, p.pattern, p.parallel, p.one),
    )
