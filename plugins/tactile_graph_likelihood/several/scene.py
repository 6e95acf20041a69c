"""``Scene``: the evidence for outlines on a part of a pad, and the posterior of each."""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cache, cached_property

import numpy as np

from tactile_graph_likelihood.geometry.outlines import (
    DISC,
    ELLIPSE,
    RECTANGLE,
    REGULAR,
    Values,
    unknowns,
)
from tactile_graph_likelihood.several.joint_posterior import (
    WIDTH,
    JointProblem,
    Outlines,
    add_outlines,
)
from tactile_graph_likelihood.several.maximise_jointly import likeliest_of, settle
from tactile_graph_likelihood.several.sample_beside import sample_beside
from tactile_graph_likelihood.single.element_terms import ON
from tactile_graph_likelihood.single.even_points import even_points
from tactile_graph_likelihood.single.problem import Places
from tactile_graph_likelihood.single.sample import Plan

BLOCK, POINTS, WORTH = 32, 128, 24.0
"""Points of a block, points at most, and equal weights enough, of a posterior beside others."""

FEWEST_POINTS = 3.0
"""Equal weights that say more than the information at the mode."""

ROUNDS = 8
"""Rounds in which an outline of another kind is brought to its mode."""

AROUND = np.array([0.25, 0.25, 0.2, 0.2, 0.15, 0.0])
"""How far other starts lie off: lengths in cm, an angle in radians."""

TURNS = 4
"""Angles at which a regular polygon is begun with."""

ROUND = math.sqrt(4.0 / 3.0)
"""Half an ellipse's axis over the half side of the rectangle of the same moments."""


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

    @cached_property
    def log_sizes_and_loads(self) -> tuple[Values, Values]:
        """Logarithms of the roots of areas, and of loads."""
        sizes = [0.5 * math.log(area_of(self, k)) for k in range(self.count)]
        at = [unknowns.call(int(k), int(n)) for k, n in zip(self.kinds, self.corners, strict=True)]
        return np.array(sizes), self.points[np.arange(self.count), at]

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
        self.on = problem.states == ON

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
        """Return outlines brought to their joint mode beside others, and the information there."""
        points = found.points.copy()
        matrix = np.empty((found.count * WIDTH, found.count * WIDTH))
        outlines = Outlines(found.kinds, found.corners, points)
        log = settle.call(beside or self.problem, outlines, soft, most, 0.1, matrix)
        return Configuration(found.kinds, found.corners, points, log), matrix

    def as_kind(
        self,
        kind: tuple[int, int],
        own: Configuration,
        beside: JointProblem,
        soft: int = 0,
        tries: int = 0,
    ) -> Configuration:
        """Return the outline of a kind near another one, beside others, with its own evidence.

        It begins with the likeliest of some ``tries`` around it.
        """
        n = unknowns.call(*kind) + 1
        starts = like(kind, own)
        if tries:
            around = np.zeros((tries, WIDTH))
            around[:, :n] = AROUND[:n] * _table(n)[:tries]
            starts += [start + off for start in starts[:1] for off in around]
        first = 0
        if len(starts) > 1:
            first = likeliest_of.call(beside, *kind, np.array(starts))
        kinds, corners = np.array([kind[0]]), np.array([kind[1]])
        begun = Configuration(kinds, corners, starts[first][None], 0.0)
        return self.settled(begun, beside, ROUNDS, soft)[0]

    def worth(self, found: Configuration) -> float:
        """Return what outlines add to the log probability of a scene."""
        each = self.more - math.log(len(self.kinds))
        return found.log_evidence / self.shared + found.count * each

    def sampled(self, found: Configuration, k: int) -> Sampled:
        """Return the posterior of one outline beside the others, and its evidence.

        Where hardly any point is possible, it is that of the information at the mode.
        """
        beside, outline = self.beside(found, k), found.only(k).outlines
        matrix = np.empty((WIDTH, WIDTH))
        settle.call(beside, outline, 0, 0, 0.0, matrix)
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
            return Sampled(around, np.full(BLOCK, 1.0 / BLOCK), evidence, float(BLOCK))
        return Sampled(points[:used], weights[:used], evidence, equal)


def like(kind: tuple[int, int], other: Configuration) -> list[Values]:
    """Return points of a kind of outline of about another's moments; of a regular one, turned."""
    p, was, corners = other.points[0], int(other.kinds[0]), int(other.corners[0])
    n = unknowns.call(was, corners)
    if was == REGULAR:
        first = second = p[2] * math.sqrt(_filled(corners) / math.pi)
    else:
        first, second = p[2], p[2] if was == DISC else p[3]
    angle = p[4] if was in (ELLIPSE, RECTANGLE) else 0.0
    scale = ROUND if was == RECTANGLE else 1.0
    first, second = scale * first, scale * second
    if kind[0] == DISC:
        return [_row(p[0], p[1], math.sqrt(0.5 * (first * first + second * second)), p[n])]
    if kind[0] == REGULAR:
        corner = math.sqrt(math.pi * first * second / _filled(kind[1]))
        turn = 2.0 * math.pi / kind[1] / TURNS
        return [_row(p[0], p[1], corner, angle + k * turn, p[n]) for k in range(TURNS)]
    scale = 1.0 / ROUND if kind[0] == RECTANGLE else 1.0
    return [_row(p[0], p[1], scale * first, scale * second, angle, p[n])]


def area_of(found: Configuration, k: int = 0) -> float:
    """Return the area of one outline, in cm2."""
    kind, n, p = int(found.kinds[k]), int(found.corners[k]), found.points[k]
    if kind == REGULAR:
        return float(p[2] * p[2] * _filled(n))
    if kind == RECTANGLE:
        return float(4.0 * p[2] * p[3])
    return float(math.pi * p[2] * (p[2] if kind == DISC else p[3]))


def _filled(corners: int) -> float:
    """Return the area of a regular polygon whose corners are 1 from its centre."""
    return 0.5 * corners * math.sin(2.0 * math.pi / corners)


def _row(*numbers: float) -> Values:
    """Return a row of a table of points."""
    row = np.zeros(WIDTH)
    row[: len(numbers)] = numbers
    return row


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


def laid(problem: JointProblem, found: Configuration) -> JointProblem:
    """Return a problem beside outlines."""
    its = problem._replace(load=problem.load.copy(), share=problem.share.copy())
    add_outlines.call(its, found.outlines)
    return its
