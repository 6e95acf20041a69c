"""The one model of chapter 5: what a restored image and its line field cost.

The a posteriori energy (Eq. 5.17 with 5.20 to 5.22) of labels x, 0 to L - 1 per cell, and lines l::

    U(x, l) = sum over cells of        data(x_s, observed_s)            Eq. 5.7, 5.17
            + lambda_prior * sum of    (x_s - expected_s)²              section 5.5.2, item 6
            + lambda_d * sum of pairs  w rho(x_i - x_j) (1 - line)      Eq. 5.20, 5.21
            + lambda_l * sum of        (V_l4 + V_l2 + V_l1)             Eq. 5.21, 5.22

and P(x, l) is in proportion to exp(-U / T) (Eq. 5.4). Everything is counted in squared levels.
Each clique counts once; Eq. 5.6 leaves open whether a pair is counted from both ends.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Annotated, Any, ClassVar, Literal

import numpy as np
from annotated_types import Ge, Gt, Le, Lt
from numpy.typing import NDArray

from tactile_graph.errors import DataError, Degenerate
from tactile_graph.wires import Image, Mask
from tactile_graph_mrf.energy.potentials import (
    Noise,
    Smoothness,
    data_costs,
    pattern_costs,
    smoothness_costs,
)
from tactile_graph_mrf.energy.problem import Problem, energy, terms

__all__ = ["OFFSETS", "Model", "Problem", "energy", "terms"]

Lambda = Annotated[float, Ge(0), Le(1e12)]
Cost = Annotated[float, Ge(-1e6), Le(1e6)]

OFFSETS = np.array([(0, 1), (1, 0), (1, 1), (1, -1), (0, 2), (2, 0)], np.int64)
"""One (row, column) step for each kind of pair clique; the first 2, 4 and 6 of them are those of
the neighbourhoods of order 1, 2 and 3 (Eq. 5.8, fig. 5.1)."""


@dataclass(frozen=True)
class Model:
    """All that the energy depends on, but for the image.

    Parameters
    ----------
    n_levels : int
        Size L of the state space (Eq. 5.2 ff.); the thesis settles on 200 (section 5.4.1).
    noise : str
        Kind of the data term, see `tactile_graph_mrf.energy.potentials.data_costs`. All but
        ``gaussian`` take the observations rounded to levels.
    sigma : float
        Standard deviation of the noise in levels; the Gaussian data term needs none.
    freedom : float
        Degrees of freedom of ``student_t``.
    outlier_share : float
        Share of cells that read anything, for ``outliers``.
    smoothness : str
        Cost of a difference within a clique; the thesis has ``quadratic`` (Eq. 5.6).
    truncation : float
        Levels beyond which the other kinds of smoothness grow less.
    order : int
        Neighbourhood order, 1 to 3 (fig. 5.1); the thesis uses 1.
    lambda_d : float
        Weight of the smoothness. Cliques are weighted 1 / distance² besides, which leaves the
        cost of a slope the same in each direction.
    lambda_l : float
        Weight of the line field, in squared levels: a straight line pays where a step exceeds
        sqrt(lambda_l (one + straight) / lambda_d) levels, 30 by default.
    lambda_prior : float
        Weight of the expected load, where one is given.
    lines : str
        ``none``; ``explicit``: lines are part of the state; ``marginal``: summed out, each for
        itself at the price of a straight one.
    end, straight, corner, tee, cross : float
        V_l4, for one, two, two, three and four lines that meet where four cells meet (fig. 5.6 c).
        The numbers of fig. 5.7 are lost. These are the ones ascribed to Geman and Geman (1984,
        section XIII, DOI 10.1109/TPAMI.1984.4767596), whose line cliques are the same six: no
        line 0, an end 2.7, a straight line 0.9, a turn 1.8, a T 1.8, a cross 2.7, all whole
        multiples of 0.9. The paper itself was not at hand and no second source with the
        numbers was found; they are settings for that reason too.
    parallel : float
        V_l2, for two lines side by side on two sides of one cell (fig. 5.6 e, f). Ours: as much
        as a corner, so that a wide slope is cut once.
    one : float
        V_l1, for a line by itself. Ours: lines at the rim of the pad meet in too few cliques
        of four, and would otherwise cost nothing on an image of one row.
    """

    n_levels: Annotated[int, Ge(2), Le(4096)] = 200
    noise: Noise = "gaussian"
    sigma: Annotated[float, Gt(0), Le(1e6)] = 10.0
    freedom: Annotated[float, Gt(0), Le(1e6)] = 4.0
    outlier_share: Annotated[float, Gt(0), Lt(1)] = 0.05
    smoothness: Smoothness = "quadratic"
    truncation: Annotated[float, Gt(0), Le(1e6)] = 30.0
    order: Literal[1, 2, 3] = 1
    lambda_d: Lambda = 4.0
    lambda_l: Lambda = 3000.0
    lambda_prior: Lambda = 0.0
    lines: Literal["none", "explicit", "marginal"] = "explicit"
    end: Cost = 2.7
    straight: Cost = 0.9
    corner: Cost = 1.8
    tee: Cost = 1.8
    cross: Cost = 2.7
    parallel: Cost = 1.8
    one: Cost = 0.3
    __pydantic_config__: ClassVar[Mapping[str, Any]] = {"extra": "forbid"}

    @property
    def line_price(self) -> float:
        """What a line costs within a long straight one, in squared levels (not below 0)."""
        return max(self.lambda_l * (self.one + self.straight), 0.0)

    def prepare(
        self, image: Image, region: Mask | None = None, expected: Image | None = None
    ) -> Problem:
        """Return the energy of this model for ``image`` as tables.

        Parameters
        ----------
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
        return _prepared(self, image, region, expected)


def _prepared(model: Model, image: Image, region: Mask | None, expected: Image | None) -> Problem:
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
    bare = model.lambda_d * smoothness_costs(model.smoothness, model.n_levels, model.truncation)
    marginal = model.lines == "marginal"
    patterns = (model.end, model.straight, model.corner, model.tee, model.cross)
    return Problem(
        model=model,
        image=image,
        low=low,
        step=step,
        observed=observed,
        has_data=has_data,
        in_field=np.ascontiguousarray(in_field),
        curvature=curvature,
        centre=centre,
        table=table,
        row=row,
        smooth=np.minimum(bare, model.line_price) if marginal else bare,
        bare_smooth=bare,
        offsets=offsets,
        weights=1.0 / (offsets**2).sum(axis=1),
        pattern=model.lambda_l * pattern_costs(*patterns),
        parallel=model.lambda_l * model.parallel,
        one=model.lambda_l * model.one,
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
