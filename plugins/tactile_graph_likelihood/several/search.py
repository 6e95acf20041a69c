"""How many outlines lie on a part of a pad, and which elements are whose."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import replace
from typing import Any

import numpy as np

from tactile_graph.compiled import compiled_as_is
from tactile_graph_likelihood.geometry.outlines import DISC, ELLIPSE, RECTANGLE, Values
from tactile_graph_likelihood.several.alike import alikeness_of
from tactile_graph_likelihood.several.joint_posterior import WIDTH, JointProblem, Outlines, lay
from tactile_graph_likelihood.several.kinds import ROUNDS, like
from tactile_graph_likelihood.several.ladder import (
    GAIN,
    SKETCHED,
    Ladder,
    Mask,
    Sketches,
    dilated,
    neighbours,
)
from tactile_graph_likelihood.several.scene import Configuration, joined
from tactile_graph_likelihood.several.sketch import LIGHTER, REST, STAGES, settle_sketches
from tactile_graph_likelihood.single.element_terms import ON
from tactile_graph_likelihood.single.problem import Places

Place = tuple[tuple[int, ...], Mask, float]
"""Numbers of outlines, which elements are theirs, and what is unexplained there, in nats."""

PAIRS, SOFT = 3, 4
"""Pairs of sketches of a piece that are looked at, and rounds of the soft search for the first kind
that is drawn of each."""

CHANGED, SAME_NUMBER, WORSE = 10.0, 20.0, 6.0
"""How much less log probability sketches may have to be drawn: than what they replace, where they
are one more or less or as many; than the best pair."""

SURPLUS = 4.0
"""What may be left unexplained beyond what is usual, in nats, for outlines not to be looked for in
any other way."""

SPLIT, RECUT = 8.0, 6.0
"""What may be left unexplained, in nats, for an outline not to be parted, for two not to be parted
anew."""

NEAR = 10.0
"""How much less log probability than the likeliest sketches others may have to be drawn."""

NEARLY = 4.0
"""How much less evidence a move may bring at first, for all outlines to settle beside it."""

CLOSE = 15.0
"""How much less evidence outlines may have than what they replace, for other kinds to be tried."""

ROUND_FROM = 0.75
"""Ratio of a sketch's axes from which on it is taken to be a disc."""

