"""``Scene``: the evidence for outlines on a pad, and the posterior of each beside the others."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from functools import cache

import numpy as np

from tactile_graph_likelihood.geometry.even_points import even_points
from tactile_graph_likelihood.geometry.outlines import Values, unknowns
from tactile_graph_likelihood.several.joint_posterior import WIDTH, add_outline
from tactile_graph_likelihood.several.maximise_jointly import climbed_together, log_mass
from tactile_graph_likelihood.several.pieces import fitted
from tactile_graph_likelihood.several.sampling import sampled_beside
from tactile_graph_likelihood.single.element_terms import ON, States
from tactile_graph_likelihood.single.problem import Places
from tactile_graph_likelihood.single.readings import Readings
from tactile_graph_likelihood.single.start import LIGHT_EDGE

FEWEST_POINTS, UNSURE = 3.0, -3.0
"""Equal weights that an evidence needs, and what is added to Laplace's where there are fewer."""

BLOCK, POINTS, WORTH = 48, 192, 40.0
"""Points of a block, points at most, and equal weights enough, of a posterior beside others."""

TRIES = 16
"""Outlines tried around a piece's moments before the climb."""

ALIKE = 0.05
"""Outlines whose numbers differ by less share what sampling adds to Laplace's evidence."""

LOADS = 1.5
"""Standard deviation of the logarithm of an outline's load, about the touched elements' median."""


@dataclass(frozen=True)
class Found:
    """Outlines, and the log evidence around them; arrays as in `several_posterior`."""

    kinds: Places
    corners: Places
    points: Values
    log_evidence: float

    @property
    def count(self) -> int:
        """How many there are."""
        return len(self.kinds)

    @property
    def arrays(self) -> tuple[Places, Places, Values]:
        """Their kinds, corners and points."""
        return self.kinds, self.corners, self.points

    def only(self, k: int) -> Found:
        """Return one of them by itself."""
        at = slice(k, k + 1)
        return Found(self.kinds[at], self.corners[at], self.points[at], 0.0)


@dataclass(frozen=True, eq=False)
class Sampled:
    """Weighted points of an outline's posterior beside others."""

    points: Values
    weights: Values
    log_evidence: float
    equal_points: float
    over_laplace: float


@dataclass(frozen=True, eq=False)
class Beside:
    """What other outlines bring to each element, and the states left to explain."""

    load: Values
    share: Values
    states: States


