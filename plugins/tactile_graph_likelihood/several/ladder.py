"""Sketches of a part of a pad, of each number that may lie there: where a search begins.

From a sketch for each connected piece, cut where it is empty, the sketch whose parting gains most
is parted, neighbours are cut anew until none gains, and so on, even where a further sketch gains
nothing yet: two moves may be needed. Then neighbours are joined on the way back down.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from tactile_graph.compiled import compiled_as_is
from tactile_graph_likelihood.geometry.outlines import Values
from tactile_graph_likelihood.geometry.pieces import components
from tactile_graph_likelihood.several.alike import alikeness
from tactile_graph_likelihood.several.joint_posterior import WIDTH, JointProblem, apart
from tactile_graph_likelihood.several.partings import partings, sketch_of_mask
from tactile_graph_likelihood.several.scene import Scene
from tactile_graph_likelihood.several.seeds import seeds
from tactile_graph_likelihood.several.sketch import STAGES, lay_sketches, settle_sketches
from tactile_graph_likelihood.several.whose import unexplained_by, whose_by_sketches
from tactile_graph_likelihood.single.problem import Places

Mask = NDArray[np.bool_]

LEAST_PIECE = 4
"""Elements of a piece."""

SKETCHED = len(STAGES) - 1
"""Stages in which sketches are compared; the last is for what is drawn."""

DRAWN = 2.0
"""How much more evidence an outline has than its sketch, about."""

UNEXPLAINED = 4.0
"""What may be left unexplained, in nats, for a sketch not to be parted, nor two cut anew."""

GIVE_UP, GAIN = 8.0, 0.1
"""How much less log probability than the best a number may have for a larger one to be tried; what
a move must bring."""

LOCALLY = 2.0
"""How much less evidence two neighbours cut anew may have beside the others as they are, for all to
be brought to their joint mode."""

HOPELESS = 15.0
"""How much less log probability than the best a number may have for none of its neighbours to be
joined."""


class Sketches(NamedTuple):
    """All sketches of a part, shape (N, 6) as in `sketch`, and their log probability."""

    points: Values
    rank: float


class Ladder(Scene):
    """A part of a pad in sketches."""

    def __init__(self, *args: Any) -> None:
        super().__init__(*args)
        self.each = self.before + DRAWN
        self.cut: set[bytes] = set()
        self.halves: dict[bytes, list[tuple[float, Values]]] = {}

    def ladder(self, begin: Sketches, room: int) -> dict[int, Sketches]:
        """Return the best sketches of each number that is come upon from some."""
        now = self.recut(begin)
        best = {len(now.points): now}
        while len(now.points) < room and (more := self.parted_once(now)):
            now = self.recut(more)
            best[len(now.points)] = now
            if now.rank < max(it.rank for it in best.values()) - GIVE_UP:
                break
        top = max(it.rank for it in best.values())
        for n in range(max(best), 1, -1):
            if n in best and best[n].rank < top - HOPELESS:
                break
            fewer = self.joined_once(best[n]) if n in best else None
            if fewer and (n - 1 not in best or fewer.rank > best[n - 1].rank + GAIN):
                best[n - 1] = self.recut(fewer)
        return best

    def together(self, points: Values, first: int = SKETCHED - 1) -> Sketches:
        """Return sketches brought to their joint mode."""
        points = points.copy()
        worth = self.sketched(points, self.problem, first) + math.lgamma(len(points) + 1.0)
        log_sizes = 0.5 * (points[:, 2] + points[:, 3])
        return Sketches(points, worth + alikeness.call(log_sizes, points[:, 5], self.problem.prior))

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

    def parted_once(self, now: Sketches) -> Sketches | None:
        """Return them with that one parted which gains most by itself, None if none can be."""
        points, found = now.points, list[tuple[float, Values]]()
        own, unexplained = self.shares(points)
        for k in range(len(points)):
            mask = own == k
            if len(points) > 1 and unexplained[dilated(mask)].sum() < UNEXPLAINED:
                continue
            beside, rest = self.beside_sketches(points, k)
            before = self.sketched(points[k : k + 1].copy(), beside, SKETCHED - 1)
            key = mask.tobytes()
            if key not in self.halves:
                self.halves[key] = self.parted(mask, beside, 1)
            for worth, pair in self.halves[key]:
                found.append((worth - before, np.concatenate([rest, pair])))
        return self.likeliest_of(found)

    def joined_once(self, now: Sketches) -> Sketches | None:
        """Return them with those neighbours joined which lose least, None where there are none."""
        points, found = now.points, list[tuple[float, Values]]()
        own, unexplained = self.shares(points)
        for pair, mask, _ in neighbours(own, unexplained, len(points)):
            beside, rest = self.beside_sketches(points, *pair)
            one = self.sketch_of(mask)
            before = self.sketched(points[list(pair)], beside, SKETCHED - 1)
            found.append((self.sketched(one, beside) - before, np.concatenate([rest, one])))
        return self.likeliest_of(found)

    def likeliest_of(self, found: list[tuple[float, Values]]) -> Sketches | None:
        """Return the sketches that gain most, brought to their joint mode."""
        return self.together(max(found, key=lambda it: it[0])[1]) if found else None

    def recut(self, now: Sketches) -> Sketches:
        """Return as many sketches, of which no two neighbours cut anew would be likelier."""
        better: Sketches | None = now
        while better is not None:
            now, better = better, next(self.cut_anew(better), None)
        return now

    def cut_anew(self, now: Sketches) -> Iterator[Sketches]:
        """Yield what is likelier by two neighbours cut anew."""
        own, unexplained = self.shares(now.points)
        for pair, mask, left in neighbours(own, unexplained, len(now.points)):
            key = mask.tobytes()
            if left < UNEXPLAINED or key in self.cut:
                continue
            self.cut.add(key)
            beside, rest = self.beside_sketches(now.points, *pair)
            before = self.sketched(now.points[list(pair)], beside, SKETCHED - 1)
            for worth, two in self.parted(mask, beside, 1):
                if worth < before - LOCALLY:
                    continue
                new = self.together(np.concatenate([rest, two]))
                if new.rank > now.rank + GAIN:
                    yield new

    def beside_sketches(self, points: Values, *left_out: int) -> tuple[JointProblem, Values]:
        """Return the problem beside all sketches but for some, and those that it is beside."""
        rest = points[[k for k in range(len(points)) if k not in left_out]]
        return laid_on(self.problem, rest), rest

    def shares(self, points: Values) -> tuple[Places, Values]:
        """Return which sketch each touched element lies in, or nearest to, and what is unexplained.

        -1 where untouched; what sketches that explain an element wholly would add, in nats.
        """
        own = whose_by_sketches.call(self.problem, points)
        beside, _ = self.beside_sketches(points)
        return own, self.unexplained(beside.load)

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


def laid_on(problem: JointProblem, points: Values) -> JointProblem:
    """Return a problem beside sketches."""
    beside = apart(problem)
    lay_sketches.call(beside, points)
    return beside


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
