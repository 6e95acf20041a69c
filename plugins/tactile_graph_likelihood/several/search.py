"""How many outlines lie on a part of a pad, and which elements are whose."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import Any

import numpy as np

from tactile_graph_likelihood.several.joint_posterior import JointProblem, add_outline
from tactile_graph_likelihood.several.parts import ROUNDS, Divisions, Parts
from tactile_graph_likelihood.several.scene import Configuration, joined
from tactile_graph_likelihood.single.element_terms import States
from tactile_graph_likelihood.single.problem import Places

NEARLY = 3.0
"""How much less evidence a move may bring at first, for all outlines to settle beside it."""

SAME = 2
"""Elements by which masks differ that are the same for a move."""

GAIN = 0.1
"""Evidence that a move must bring."""

Place = tuple[tuple[int, ...], Places]
"""Numbers of outlines, and the mask of their elements."""


class Search(Parts):
    """Outlines on a part of a pad, improved by moves until none gains."""

    def __init__(self, *args: Any) -> None:
        super().__init__(*args)
        self.seen: dict[int, list[Places]] = {1: [], 2: []}
        self.best: dict[int, Configuration] = {}
        self.every: list[Configuration] = []
        self.worths: dict[int, float] = {}

    def divisions(self, room: int, begin: Configuration | None = None) -> dict[int, Configuration]:
        """Return the best outlines of each number that the search comes upon.

        It may begin with some outlines, too.
        """
        start = self.start(room)
        for n, pieces in start.items():
            self.weighed(n, pieces.worth)
        likely = max(start, key=lambda n: start[n].worth + math.lgamma(n + 1.0))
        found = self.noted(joined(start[likely].outlines))
        if found.count > 1:
            found = self.noted(self.refined(found, self.problem))
        if begin is not None:
            found = max(found, self.noted(begin), key=self.rank)
        better: Configuration | None = found
        while better is not None:
            found, better = better, self.improved(better, room)
        return self.best

    def divided(self, mask: Places, room: int) -> Divisions:
        """Return a mask's elements cut in two again and again, which is not tried again."""
        self.seen[1].append(mask)
        return super().divided(mask, room)

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

    def improved(self, found: Configuration, room: int) -> Configuration | None:
        """Return better outlines, None if no move makes any."""
        for out, mask in self.places(found, room):
            beside = self.beside(found, *out)
            now = joined([found.only(k) for k in out])
            before = self.worth(self.settled(now, beside, 0)[0])
            for new in self.instead(out, mask, beside, before):
                gain = self.worth(new) - before
                self.weighed(found.count - len(out) + new.count, self.worth(found) + gain)
                if gain < -NEARLY:
                    continue
                made = self.noted(joined([found.without(*out), new]))
                if self.rank(made) > self.rank(found) + GAIN:
                    return made
        return None

    def places(self, found: Configuration, room: int) -> Iterator[Place]:
        """Yield one or two outlines that may be others, and which elements are theirs."""
        own = self.owners(found)
        masks = [(own == k).astype(np.int64) for k in range(found.count)]
        for a in range(found.count):
            far = dilated(masks[a], 2)
            for b in range(a):
                if (far & (masks[b] == 1)).any() and self.fresh(2, masks[a] + masks[b]):
                    yield (a, b), masks[a] + masks[b]
        for a in range(found.count if found.count < room else 0):
            if self.fresh(1, masks[a]):
                yield (a,), masks[a]

    def instead(
        self, out: tuple[int, ...], mask: Places, beside: JointProblem, worth: float
    ) -> Iterator[Configuration]:
        """Yield what may explain a mask beside others: one outline, and two."""
        if len(out) > 1:
            yield self.settled(self.single(mask, every=True), beside, ROUNDS)[0]
        if (cut := self.best_cut(mask, beside, worth)) is not None:
            yield cut.outlines

    def fresh(self, count: int, mask: Places) -> bool:
        """Return whether a move has not been tried on about this mask yet; from now on it has."""
        tried = self.seen[count]
        if not mask.any() or any(np.count_nonzero(mask != it) <= SAME for it in tried):
            return False
        tried.append(mask)
        return True

    def owners(self, found: Configuration) -> Places:
        """Return which outline, from 0, each touched element belongs to; -1 where untouched."""
        loads = np.zeros((found.count, *self.on.shape))
        spare = np.zeros(self.on.shape)
        for k in range(found.count):
            bare = self.problem._replace(load=loads[k], share=spare)
            add_outline.call(bare, found.outlines, k)
        own = np.where(self.on & (loads.max(axis=0) > 0.0), loads.argmax(axis=0), -1)
        for i, j in zip(*np.nonzero(self.on & (own < 0)), strict=True):
            y, x = np.nonzero(own >= 0)
            off = np.maximum(abs(y - i), abs(x - j))
            if len(off) and off.min() <= 2:
                own[i, j] = own[y[off.argmin()], x[off.argmin()]]
        return own


def dilated(mask: Places, reach: int) -> States:
    """Return where a mask is, or is no more than some cells away."""
    wide = np.pad(mask == 1, reach)
    rows, cols = mask.shape
    out = np.zeros(mask.shape, bool)
    for i in range(2 * reach + 1):
        for j in range(2 * reach + 1):
            out |= wide[i : i + rows, j : j + cols]
    return out