class Scene:
    """One image, and what it says of any outlines on the pad.

    Parameters
    ----------
    readings : Readings
    noise : ndarray, shape (5,)
        As in `element_terms`.
    kinds : list of (int, int)
        Kinds of outlines and their corners, all alike likely beforehand.
    prior : ndarray, shape (9,)
        Of each outline, as in `outline_prior`.
    most : int
        Outlines at most.
    more : float
        Log odds of a number of outlines over one less, before anything is read.
    """

    def __init__(
        self,
        readings: Readings,
        noise: Values,
        kinds: list[tuple[int, int]],
        prior: Values,
        most: int,
        more: float = 3.0,
    ) -> None:
        self.grid, self.logs, self.states, _ = readings
        self.noise, self.kinds, self.most, self.more = noise, kinds, most, more
        middle = float(np.median(self.logs[self.states == ON])) + LIGHT_EDGE
        self.prior = np.append(prior, [middle, LOADS])
        self.on = self.states == ON
        self.bare = np.zeros(self.states.shape)
        self.nothing = Beside(self.bare, self.bare, self.states)
        self.table = _table(WIDTH)
        self.tries = 0
        self.corrections: dict[tuple[float, ...], float] = {}

    def add(self, found: Found, k: int, load: Values, share: Values) -> None:
        """Add what one of some outlines brings to the elements."""
        add_outline.call(
            int(found.kinds[k]), int(found.corners[k]), found.points[k], self.grid, self.noise,
            load, share,
        )  # fmt: skip

    def beside(self, found: Found, left_out: tuple[int, ...]) -> Beside:
        """Return what all but some outlines bring to the elements."""
        load, share = np.zeros(self.on.shape), np.zeros(self.on.shape)
        for k in range(found.count):
            if k not in left_out:
                self.add(found, k, load, share)
        return Beside(load, share, self.states)

    def weighed(
        self, kinds: Places, corners: Places, points: Values, beside: Beside | None = None
    ) -> Found:
        """Return outlines with their log evidence beside others; climbs no further."""
        count = len(kinds)
        at = beside or self.nothing
        mass = log_mass.call(
            kinds, corners, points, at.load, at.share, self.grid, self.logs, at.states,
            self.noise, self.prior, np.empty((count * WIDTH, count * WIDTH)),
        )  # fmt: skip
        mass += math.lgamma(count + 1.0) + count * (self.more - math.log(len(self.kinds)))
        return Found(kinds, corners, points, mass)

    def settled(self, found: Found, beside: Beside, most: int = 15, enough: float = 0.3) -> Found:
        """Return outlines brought to their joint top beside others, with their own evidence."""
        points = found.points.copy()
        climbed_together.call(
            found.kinds, found.corners, points, beside.load, beside.share, self.grid, self.logs,
            beside.states, self.noise, self.prior, most, enough,
        )  # fmt: skip
        return self.weighed(found.kinds, found.corners, points, beside)

    def climbed(self, found: Found, enough: float = 0.1) -> Found:
        """Return all outlines brought to their joint top."""
        return self.settled(found, self.nothing, 15, enough)

    def one(
        self, kind: int, corners: int, piece: States, load: Values, share: Values, states: States
    ) -> Found:
        """Return one kind of outline fitted to a piece beside others, with its own evidence."""
        self.tries += 1
        p, top = fitted.call(
            kind, corners, self.grid, self.logs, piece, load, share, states, self.noise,
            self.prior, self.table, TRIES,
        )  # fmt: skip
        kinds, sides = np.array([kind]), np.array([corners])
        if top == -math.inf:
            return Found(kinds, sides, p[None], top)
        mass = log_mass.call(
            kinds, sides, p[None], load, share, self.grid, self.logs, states, self.noise,
            self.prior, np.empty((WIDTH, WIDTH)),
        )  # fmt: skip
        return Found(kinds, sides, p[None], mass + self.more - math.log(len(self.kinds)))

    def sampled(self, found: Found, k: int) -> Sampled:
        """Return the posterior of one outline beside the others, and its evidence."""
        beside = self.beside(found, (k,))
        kinds, corners = found.kinds[k : k + 1], found.corners[k : k + 1]
        matrix = np.empty((WIDTH, WIDTH))
        mass = log_mass.call(
            kinds, corners, found.points[k : k + 1], beside.load, beside.share, self.grid,
            self.logs, self.states, self.noise, self.prior, matrix,
        )  # fmt: skip
        n = unknowns.call(int(kinds[0]), int(corners[0])) + 1
        covariance = np.linalg.inv(matrix[:n, :n])
        table = _table(n)
        points, weights = np.empty((len(table), n)), np.empty(len(table))
        used, evidence, equal, _ = sampled_beside.call(
            kinds, corners, found.points[k, :n].copy(), covariance, beside.load, beside.share,
            self.grid, self.logs, self.states, self.noise, self.prior, table, BLOCK, WORTH,
            points, weights,
        )  # fmt: skip
        over = evidence - mass if equal >= FEWEST_POINTS else UNSURE
        return Sampled(points[:used], weights[:used], evidence, equal, over)

    def corrected(self, found: Found) -> Found:
        """Return outlines with their evidence by sampling each beside the others."""
        total = found.log_evidence
        for k in range(found.count):
            key = (int(found.kinds[k]), *np.rint(found.points[k] / ALIKE).tolist())
            if key not in self.corrections:
                self.corrections[key] = self.sampled(found, k).over_laplace
            total += self.corrections[key]
        return replace(found, log_evidence=total)


@cache
def _table(n: int) -> Values:
    table = even_points(POINTS, n, 0)
    table.setflags(write=False)
    return table


def joined(parts: list[Found]) -> Found:
    """Return the outlines of several lists in one, with no evidence yet."""
    return Found(
        np.concatenate([p.kinds for p in parts]),
        np.concatenate([p.corners for p in parts]),
        np.concatenate([p.points for p in parts]),
        0.0,
    )
