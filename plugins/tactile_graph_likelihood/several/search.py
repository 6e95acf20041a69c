"""How many outlines lie on a part of a pad, and which elements are whose."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.special import ndtr

from tactile_graph_likelihood.geometry.outlines import DISC, ELLIPSE, RECTANGLE, Values
from tactile_graph_likelihood.several.joint_posterior import WIDTH, JointProblem, add_outline
from tactile_graph_likelihood.several.partings import across, components, partings, sketch_of
from tactile_graph_likelihood.several.scene import ROUNDS, Configuration, Scene, joined, like
from tactile_graph_likelihood.several.sketch import (
    LIGHTER,
    REST,
    STAGES,
    lay_sketches,
    settle_sketches,
)
from tactile_graph_likelihood.single.element_terms import LEAST, SIGMA, UNKNOWN, VOIDS, on_level
from tactile_graph_likelihood.single.problem import Places

Mask = NDArray[np.bool_]

Place = tuple[tuple[int, ...], Mask, float]
"""Numbers of outlines, which elements are theirs, and what is unexplained there, in nats."""

LEAST_PIECE = 4
"""Elements of a piece."""

SKETCHED = len(STAGES) - 1
"""Stages in which sketches are compared; the last is for what is drawn."""

PAIRS, SOFT = 3, 4
"""Pairs of sketches of a piece that are looked at, and rounds of the soft search for the first kind
that is drawn of each."""

TRIES = 24
"""Other starts of an outline that is drawn by itself."""

HOPE, WORSE = 20.0, 6.0
"""How much less log probability than one sketch of all, and than the best pair, a pair may have to
be drawn."""

DRAWN = 2.0
"""How much more evidence an outline has than its sketch, about."""

SPLIT, RECUT, THIRD = 8.0, 6.0, 30.0
"""What may be left unexplained, in nats, for an outline not to be parted, for two not to be parted
anew, and for a piece not to be parted in three."""

ODD = 2.0
"""Half the squared residual, in sigmas, from which on a reading counts as not explained."""

NEARLY, GAIN = 4.0, 0.1
"""How much less evidence a move may bring at first, for all outlines to settle beside it; what it
must bring."""

CLOSE = 15.0
"""How much less evidence outlines may have than what they replace, for other kinds to be tried."""

ROUND_FROM = 0.75
"""Ratio of a sketch's axes from which on it is taken to be a disc."""

SKETCH_OVAL = 1.086
"""Half axis of an ellipse over that of the sketch of the same area."""