SKETCH_OVAL = 1.086
"""Half axis of an ellipse over that of the sketch of the same area."""


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
            if not self.explained(self.noted(self.begun(sketches))):
                self.draw_ladder(sketches, room)
        better: Configuration | None = max(self.every, key=self.rank)
        while better is not None:
            better = self.improved(better, room)
        return self.best

    def explained(self, found: Configuration) -> bool:
        """Return whether outlines leave hardly more unexplained than true ones would."""
        return self.surplus(self.beside(found).load) <= SURPLUS * self.shared

    def draw_ladder(self, begin: Sketches, room: int) -> None:
        """Draw the likeliest sketches of all numbers."""
        rungs = self.ladder(begin, room).values()
        top = max(it.rank for it in rungs)
        for sketches in rungs:
            if sketches.rank > top - NEAR:
                self.noted(self.begun(sketches))

    def begun(self, sketches: Sketches) -> Configuration:
        """Return outlines like sketches, without those that no touched element belongs to."""
        found = self.drawn(sketches.points, self.problem)
        own = self.owners(found)[0]
        idle = [k for k in range(found.count) if not np.any(own == k)]
        return found.without(*idle) if 0 < len(idle) < found.count else found

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
        return self.worth(found) + alikeness_of.call(*found.outlines, self.problem.prior)

    def noted(self, found: Configuration) -> Configuration:
        """Return outlines brought to their joint mode; they are kept if their number's best."""
        found = self.settled(found)[0]
        self.every.append(found)
        worth = self.of_number(found)
        best = self.best.get(found.count)
        if best is None or worth > self.of_number(best):
            self.best[found.count] = found
        self.weighed(found.count, worth)
        return found

    def weighed(self, n: int, worth: float) -> None:
        """Keep what a number of outlines adds to the log probability, if it is the most."""
        self.worths[n] = max(worth, self.worths.get(n, -math.inf))

    def improved(self, found: Configuration, room: int) -> Configuration | None:
        """Return better outlines, None if no move makes any."""
        rank = self.rank(found)
        for out, mask, left in self.places(found, room):
            beside, rest = self.beside(found, *out), found.without(*out)
            now = self.settled(joined([found.only(k) for k in out]), beside, 0)[0]
            before = self.worth(now)
            for new in self.instead(out, mask, beside, (before, left)):
                log = found.log_evidence + new.log_evidence - now.log_evidence
                made = replace(joined([rest, new]), log_evidence=log)
                self.weighed(made.count, self.of_number(made))
                if self.rank(made) < rank - NEARLY:
                    continue
                made = self.noted(made)
                if self.rank(made) > rank + GAIN:
                    return made
        return None

    def places(self, found: Configuration, room: int) -> Iterator[Place]:
        """Yield one or two outlines that may be others, what is theirs, and what is unexplained.

        Those that explain least come first.
        """
        own, unexplained = self.owners(found)
        some: list[Place] = [*neighbours(own, unexplained, found.count)]
        if found.count < room:
            masks = [own == k for k in range(found.count)]
            left = [float(unexplained[dilated(mask)].sum()) for mask in masks]
            some += [((k,), masks[k], left[k]) for k in range(found.count) if left[k] > SPLIT]
        for out, mask, unsaid in sorted(some, key=lambda it: -it[2]):
            key = bytes([len(out)]) + mask.tobytes()
            if mask.any() and key not in self.seen:
                self.seen.add(key)
                yield out, mask, unsaid

    def instead(
        self, out: tuple[int, ...], mask: Mask, beside: JointProblem, left: tuple[float, float]
    ) -> Iterator[Configuration]:
        """Yield what may explain a mask beside others: one outline, or two."""
        before, unexplained = left
        if len(out) > 1:
            one = self.sketch_of(mask)
            if self.sketched(one, beside) > before - CHANGED:
                yield self.drawn(one, beside, before)
            if unexplained < RECUT:
                return
        pairs = self.parted(mask, beside, PAIRS)
        least = before - (SAME_NUMBER if len(out) > 1 else CHANGED)
        for worth, pair in pairs:
            if worth > max(least, pairs[0][0] - WORSE):
                yield self.drawn(pair, beside, before)

    def drawn(
        self, points: Values, beside: JointProblem, worth: float = -math.inf
    ) -> Configuration:
        """Return outlines like sketches beside others.

        Each is of the kind that explains most, where they come near a worth.
        """
        points = points.copy()
        settle_sketches.call(beside, points, SKETCHED, len(STAGES))
        begun = made = joined([self.guessed(point) for point in points])
        made = self.settled(made, beside, ROUNDS, SOFT)[0]
        if self.worth(made) < worth - CLOSE:
            return made
        for k in range(made.count):
            rest = self.beside(made, k, before=beside)
            fits = self.as_kinds(made.only(k), rest, 0)
            if made.count == 1:
                fits += self.as_kinds(begun, rest, ROUNDS, tries=True)
            made = made.with_one(k, max(fits, key=lambda it: it.log_evidence))
        return self.settled(made, beside, ROUNDS)[0]

    def guessed(self, point: Values) -> Configuration:
        """Return the outline of a likely kind that has a sketch's moments."""
        x, y, a, b, angle, load = point
        a, b = SKETCH_OVAL * math.exp(a + REST), SKETCH_OVAL * math.exp(b + REST)
        oval = np.array([[x, y, a, b, angle, load - LIGHTER * REST]])
        its = Configuration(np.array([ELLIPSE]), np.array([0]), oval, 0.0)
        likely = (DISC, 0) if min(a, b) > ROUND_FROM * max(a, b) else (RECTANGLE, 0)
        kind = likely if likely in self.kinds else self.kinds[0]
        point = np.zeros((1, WIDTH))
        like.call(*kind, its.outlines, 0, point[0])
        return Configuration(np.array([kind[0]]), np.array([kind[1]]), point, 0.0)

    def owners(self, found: Configuration) -> tuple[Places, Values]:
        """Return which outline, from 0, each touched element belongs to, and what is unexplained.

        -1 where untouched; what outlines that explain an element wholly would add, in nats.
        """
        own, load = owners.call(self.problem, found.outlines)
        return own, self.unexplained(load)


@compiled_as_is
def owners(problem: JointProblem, outlines: Outlines) -> tuple[Places, Values]:
    """Return which outline brings most to each touched element, -1 for none, and the load of all.

    Elements that none reaches are the nearest owner's, if that is within two elements.
    """
    rows, columns = problem.states.shape
    own, load = np.full((rows, columns), -1), np.zeros((rows, columns))
    most = np.zeros((rows, columns))
    for k in range(outlines.kinds.shape[0]):
        its, share = np.zeros((rows, columns)), np.zeros((rows, columns))
        lay(problem, outlines, k, 0, 0, its, share)
        for i in range(rows):
            for j in range(columns):
                load[i, j] += its[i, j]
                if problem.states[i, j] == ON and its[i, j] > most[i, j]:
                    most[i, j], own[i, j] = its[i, j], k
    for i in range(rows):
        for j in range(columns):
            near, nearest = 3, -1
            if problem.states[i, j] != ON or own[i, j] >= 0:
                continue
            for y in range(max(i - 2, 0), min(i + 3, rows)):
                for x in range(max(j - 2, 0), min(j + 3, columns)):
                    far = max(abs(y - i), abs(x - j))
                    if own[y, x] >= 0 and far < near:
                        near, nearest = far, own[y, x]
            own[i, j] = nearest
    return own, load
