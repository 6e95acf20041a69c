"""``Scene``: the evidence for outlines on a part of a pad, and the posterior of each."""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cache

import numpy as np

from tactile_graph_likelihood.geometry.outline_prior import HEIGHT, LARGEST, LEFT, SMALLEST, TOP
from tactile_graph_likelihood.geometry.outline_prior import WIDTH as ACROSS
from tactile_graph_likelihood.geometry.outlines import Values, sizes, unknowns
from tactile_graph_likelihood.several.joint.joint_posterior import (
    WIDTH,
    JointProblem,
    Outlines,
    add_outlines,
    apart,
)
from tactile_graph_likelihood.several.joint.kinds import ENOUGH, allowed, area
from tactile_graph_likelihood.several.joint.maximise_jointly import settle
from tactile_graph_likelihood.several.joint.sample_beside import sample_beside
from tactile_graph_likelihood.single.density.element_terms import ON
from tactile_graph_likelihood.single.density.problem import Places
from tactile_graph_likelihood.single.sampling.even_points import even_points
from tactile_graph_likelihood.single.sampling.sample import Plan

BLOCK, POINTS, WORTH = 32, 128, 24.0
"""Points of a block, points at most, and equal weights enough, of a posterior beside others."""

FEWEST_POINTS = 3.0
"""Equal weights that say more than the information at the mode."""


@dataclass(frozen=True, eq=False)
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

    def without(self, *left_out: int) -> Configuration:
        """Return them but for some."""
        keep = [k for k in range(self.count) if k not in left_out]
        return Configuration(self.kinds[keep], self.corners[keep], self.points[keep], 0.0)

    def with_one(self, k: int, other: Configuration) -> Configuration:
        """Return them with another outline in the place of one."""
        kinds, corners, points = self.kinds.copy(), self.corners.copy(), self.points.copy()
        kinds[k], corners[k], points[k] = other.kinds[0], other.corners[0], other.points[0]
        return Configuration(kinds, corners, points, 0.0)


@dataclass(frozen=True, eq=False)
class Sampled:
    """Weighted points of an outline's posterior beside others."""

    points: Values
    weights: Values
    log_evidence: float
    equal_points: float


class Scene:
    """A part of a pad, and what it says of the outlines there.

    Parameters
    ----------
    problem : JointProblem
        Nothing lies there yet.
    kinds : list of (int, int)
        Kinds of outlines and their corners, all alike likely beforehand.
    more : float
        Log odds of a number of outlines over one less, before anything is read.
    shared : float
        How many times less evidence is worth than were elements independent.
    """

    def __init__(
        self, problem: JointProblem, kinds: list[tuple[int, int]], more: float, shared: float
    ) -> None:
        self.problem, self.kinds, self.more, self.shared = problem, kinds, more, shared
        self.on, self.may_be = problem.states == ON, allowed(tuple(kinds))
        self.before = more - math.log(len(kinds))
        """What an outline adds to the log probability before anything is read."""

    def beside(
        self, found: Configuration, *left_out: int, before: JointProblem | None = None
    ) -> JointProblem:
        """Return the problem beside all outlines, but for some, and beside what already lies."""
        return laid(before or self.problem, found.without(*left_out))

    def settled(
        self,
        found: Configuration,
        beside: JointProblem | None = None,
        most: int = 15,
        soft: int = 0,
    ) -> tuple[Configuration, Values]:
        """Return outlines brought to their joint mode beside others, and the information there.

        At first the problem is softened for ``soft`` rounds, if any.
        """
        points = found.points.copy()
        matrix = np.empty((found.count * WIDTH, found.count * WIDTH))
        outlines = Outlines(found.kinds, found.corners, points)
        log = settle.call(beside or self.problem, outlines, soft, most, ENOUGH, matrix)
        return Configuration(found.kinds, found.corners, points, log), matrix

    def worth(self, found: Configuration) -> float:
        """Return what outlines add to the log probability of a scene."""
        return found.log_evidence / self.shared + found.count * self.before

    def sampled(self, found: Configuration, k: int) -> Sampled:
        """Return the posterior of one outline beside the others, and its evidence.

        Where hardly any point is possible, it is that of the information at the mode, within what
        is possible of each number.
        """
        beside, outline = self.beside(found, k), found.only(k).outlines
        matrix = np.empty((WIDTH, WIDTH))
        at_mode = settle.call(beside, outline, 0, 0, 0.0, matrix)
        n = unknowns.call(int(found.kinds[k]), int(found.corners[k])) + 1
        plan = Plan(_table(n), BLOCK, WORTH)
        points, weights = np.empty((POINTS, n)), np.empty(POINTS)
        covariance = np.linalg.inv(matrix[:n, :n])
        used, evidence, equal = sample_beside.call(
            beside, outline, covariance, plan, points, weights
        )
        if equal < FEWEST_POINTS:
            root = np.linalg.cholesky(covariance)
            around = found.points[k, :n] + plan.table[:BLOCK] @ root.T
            low, high = self._bounds(int(found.kinds[k]), n)
            evidence = at_mode if evidence == -math.inf else evidence
            weights = np.full(BLOCK, 1.0 / BLOCK)
            return Sampled(np.clip(around, low, high), weights, evidence, float(BLOCK))
        return Sampled(points[:used], weights[:used], evidence, equal)

    def _bounds(self, kind: int, n: int) -> tuple[Values, Values]:
        """Return the least and the most that an outline's numbers may be."""
        prior, low, high = self.problem.prior, np.full(n, -np.inf), np.full(n, np.inf)
        low[:2] = prior[[LEFT, TOP]]
        high[:2] = low[:2] + prior[[ACROSS, HEIGHT]]
        its = slice(2, 2 + sizes.call(kind))
        low[its], high[its] = prior[SMALLEST], prior[LARGEST]
        return low, high


def area_of(found: Configuration, k: int = 0) -> float:
    """Return the area of one outline, in cm2."""
    return area.call(int(found.kinds[k]), int(found.corners[k]), found.points[k])


@cache
def _table(n: int) -> Values:
    table = even_points(POINTS, n, 0)
    table.setflags(write=False)
    return table


def joined(parts: list[Configuration], log_evidence: float = 0.0) -> Configuration:
    """Return the outlines of several lists in one."""
    return Configuration(
        np.concatenate([p.kinds for p in parts]),
        np.concatenate([p.corners for p in parts]),
        np.concatenate([p.points for p in parts]),
        log_evidence,
    )


def laid(problem: JointProblem, found: Configuration) -> JointProblem:
    """Return a problem beside outlines."""
    its = apart(problem)
    add_outlines.call(its, found.outlines)
    return its
