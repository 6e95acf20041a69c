"""How many outlines lie on a part of a pad, and which elements are whose."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import Any

import numpy as np

from tactile_graph_likelihood.geometry.outlines import Values
from tactile_graph_likelihood.geometry.pieces import components
from tactile_graph_likelihood.several.beginnings.ladder import (
    Ladder,
    Mask,
    Sketches,
    dilated,
    neighbours,
)
from tactile_graph_likelihood.several.joint.alike import alikeness_of
from tactile_graph_likelihood.several.joint.joint_posterior import JointProblem
from tactile_graph_likelihood.several.joint.kinds import SOFT, draw
from tactile_graph_likelihood.several.joint.scene import Configuration, area_of, joined
from tactile_graph_likelihood.several.joint.whose import USUAL, whose_by_outlines
from tactile_graph_likelihood.several.sides import sides_moved
from tactile_graph_likelihood.single.density.problem import Places

Place = tuple[tuple[int, ...], Mask, float]
"""Numbers of outlines, which elements are theirs, and what is unexplained there, in nats."""

PAIRS = 3
"""Pairs of sketches of a piece that are looked at."""

THREE_STARTS, THREES, THREE = 8, 2, 15.0
"""Elements that three clusters of two outlines' elements begin from, triples that are drawn at
most, and how much less log probability these may have than what they replace."""

PARTED_IN_TWO, JOINED, SAME_NUMBER, WORSE = 10.0, 7.0, 20.0, 6.0
"""How much less log probability sketches may have to be drawn: than what they replace, where they
are one more, one less or as many; than the best pair."""

SURPLUS = 4.0
"""What may be left unexplained beyond what is usual, in nats, for outlines not to be looked for in
any other way."""

CUT_SURPLUS = -2.0
"""The same of outlines more than the connected pieces: what is cut may be cut elsewhere."""

MANY, CHANCE = 150, 0.63
"""Touched elements beyond which chance alone leaves more, and its standard deviation over the root
of their number."""

GAIN = 0.1
"""What a move must bring."""

SPLIT, RECUT = 8.0, 9.0
"""What may be left unexplained, in nats, for an outline not to be parted, for two not to be parted
anew."""

NEAR, MOST_DRAWN = 10.0, 4
"""How much less log probability than the likeliest sketches others may have to be drawn, and how
many are."""

NEARLY = 4.0
"""How much less evidence a move may bring at first, for all outlines to settle beside it."""

CLOSE = 15.0
"""How much less evidence outlines may have than what they replace, for other kinds to be tried."""

MUCH_LARGER = 4.0
"""How many times as large an outline is as its neighbour from which on it is tried alone, too: of
many elements a sketch is too rough to tell that it explains those of a strip along its edge."""

LEAST_OWN = 3
"""Touched elements that belong to an outline, where there are others; what it covers in less may be
strays, or what a neighbour's edge misses."""


