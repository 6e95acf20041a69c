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

from annotated_types import Ge, Gt, Le, Lt

from tactile_graph_mrf.energy.potentials import Noise, Smoothness

Lambda = Annotated[float, Ge(0), Le(1e12)]
Cost = Annotated[float, Ge(-1e6), Le(1e6)]


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
