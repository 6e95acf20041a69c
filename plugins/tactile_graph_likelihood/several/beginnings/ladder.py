"""Sketches of a part of a pad, of each number that may lie there: where a search begins.

Touched elements are gathered in two, three and so on clusters at once, from several places.
"""

from __future__ import annotations

import math
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from tactile_graph.compiled import compiled_as_is
from tactile_graph_likelihood.geometry.outlines import Values
from tactile_graph_likelihood.geometry.pieces import components
from tactile_graph_likelihood.several.beginnings.clusters import clustered
from tactile_graph_likelihood.several.beginnings.partings import partings, sketch_of_mask
from tactile_graph_likelihood.several.beginnings.seeds import seeds
from tactile_graph_likelihood.several.joint.alike import alikeness
from tactile_graph_likelihood.several.joint.joint_posterior import WIDTH, JointProblem
from tactile_graph_likelihood.several.joint.scene import Scene
from tactile_graph_likelihood.several.joint.sketch import STAGES, settle_sketches
from tactile_graph_likelihood.several.joint.whose import unexplained_by
from tactile_graph_likelihood.single.density.problem import Places

Mask = NDArray[np.bool_]

LEAST_PIECE = 4
"""Elements of a piece."""

SKETCHED = len(STAGES) - 1
"""Stages in which sketches are compared; the last is for what is drawn."""

DRAWN = 2.0
"""How much more evidence an outline has than its sketch, about."""

STARTS, CLIMBED, DRAWN_EACH = 12, 5, 2
"""Elements that clusters begin from; sketches of a number that are climbed from; those kept."""

GIVE_UP = 8.0
"""How much less log probability than the best a number may have for a larger one to be tried."""

OTHER = 0.3
"""Difference of log probabilities of sketches that are not the same."""


class Sketches(NamedTuple):
    """All sketches of a part, shape (N, 6) as in `sketch`, and their log probability."""

    points: Values
    rank: float


