"""``Problem``: the energy of one image as tables; `prepare` makes it of image and model."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from tactile_graph.errors import DataError, Degenerate
from tactile_graph.wires import Image, Mask
from tactile_graph_mrf.energy.model import Model
from tactile_graph_mrf.energy.potentials import (
    OFFSETS,
    LineCliques,
    Pairwise,
    Potentials,
    Unary,
    data_costs,
    pattern_costs,
    smoothness_costs,
)


@dataclass(frozen=True, eq=False)
class Problem:
    """The energy of one image as tables; made by `prepare`.

    A label k means the value ``low + step * k``.

    Parameters
    ----------
    model : Model
    image : Image
        As observed.
    low, step : float
        Value of label 0 and of the distance of two labels; ``step`` is 0 for a constant image.
    observed : ndarray of float64, shape (rows, columns)
        In levels; 0 where there is no data.
    has_data : ndarray of bool, shape (rows, columns)
        Cells with a data term.
    unary : Unary
        Its ``in_field`` tells the cells that are sites. Cells that no data reaches are none.
    pairwise : Pairwise
    line_cliques : LineCliques
    """

    model: Model
    image: Image
    low: float
    step: float
    observed: NDArray[np.float64]
    has_data: NDArray[np.bool_]
    unary: Unary
    pairwise: Pairwise
    line_cliques: LineCliques

    @cached_property
    def potentials(self) -> Potentials:
        """All of its potentials, as the kernels take them."""
        return Potentials(self.unary, self.pairwise, self.line_cliques)

    @property
    def in_field(self) -> NDArray[np.bool_]:
        """Cells that are sites."""
        return self.unary.in_field

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

    def own_costs(self) -> NDArray[np.float64]:
        """Return each cell's own cost of each label, shape (rows, columns, L); 0 off the field."""
        own = self.unary
        level = np.arange(self.n_levels, dtype=np.float64)
        square = (level - own.centre[..., None]) ** 2
        return np.asarray(own.curvature[..., None] * square + own.table[own.row])

    def start(self) -> NDArray[np.int64]:
        """Return the labels nearest to the observations; the mean where there are none."""
        labels = np.where(self.has_data, self.observed, 0.0)
        if not self.has_data.all() and self.has_data.any():
            labels = np.where(self.has_data, labels, self.observed[self.has_data].mean())
        return np.clip(np.rint(labels), 0, self.n_levels - 1).astype(np.int64)

    @cached_property
    def sites(self) -> tuple[NDArray[np.bool_], NDArray[np.bool_]]:
        """Where there are horizontal and vertical line sites: between cells in the field."""
        on = self.in_field
        return on[:-1] & on[1:], on[:, :-1] & on[:, 1:]

    def lines_of(self, labels: NDArray[np.int64]) -> tuple[NDArray[np.bool_], NDArray[np.bool_]]:
        """Return the lines that pay by themselves: a step costs more than a straight line."""
        across, down = self.sites
        dearer = self.pairwise.bare > self.model.line_price
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


def prepare(
    model: Model, image: Image, region: Mask | None = None, expected: Image | None = None
) -> Problem:
    """Return the energy of a model for an image as tables.

    Parameters
    ----------
    model : Model
    image : Image
        Invalid cells, and those without a finite value, have no data term.
    region : Mask, optional
        Only its cells are in the field; the others are as if off the pad.
    expected : Image, optional
        Expected load, in the unit of ``image``; enters with ``lambda_prior``.

    Returns
    -------
    Problem

    Raises
    ------
    DataError
        If region or expected load have another shape than the image.
    Degenerate
        If no cell of a region that is not empty holds a value.
    """
    for name, other in (("region", region), ("expected", expected)):
        if other is not None and other.shape != image.shape:
            raise DataError(
                name,
                f"must have the image's shape {image.shape}, got {other.shape}",
            )
    offsets = np.ascontiguousarray(OFFSETS[: 2 * model.order])
    in_field = np.ones(image.shape, np.bool_) if region is None else region.values
    finite = np.isfinite(image.values)
    has_data = in_field & (finite if image.valid is None else finite & image.valid)
    seen = np.where(has_data, image.values, 0.0).astype(np.float64)
    low, step = _scale(seen, has_data, in_field, model.n_levels)
    if not has_data.all():
        in_field = _reached(has_data, in_field, offsets if model.lambda_d > 0 else offsets[:0])
    # In halves: from end to end of the numbers there are, a difference is none.
    above = (0.5 * seen - 0.5 * low) / (0.5 * step) if step else 0.0
    observed = np.where(has_data, above, 0.0)
    gaussian = model.noise == "gaussian"
    curvature = (has_data & gaussian).astype(np.float64)
    centre = observed
    if expected is not None and model.lambda_prior > 0 and step:
        load = (expected.filled(np.nan) - low) / step
        curvature, centre = _with_prior(curvature, observed, in_field, load, model.lambda_prior)
    table, row = np.zeros((1, model.n_levels)), np.zeros(image.shape, np.int64)
    if not gaussian and step:
        table, row = _table(model, np.rint(observed), has_data, -low / step)
    unary = Unary(np.array(in_field, order="C"), curvature, centre, table, row)
    return Problem(
        model, image, low, step, observed, has_data, unary, _pairwise(model, offsets), _lines(model)
    )


