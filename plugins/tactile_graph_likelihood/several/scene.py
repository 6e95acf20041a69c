"""``Scene``: the evidence for outlines on a pad, and the posterior of each beside the others."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from functools import cache

import numpy as np

from tactile_graph_likelihood.geometry.outlines import Values, unknowns
from tactile_graph_likelihood.several.joint_posterior import (
    WIDTH,
    JointProblem,
    Outlines,
    add_outline,
)
from tactile_graph_likelihood.several.maximise_jointly import fit_piece, settle
from tactile_graph_likelihood.several.sample_beside import sample_beside
from tactile_graph_likelihood.single.element_terms import ON, States
from tactile_graph_likelihood.single.even_points import even_points
from tactile_graph_likelihood.single.problem import Places
from tactile_graph_likelihood.single.readings import Readings
from tactile_graph_likelihood.single.sample import Plan
from tactile_graph_likelihood.single.search import LIGHT_EDGE

FEWEST_POINTS, UNSURE = 3.0, -3.0
"""Equal weights that an evidence needs, and what is added to Laplace's where there are fewer."""

BLOCK, POINTS, WORTH = 48, 192, 40.0
"""Points of a block, points at most, and equal weights enough, of a posterior beside others."""

TRIES = 16
"""Outlines tried around a piece's moments before the search."""

ALIKE = 0.05
"""Outlines whose numbers differ by less share what sampling adds to Laplace's evidence."""

LOADS = 1.5
"""Standard deviation of the logarithm of an outline's load, about the touched elements' median."""


@dataclass(frozen=True)
class Configuration:
    """Outlines on a pad, and the log evidence around them; arrays as in `Outlines`."""

    kinds: Places
    corners: Places
    points: Values
    log_evidence: float

    @property
    def count(self) -> int:
        """How many there are."""
        return len(self.kinds)

    @property
    def outlines(self) -> Outlines:
        """Them as the kernels take them."""
        return Outlines(self.kinds, self.corners, self.points)

    def only(self, k: int) -> Configuration:
        """Return one of them by itself."""
        at = slice(k, k + 1)
        return Configuration(self.kinds[at], self.corners[at], self.points[at], 0.0)


@dataclass(frozen=True, eq=False)
class Sampled:
    """Weighted points of an outline's posterior beside others."""

    points: Values
    weights: Values
    log_evidence: float
    equal_points: float
    over_laplace: float


class Scene:
    """One image, and what it says of any outlines on the pad.

    Parameters
    ----------
    readings : Readings
    noise : ndarray, shape (9,)
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
        self.kinds, self.most, self.more = kinds, most, more
        self.on = readings.states == ON
        middle = float(np.median(readings.logs[self.on])) + LIGHT_EDGE
        bare = np.zeros(self.on.shape)
        self.problem = JointProblem(
            *readings[:3], noise, np.append(prior, [middle, LOADS]), bare, bare
        )
        self.table = _table(WIDTH)
        self.tries = 0
        self.corrections: dict[tuple[float, ...], float] = {}

    def beside(
        self, found: Configuration, left_out: tuple[int, ...], others: JointProblem | None = None
    ) -> JointProblem:
        """Return the problem beside all but some outlines, and beside what others bring."""
        before = others or self.problem
        problem = before._replace(load=before.load.copy(), share=before.share.copy())
        for k in range(found.count):
            if k not in left_out:
                add_outline.call(problem, found.outlines, k)
        return problem

    def weighed(self, outlines: Outlines, beside: JointProblem | None = None) -> Configuration:
        """Return outlines with their log evidence beside others, where they are."""
        return self._evident(outlines, beside or self.problem, 0, 0.0)

    def _evident(
        self, outlines: Outlines, beside: JointProblem, most: int, enough: float
    ) -> Configuration:
        count = len(outlines.kinds)
        matrix = np.empty((count * WIDTH, count * WIDTH))
        log = settle.call(beside, outlines, most, enough, matrix)
        log += math.lgamma(count + 1.0) + count * (self.more - math.log(len(self.kinds)))
        return Configuration(*outlines, log)

    def settled(
        self, found: Configuration, beside: JointProblem, most: int = 15, enough: float = 0.3
    ) -> Configuration:
        """Return outlines brought to their joint mode beside others, with their own evidence."""
        outlines = found.outlines._replace(points=found.points.copy())
        return self._evident(outlines, beside, most, enough)

    def maximised(self, found: Configuration, enough: float = 0.1) -> Configuration:
        """Return all outlines brought to their joint mode."""
        return self.settled(found, self.problem, 15, enough)

    def one(self, kind: int, corners: int, piece: States, beside: JointProblem) -> Configuration:
        """Return one kind of outline fitted to a piece beside others, with its own evidence."""
        self.tries += 1
        p, top = fit_piece.call(beside, kind, corners, piece, self.table, TRIES)
        outline = Outlines(np.array([kind]), np.array([corners]), p[None])
        if top == -math.inf:
            return Configuration(*outline, top)
        log = settle.call(beside, outline, 0, 0.0, np.empty((WIDTH, WIDTH)))
        return Configuration(*outline, log + self.more - math.log(len(self.kinds)))

    def sampled(self, found: Configuration, k: int) -> Sampled:
        """Return the posterior of one outline beside the others, and its evidence."""
        beside, outline = self.beside(found, (k,)), found.only(k).outlines
        matrix = np.empty((WIDTH, WIDTH))
        log = settle.call(beside, outline, 0, 0.0, matrix)
        n = unknowns.call(int(found.kinds[k]), int(found.corners[k])) + 1
        plan = Plan(_table(n), BLOCK, WORTH)
        points, weights = np.empty((POINTS, n)), np.empty(POINTS)
        used, evidence, equal = sample_beside.call(
            beside, outline, np.linalg.inv(matrix[:n, :n]), plan, points, weights
        )
        over = evidence - log if equal >= FEWEST_POINTS else UNSURE
        return Sampled(points[:used], weights[:used], evidence, equal, over)

    def corrected(self, found: Configuration) -> Configuration:
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


def joined(parts: list[Configuration]) -> Configuration:
    """Return the outlines of several lists in one, with no evidence yet."""
    return Configuration(
        np.concatenate([p.kinds for p in parts]),
        np.concatenate([p.corners for p in parts]),
        np.concatenate([p.points for p in parts]),
        0.0,
    )