class Search(Ladder):
    """Outlines on a part of a pad, improved by moves until none gains.

    What a move may put in the place of one or two outlines is sketched first.
    """

    def __init__(self, *args: Any) -> None:
        super().__init__(*args)
        self.seen: set[bytes] = set()
        self.best: dict[int, Configuration] = {}
        self.every: list[Configuration] = []
        self.worths: dict[int, float] = {}
        self.logs: dict[Configuration, float] = {}

    def divisions(
        self, room: int, begin: Configuration | None = None, anew: bool = True
    ) -> dict[int, Configuration]:
        """Return the best outlines of each number that the search comes upon.

        It may begin with some outlines, too; with no others, unless ``anew``, where they explain
        what is read.
        """
        if begin is not None:
            self.noted(begin)
        if anew or begin is None or not self.explained(self.every[-1]):
            sketches = self.together(self.beginnings(room), 0)
            found = self.noted(self.begun(sketches))
            if not self.explained(found, SURPLUS if self.uncut(found) else CUT_SURPLUS):
                self.draw_ladder(sketches, room)
        better: Configuration | None = max(self.every, key=self.rank)
        while better is not None:
            better = self.improved(better, room)
        return self.best

    def explained(self, found: Configuration, most: float = SURPLUS) -> bool:
        """Return whether outlines leave hardly more unexplained than true ones would."""
        most += by_chance(int(np.count_nonzero(self.on)))
        return self.surplus(self.beside(found).load) <= most * self.shared

    def uncut(self, found: Configuration) -> bool:
        """Return whether outlines are no more than the pieces of touched elements side by side."""
        return found.count <= int(components.call(self.on, 1).max())

    def draw_ladder(self, begin: Sketches, room: int) -> None:
        """Draw the likeliest sketches of all numbers."""
        rungs = self.ladder(begin, room)[:MOST_DRAWN]
        for sketches in rungs:
            if sketches.rank > rungs[0].rank - NEAR:
                self.noted(self.begun(sketches))

    def begun(self, sketches: Sketches) -> Configuration:
        """Return outlines like sketches, without those that no touched element belongs to."""
        return self.without_idle(self.drawn(sketches.points, self.problem), 1)

    def without_idle(self, found: Configuration, least: int = LEAST_OWN) -> Configuration:
        """Return outlines but for those to which fewer touched elements belong; the best remains.

        No move comes upon those to which none belongs, and beyond the part's elements they cost
        next to nothing.
        """
        own = self.owners(found)[0]
        counts = np.bincount(own[own >= 0], minlength=found.count)
        idle = np.flatnonzero(counts < min(least, counts.max()))
        return found.without(*idle) if len(idle) else found

    def far_from(self, x_cm: float, y_cm: float) -> float:
        """Return the distance of a place from the nearest touched element, in cm."""
        rows, columns = np.nonzero(self.on)
        x0, y0, pitch, side = self.problem.grid[:4]
        x, y = x0 + 0.5 * side + pitch * columns, y0 + 0.5 * side + pitch * rows
        return float(np.hypot(x - x_cm, y - y_cm).min())

    def rank(self, found: Configuration) -> float:
        """Return the log probability of outlines, of any number of them."""
        return self.of_number(found) + math.lgamma(found.count + 1.0)

    def of_number(self, found: Configuration) -> float:
        """Return the log probability of outlines that are all of a part's, in one order."""
        if (known := self.logs.get(found)) is None:
            alike = alikeness_of.call(found.outlines, self.problem.prior)
            known = self.logs[found] = self.worth(found) + alike
        return known

    def noted(self, found: Configuration) -> Configuration:
        """Return outlines brought to their joint mode; they are kept if their number's best."""
        found = self.settled(found)[0]
        while (fewer := self.without_idle(found)) is not found:
            found = self.settled(fewer)[0]
        self.every.append(found)
        self.weighed(found.count, self.of_number(found))
        best = self.best.get(found.count)
        if best is None or self.rank(found) > self.rank(best):
            self.best[found.count] = found
        return found

    def weighed(self, n: int, worth: float) -> None:
        """Keep what a number of outlines adds to the log probability, if it is the most."""
        self.worths[n] = max(worth, self.worths.get(n, -math.inf))

    def improved(self, found: Configuration, room: int) -> Configuration | None:
        """Return better outlines, None if no move makes any."""
        if (made := self.with_sides_moved(found)) is not found:
            made = self.noted(made)
            if self.rank(made) > self.rank(found) + GAIN:
                return made
        for out, mask, left in self.places(found, room):
            beside, rest = self.beside(found, *out), found.without(*out)
            now = self.settled(joined([found.only(k) for k in out]), beside, 0)[0]
            for new in self.instead((out, mask, left), now, beside, found.count < room):
                log = found.log_evidence + new.log_evidence - now.log_evidence
                made = joined([rest, new], log)
                self.weighed(made.count, self.of_number(made))
                if self.rank(made) < self.rank(found) - NEARLY:
                    continue
                made = self.noted(made)
                if self.rank(made) > self.rank(found) + GAIN:
                    return made
        return None

    def with_sides_moved(self, found: Configuration) -> Configuration:
        """Return outlines, the sides of those of many elements in other gaps where likelier."""
        made = found
        if np.count_nonzero(self.on) <= MANY:
            return made
        own = self.owners(found)[0]
        for k in range(found.count):
            if np.count_nonzero(own == k) > MANY:
                one = found.only(k)
                moved = sides_moved(self.beside(found, k), one)
                made = made if moved is one else made.with_one(k, moved)
        return made

    def places(self, found: Configuration, room: int) -> Iterator[Place]:
        """Yield one or two outlines that may be others, what is theirs, and what is unexplained.

        Those that explain least come first.
        """
        own, unexplained = self.owners(found)
        some: list[Place] = [*neighbours(own, unexplained, found.count)]
        if found.count < room:
            masks = [own == k for k in range(found.count)]
            left = [float(unexplained[dilated(mask)].sum()) for mask in masks]
            least = [split_from(int(np.count_nonzero(mask))) for mask in masks]
            some += [((k,), masks[k], left[k]) for k in range(found.count) if left[k] > least[k]]
        for out, mask, unsaid in sorted(some, key=lambda it: -it[2]):
            key = bytes([len(out)]) + mask.tobytes()
            if mask.any() and key not in self.seen:
                self.seen.add(key)
                yield out, mask, unsaid

    def instead(
        self, place: Place, now: Configuration, beside: JointProblem, more: bool
    ) -> Iterator[Configuration]:
        """Yield what may explain a place beside others: one outline, two, or three for two.

        ``now`` is what lies there, and ``more`` whether there may be more outlines.
        """
        (out, mask, unexplained), before = place, self.worth(now)
        if len(out) > 1:
            areas = [area_of(now, k) for k in range(2)]
            if max(areas) > MUCH_LARGER * min(areas):
                yield self.settled(now.only(int(np.argmax(areas))), beside, soft=SOFT)[0]
            one = self.sketch_of(mask)
            if self.sketched(one, beside) > before - JOINED:
                yield self.drawn(one, beside, before)
            if unexplained < RECUT:
                return
        pairs = self.parted(mask, beside, PAIRS)
        least = before - (SAME_NUMBER if len(out) > 1 else PARTED_IN_TWO)
        for worth, pair in pairs:
            if worth > max(least, pairs[0][0] - WORSE):
                yield self.drawn(pair, beside, before)
        if len(out) > 1 and more:
            for worth, three in self.threes(mask, beside):
                if worth > before - THREE:
                    yield self.drawn(three, beside, before)

    def threes(self, mask: Mask, beside: JointProblem) -> list[tuple[float, Values]]:
        """Return triples of sketches for a mask, the best first, and their worth.

        Two outlines that cover three objects explain them half each: parting either gains nothing.
        """
        return self.clustered(mask, beside, 3, THREE_STARTS)[:THREES]

    def drawn(
        self, points: Values, beside: JointProblem, worth: float = -math.inf
    ) -> Configuration:
        """Return outlines like sketches beside others.

        Each is of the kind that explains most, where they come near a worth.
        """
        points, which = points.copy(), np.empty(len(points), np.int64)
        least, may_be = self.shared * (worth - CLOSE - len(points) * self.before), self.may_be
        log = draw.call(beside, may_be, points, which, least)
        return Configuration(may_be.kinds[which], may_be.corners[which], points, log)

    def owners(self, found: Configuration) -> tuple[Places, Values]:
        """Return which outline, from 0, each touched element belongs to, and what is unexplained.

        -1 where untouched; what outlines that explain an element wholly would add, in nats.
        """
        return whose_by_outlines.call(self.problem, found.outlines)


def by_chance(touched: int) -> float:
    """Return what chance leaves unexplained of so many touched elements, beyond what is usual."""
    return CHANCE * math.sqrt(touched) if touched > MANY else 0.0


def split_from(touched: int) -> float:
    """Return what must be left unexplained, in nats, for an outline of so many to be parted."""
    return max(SPLIT, USUAL * touched + by_chance(touched)) if touched > MANY else SPLIT