class Search(Scene):
    """Outlines on a part of a pad, improved by moves until none gains.

    What a move may put in the place of one or two outlines is sketched first.
    """

    def __init__(self, *args: Any) -> None:
        super().__init__(*args)
        self.each = self.more - math.log(len(self.kinds)) + DRAWN
        self.seen: set[bytes] = set()
        self.best: dict[int, Configuration] = {}
        self.every: list[Configuration] = []
        self.worths: dict[int, float] = {}

    def divisions(self, room: int, begin: Configuration | None = None) -> dict[int, Configuration]:
        """Return the best outlines of each number that the search comes upon.

        It may begin with some outlines, too.
        """
        found = self.noted(self.start(room))
        if begin is not None:
            found = max(found, self.noted(begin), key=self.rank)
        better: Configuration | None = found
        while better is not None:
            found, better = better, self.improved(better, room)
        return self.best

    def far_from(self, x_cm: float, y_cm: float) -> float:
        """Return the distance of a place from the nearest touched element, in cm."""
        rows, columns = np.nonzero(self.on)
        x0, y0, pitch, side = self.problem.grid[:4]
        x, y = x0 + 0.5 * side + pitch * columns, y0 + 0.5 * side + pitch * rows
        return float(np.hypot(x - x_cm, y - y_cm).min())

    def rank(self, found: Configuration) -> float:
        """Return the log probability of outlines, of any number of them."""
        return self.worth(found) + math.lgamma(found.count + 1.0)

    def noted(self, found: Configuration) -> Configuration:
        """Return outlines brought to their joint mode; they are kept if their number's best."""
        found = self.settled(found)[0]
        self.every.append(found)
        self.weighed(found.count, self.worth(found))
        best = self.best.get(found.count)
        if best is None or found.log_evidence > best.log_evidence:
            self.best[found.count] = found
        return found

    def weighed(self, n: int, worth: float) -> None:
        """Keep what a number of outlines adds to the log probability, if it is the most."""
        self.worths[n] = max(worth, self.worths.get(n, -math.inf))

    def start(self, room: int) -> Configuration:
        """Return an outline for each connected piece, the largest ones if there are too many."""
        labels = components.call(self.on, 1)
        counts = np.bincount(labels.ravel())[1:]
        order = np.argsort(-counts, kind="stable")
        large = [k + 1 for k in order if counts[k] >= LEAST_PIECE][:room] or [int(order[0]) + 1]
        points = np.concatenate([self.sketch_of(labels == k) for k in large])
        settle_sketches.call(self.problem, points, 0, SKETCHED)
        return self.drawn(points, self.problem)

    def improved(self, found: Configuration, room: int) -> Configuration | None:
        """Return better outlines, None if no move makes any."""
        for out, mask, left in self.places(found, room):
            beside, rest = self.beside(found, *out), found.without(*out)
            now = joined([found.only(k) for k in out])
            before = self.worth(self.settled(now, beside, 0)[0])
            for new in self.instead(out, mask, beside, (before, left, room - rest.count)):
                worth = self.worth(found) + self.worth(new) - before
                n = rest.count + new.count
                self.weighed(n, worth)
                if worth + math.lgamma(n + 1.0) < self.rank(found) - NEARLY:
                    continue
                made = self.noted(joined([rest, new]))
                if self.rank(made) > self.rank(found) + GAIN:
                    return made
        return None

    def places(self, found: Configuration, room: int) -> Iterator[Place]:
        """Yield one or two outlines that may be others, what is theirs, and what is unexplained.

        Those that explain least come first.
        """
        own, unexplained = self.owners(found)
        masks = [own == k for k in range(found.count)]
        wide = [dilated(mask) for mask in masks]
        some: list[Place] = [
            ((a,), masks[a], float(unexplained[wide[a]].sum())) for a in range(found.count)
        ]
        some = [it for it in some if it[2] > SPLIT and found.count < room]
        for a in range(found.count):
            for b in range(a):
                if (wide[a] & wide[b]).any():
                    left = float(unexplained[wide[a] | wide[b]].sum())
                    some.append(((a, b), masks[a] | masks[b], left))
        for out, mask, left in sorted(some, key=lambda it: -it[2]):
            key = bytes([len(out)]) + mask.tobytes()
            if mask.any() and key not in self.seen:
                self.seen.add(key)
                yield out, mask, left

    def instead(
        self, out: tuple[int, ...], mask: Mask, beside: JointProblem, left: tuple[float, float, int]
    ) -> Iterator[Configuration]:
        """Yield what may explain a mask beside others: one outline, two, or three."""
        before, unexplained, room = left
        one = self.sketch_of(mask)
        least = self.sketched(one, beside) - HOPE
        if len(out) > 1:
            if least > before - 2.0 * HOPE:
                yield self.drawn(one, beside, before)
            if unexplained < RECUT:
                return
        pairs = self.parted(mask, beside)
        for worth, pair in pairs:
            if worth > max(least, pairs[0][0] - WORSE):
                yield self.drawn(pair, beside, before)
        if room > 2 and unexplained > THIRD and pairs:
            threes = [three for _, pair in pairs[:2] for three in self.thirds(mask, pair, beside)]
            worth, best = max(threes, key=lambda it: it[0], default=(-math.inf, one))
            if worth > max(least, pairs[0][0] - WORSE):
                yield self.drawn(best, beside, before)

    def thirds(
        self, mask: Mask, pair: Values, beside: JointProblem
    ) -> Iterator[tuple[float, Values]]:
        """Yield three sketches for a mask, from a pair: either one of it parted again."""
        rows, columns = np.nonzero(mask)
        x0, y0, pitch, side = beside.grid[:4]
        x, y = x0 + 0.5 * side + pitch * columns, y0 + 0.5 * side + pitch * rows
        far = np.hypot(x - pair[:, :1], y - pair[:, 1:2]) / np.exp(pair[:, 2:4].mean(1))[:, None]
        for k in range(2):
            half = np.zeros(mask.shape, bool)
            its = far.argmin(axis=0) == k
            half[rows[its], columns[its]] = True
            other = beside._replace(load=beside.load.copy(), share=beside.share.copy())
            lay_sketches.call(other, pair[1 - k : 2 - k])
            for _, two in self.parted(half, other)[:1]:
                three = np.concatenate([two, pair[1 - k : 2 - k]])
                yield self.sketched(three, beside, SKETCHED - 1), three

    def parted(self, mask: Mask, beside: JointProblem) -> list[tuple[float, Values]]:
        """Return pairs of sketches for a mask beside others, the best first, and their worth."""
        if np.count_nonzero(mask) < 2 * LEAST_PIECE:
            return []
        found, logs = np.empty((PAIRS, 2, WIDTH)), np.empty(PAIRS)
        partings.call(beside, across(mask), LEAST_PIECE, found, logs)
        pairs = [
            (log / self.shared + 2 * self.each, pair)
            for log, pair in zip(logs.tolist(), found, strict=True)
            if log > -math.inf
        ]
        return sorted(pairs, key=lambda it: -it[0])

    def sketched(self, points: Values, beside: JointProblem, first: int = 0) -> float:
        """Bring sketches, in place, to their joint mode beside others; return what they add."""
        log = settle_sketches.call(beside, points, first, SKETCHED)
        return log / self.shared + len(points) * self.each

    def sketch_of(self, mask: Mask) -> Values:
        """Return the sketch with a mask's moments, shape (1, 6)."""
        r, c = np.nonzero(mask)
        logs = self.problem.logs[r, c].sum()
        sums = [len(r), c.sum(), r.sum(), (c * c).sum(), (r * c).sum(), (r * r).sum(), logs]
        point = np.zeros((1, WIDTH))
        sketch_of.call(np.array(sums, dtype=np.float64), self.problem.grid, point[0])
        return point

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
            rest, first = self.beside(made, k, before=beside), (made.kinds[k], made.corners[k])
            own = self.settled(made.only(k), rest, 0)[0]
            others = [self.as_kind(kind, own, rest) for kind in self.kinds if kind != first]
            if made.count == 1:
                others += [self.as_kind(kind, begun, rest, 0, TRIES) for kind in self.kinds]
            made = made.with_one(k, max([own, *others], key=lambda it: it.log_evidence))
        return self.settled(made, beside, ROUNDS)[0]

    def guessed(self, point: Values) -> Configuration:
        """Return the outline of a likely kind that has a sketch's moments."""
        x, y, a, b, angle, load = point
        a, b = SKETCH_OVAL * math.exp(a + REST), SKETCH_OVAL * math.exp(b + REST)
        oval = np.array([[x, y, a, b, angle, load - LIGHTER * REST]])
        its = Configuration(np.array([ELLIPSE]), np.array([0]), oval, 0.0)
        likely = (DISC, 0) if min(a, b) > ROUND_FROM * max(a, b) else (RECTANGLE, 0)
        kind = likely if likely in self.kinds else self.kinds[0]
        return Configuration(
            np.array([kind[0]]), np.array([kind[1]]), like(kind, its)[0][None], 0.0
        )

    def owners(self, found: Configuration) -> tuple[Places, Values]:
        """Return which outline, from 0, each touched element belongs to, and what is unexplained.

        -1 where untouched; what outlines that explain an element wholly would add, in nats.
        """
        loads = np.zeros((found.count, *self.on.shape))
        spare = np.zeros(self.on.shape)
        for k in range(found.count):
            add_outline.call(self.problem._replace(load=loads[k], share=spare), found.outlines, k)
        own = np.where(self.on & (loads.max(axis=0) > 0.0), loads.argmax(axis=0), -1)
        for i, j in zip(*np.nonzero(self.on & (own < 0)), strict=True):
            y, x = np.nonzero(own >= 0)
            off = np.maximum(abs(y - i), abs(x - j))
            if len(off) and off.min() <= 2:
                own[i, j] = own[y[off.argmin()], x[off.argmin()]]
        return own, self.unexplained(loads.sum(axis=0))

    def unexplained(self, load: Values) -> Values:
        """Return how much likelier each element's reading would be, were it explained wholly."""
        noise, logs = self.problem.noise, self.problem.logs
        mu = np.log(np.maximum(load, 1e-9))
        half = 0.5 * ((logs - mu) / noise[SIGMA]) ** 2
        odd = np.where(half > ODD, np.minimum(half, on_level.call(noise)), 0.0)
        none = -np.log1p(-(1.0 - noise[VOIDS]) * ndtr((mu - noise[LEAST]) / noise[SIGMA]))
        left: Values = np.where(self.on, odd, none)
        return np.where(self.problem.states == UNKNOWN, 0.0, left)


def dilated(mask: Mask) -> Mask:
    """Return where a mask is, or is next to."""
    out = mask.copy()
    out[1:] |= mask[:-1]
    out[:-1] |= mask[1:]
    wide = out.copy()
    wide[:, 1:] |= out[:, :-1]
    wide[:, :-1] |= out[:, 1:]
    return wide