class Ladder(Scene):
    """A part of a pad in sketches."""

    def __init__(self, *args: Any) -> None:
        super().__init__(*args)
        self.each = self.before + DRAWN

    def ladder(self, begin: Sketches, room: int) -> list[Sketches]:
        """Return the likeliest sketches of each number, and those that it begins with."""
        found, top = [begin], begin.rank
        for n in range(2, room + 1):
            rung = self.rung(n)
            if not rung:
                break
            found += rung
            top = max(top, rung[0].rank)
            if n > len(begin.points) and rung[0].rank < top - GIVE_UP:
                break
        return sorted(found, key=lambda it: -it.rank)

    def rung(self, n: int) -> list[Sketches]:
        """Return the likeliest sketches of one number, the best first."""
        some = self.clustered(self.on, self.problem, n, STARTS)
        every = sorted((self.ranked(its, worth) for worth, its in some), key=lambda it: -it.rank)
        kept = list[Sketches]()
        for its in every:
            if all(other.rank - its.rank > OTHER for other in kept):
                kept.append(its)
        return kept[:DRAWN_EACH]

    def clustered(
        self, mask: Mask, beside: JointProblem, n: int, starts: int
    ) -> list[tuple[float, Values]]:
        """Return so many sketches for a mask beside others, the best first, and their worth."""
        found, logs = np.empty((CLIMBED, n, WIDTH)), np.empty(CLIMBED)
        clustered.call(beside, mask, LEAST_PIECE, starts, found, logs)
        some = [
            (log / self.shared + n * self.each, its)
            for log, its in zip(logs.tolist(), found, strict=True)
            if log > -math.inf
        ]
        return sorted(some, key=lambda it: -it[0])

    def together(self, points: Values, first: int = SKETCHED - 1) -> Sketches:
        """Return sketches brought to their joint mode."""
        points = points.copy()
        return self.ranked(points, self.sketched(points, self.problem, first))

    def ranked(self, points: Values, worth: float) -> Sketches:
        """Return sketches of a worth with their log probability."""
        log_sizes = 0.5 * (points[:, 2] + points[:, 3])
        alike = alikeness.call(log_sizes, points[:, 5], self.problem.prior)
        return Sketches(points, worth + math.lgamma(len(points) + 1.0) + alike)

    def sketched(self, points: Values, beside: JointProblem, first: int = 0) -> float:
        """Bring sketches, in place, to their joint mode beside others; return what they add."""
        log = settle_sketches.call(beside, points, first, SKETCHED)
        return log / self.shared + len(points) * self.each

    def beginnings(self, room: int) -> Values:
        """Return a sketch of each connected piece, cut where it is empty; the largest ones only."""
        labels = components.call(self.on, 1)
        counts = np.bincount(labels.ravel())[1:]
        order = np.argsort(-counts, kind="stable")
        large = [k + 1 for k in order if counts[k] >= LEAST_PIECE][:room] or [int(order[0]) + 1]
        masks = seeds([labels == k for k in large], room, LEAST_PIECE)
        return np.concatenate([self.sketch_of(mask) for mask in masks])

    def parted(self, mask: Mask, beside: JointProblem, most: int) -> list[tuple[float, Values]]:
        """Return pairs of sketches for a mask beside others, the best first, and their worth."""
        if np.count_nonzero(mask) < 2 * LEAST_PIECE:
            return []
        found, logs = np.empty((most, 2, WIDTH)), np.empty(most)
        partings.call(beside, mask, LEAST_PIECE, found, logs)
        pairs = [
            (log / self.shared + 2 * self.each, pair)
            for log, pair in zip(logs.tolist(), found, strict=True)
            if log > -math.inf
        ]
        return sorted(pairs, key=lambda it: -it[0])

    def sketch_of(self, mask: Mask) -> Values:
        """Return the sketch with a mask's moments, shape (1, 6)."""
        point = np.zeros((1, WIDTH))
        sketch_of_mask.call(mask, self.problem.logs, self.problem.grid, point)
        return point

    def surplus(self, load: Values) -> float:
        """Return how much more is left unexplained than were the model true, in nats."""
        return float(unexplained_by.call(self.problem, load, True).sum())

    def unexplained(self, load: Values) -> Values:
        """Return how much likelier each element's reading would be, were it explained wholly."""
        return unexplained_by.call(self.problem, load, False)


Pair = tuple[tuple[int, int], Mask, float]
"""Numbers of two neighbours, which elements are theirs, and what is unexplained there, in nats."""


def neighbours(own: Places, unexplained: Values, count: int) -> list[Pair]:
    """Return what lies next to each other, those first that explain least.

    ``own`` is the number of what each element belongs to, from 0.
    """
    near = left_near.call(own, unexplained, count)
    pairs = [(a, b) for a in range(count) for b in range(a) if near[b, a]]
    found = [((a, b), (own == a) | (own == b), float(near[a, b])) for a, b in pairs]
    return sorted(found, key=lambda it: -it[2])


@compiled_as_is
def left_near(own: Places, unexplained: Values, count: int) -> Values:
    """Return what is unexplained on two's elements and next to them, and which two lie near.

    Returns
    -------
    ndarray, shape (K, K)
        Below the diagonal what is unexplained; above it 1 where an element is next to both, 0 where
        none is.
    """
    rows, cols = own.shape
    found, here = np.zeros((count, count)), np.zeros(count, np.bool_)
    for i in range(rows):
        for j in range(cols):
            here[:] = False
            for r in range(max(i - 1, 0), min(i + 2, rows)):
                for c in range(max(j - 1, 0), min(j + 2, cols)):
                    if 0 <= own[r, c] < count:
                        here[own[r, c]] = True
            for a in range(count):
                for b in range(a):
                    if here[a] or here[b]:
                        found[a, b] += unexplained[i, j]
                    if here[a] and here[b]:
                        found[b, a] = 1.0
    return found


def dilated(mask: Mask) -> Mask:
    """Return where a mask is, or is next to."""
    out = mask.copy()
    out[1:] |= mask[:-1]
    out[:-1] |= mask[1:]
    wide = out.copy()
    wide[:, 1:] |= out[:, :-1]
    wide[:, :-1] |= out[:, 1:]
    return wide