def _pairwise(model: Model, offsets: NDArray[np.int64]) -> Pairwise:
    bare = model.lambda_d * smoothness_costs(model.smoothness, model.n_levels, model.truncation)
    weights = 1.0 / (offsets**2).sum(axis=1)
    if model.lines != "marginal":
        return Pairwise(bare, bare, -1.0, offsets, weights)
    price = float(model.line_price)
    return Pairwise(np.minimum(bare, price), bare, price, offsets, weights)


def _lines(model: Model) -> LineCliques:
    patterns = (model.end, model.straight, model.corner, model.tee, model.cross)
    scale = model.lambda_l
    return LineCliques(
        scale * pattern_costs(*patterns), float(scale * model.parallel), float(scale * model.one)
    )


def _scale(
    seen: NDArray[np.float64],
    has_data: NDArray[np.bool_],
    in_field: NDArray[np.bool_],
    n_levels: int,
) -> tuple[float, float]:
    if not has_data.any():
        if in_field.any():
            raise Degenerate("no cell of the image holds a value, so there is nothing to restore")
        return 0.0, 0.0
    values = seen[has_data]
    low, high = float(values.min()), float(values.max())
    # Halves first: the range of numbers near the largest float overflows.
    step = (high / (n_levels - 1)) - (low / (n_levels - 1))
    span = high / 2 - low / 2
    # A span of a few last bits has no levels between its ends: all of it is rounding.
    flat = span <= 4 * np.finfo(np.float64).eps * max(abs(low), abs(high)) or step < 1e-290
    return low, 0.0 if flat else step


def _reached(
    has_data: NDArray[np.bool_], in_field: NDArray[np.bool_], offsets: NDArray[np.int64]
) -> NDArray[np.bool_]:
    """Return the cells of the field that some clique, or a chain of them, ties to data."""
    reached = has_data
    rows, columns = reached.shape
    while True:
        padded = np.pad(reached, 2)
        grown = reached.copy()
        for di, dj in [*offsets, *-offsets]:
            grown |= padded[2 + di : 2 + di + rows, 2 + dj : 2 + dj + columns]
        grown &= in_field
        if np.array_equal(grown, reached):
            return grown
        reached = grown


def _with_prior(
    curvature: NDArray[np.float64],
    observed: NDArray[np.float64],
    in_field: NDArray[np.bool_],
    expected: NDArray[np.float64],
    weight: float,
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Return data and prior as one parabola; they differ from it by a constant only."""
    weights = np.where(in_field & np.isfinite(expected), weight, 0.0)
    both = curvature + weights
    pull = curvature * observed + weights * np.where(weights > 0, expected, 0.0)
    return both, np.divide(pull, both, out=np.zeros_like(both), where=both > 0)


def _table(
    model: Model, observed: NDArray[np.float64], has_data: NDArray[np.bool_], zero_level: float
) -> tuple[NDArray[np.float64], NDArray[np.int64]]:
    kinds, index = np.unique(observed[has_data], return_inverse=True)
    costs = data_costs(
        model.noise,
        kinds,
        model.n_levels,
        sigma=model.sigma,
        freedom=model.freedom,
        outlier_share=model.outlier_share,
        zero_level=zero_level,
    )
    row = np.zeros(observed.shape, np.int64)
    row[has_data] = index.reshape(-1) + 1
    return np.concatenate([np.zeros((1, model.n_levels)), costs]), row
