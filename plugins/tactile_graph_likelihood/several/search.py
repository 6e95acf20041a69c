"""How many outlines lie on a pad, of which kinds, and where: a search for the most evidence."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import Any

import numpy as np

from tactile_graph.errors import Degenerate
from tactile_graph_likelihood.several.joint_posterior import JointProblem, add_outline
from tactile_graph_likelihood.several.parts import SPARE, Parts
from tactile_graph_likelihood.several.scene import Configuration, joined
from tactile_graph_likelihood.single.element_terms import States
from tactile_graph_likelihood.single.problem import Places

NEARLY = 12.0
"""How much less evidence a move may bring at first, for all outlines to settle beside it."""


class Search(Parts):
    """Moves from one set of outlines to another of more evidence, until none is found."""

    def __init__(self, *args: Any, **kwargs: Any) -> None:
        super().__init__(*args, **kwargs)
        self.done: set[tuple[str, bytes]] = set()
        self.best: dict[int, Configuration] = {}

    def run(self, start: Configuration | None = None) -> Configuration:
        """Return the outlines with the most evidence that the search comes upon.

        Parameters
        ----------
        start : Configuration, optional
            Where it may begin, too.

        Raises
        ------
        Degenerate
            If no outlines, as many as are allowed, explain the image.
        """
        found = self.corrected(self.from_pieces())
        self.note(found)
        if start is not None and start.count <= self.most + SPARE:
            other = self.corrected(self.maximised(start))
            self.note(other)
            found = max(found, other, key=lambda f: f.log_evidence)
        self.improved(found)
        if not self.allowed():
            self.note(self.corrected(self.from_pieces(0)))
        allowed = self.allowed()
        if not allowed:
            raise Degenerate(f"no {self.most} objects or fewer explain what is touched")
        return max(allowed, key=lambda f: f.log_evidence)

    def allowed(self) -> list[Configuration]:
        """Return the best outlines of each number that is allowed."""
        return [f for n, f in self.best.items() if n <= self.most and f.log_evidence > -math.inf]

    def improved(self, found: Configuration) -> Configuration:
        """Return what moves make of outlines, until none gains."""
        better = True
        while better:
            better = False
            for out, new in self.moves(found):
                if new.log_evidence == -math.inf:
                    continue
                made = self.replaced(found, out, new)
                if made.log_evidence > found.log_evidence + 0.1:
                    found, better = made, True
                    break
        return found

    def moves(self, found: Configuration) -> Iterator[tuple[tuple[int, ...], Configuration]]:
        """Yield what might be better: other outlines in the place of one or two."""
        own = self.owners(found)
        masks = [(own == k).astype(np.int64) for k in range(found.count)]
        for a in range(found.count):
            yield from self.moves_of_one(found, a, masks[a])
        for a in range(found.count):
            near, far = dilated(masks[a], 1), dilated(masks[a], 2)
            for b in range(a):
                if (far & (masks[b] == 1)).any():
                    touching = bool((near & (masks[b] == 1)).any())
                    yield from self.moves_of_two(found, a, b, masks[a] + masks[b], touching)

    def moves_of_one(
        self, found: Configuration, a: int, mask: Places
    ) -> Iterator[tuple[tuple[int, ...], Configuration]]:
        """Yield nothing, another kind, and two outlines in the place of one."""
        room = found.count < self.most + SPARE
        if not self.fresh(f"one, {room}", mask):
            return
        if found.count > 1:
            yield (a,), Configuration(found.kinds[:0], found.corners[:0], found.points[:0], 0.0)
        beside = self.beside(found, (a,))
        alone = self.refit(mask, beside, self.kinds, int(found.kinds[a]))
        if alone is not None:
            yield (a,), alone
        if room:
            worth = self.weighed(found.only(a).outlines, beside).log_evidence
            two = self.paired(mask, beside, worth)
            if two is not None:
                yield (a,), two[0]

    def moves_of_two(
        self, found: Configuration, a: int, b: int, mask: Places, touching: bool
    ) -> Iterator[tuple[tuple[int, ...], Configuration]]:
        """Yield one outline in the place of two, and two that share their elements otherwise."""
        if not self.fresh("two", mask):
            return
        beside = self.beside(found, (a, b))
        one = self.refit(mask, beside, self.kinds if touching else self.rough)
        if one is not None:
            yield (a, b), one
        if touching:
            both = joined([found.only(a), found.only(b)])
            two = self.paired(mask, beside, self.weighed(both.outlines, beside).log_evidence)
            if two is not None:
                yield (a, b), two[0]

    def refit(
        self, mask: Places, beside: JointProblem, kinds: list[tuple[int, int]], known: int = -1
    ) -> Configuration | None:
        """Return the best kind of outline for a mask beside others, but for a known kind."""
        piece = self.labelled(mask)
        fits = [self.one(k, n, piece, beside) for k, n in kinds if k != known]
        return max(fits, key=lambda f: f.log_evidence, default=None)

    def fresh(self, what: str, mask: Places) -> bool:
        """Return whether a move has not been tried on a mask yet; from now on it has."""
        key = (what, mask.tobytes())
        known = key in self.done
        self.done.add(key)
        return not known and bool((mask == 1).any())

    def replaced(
        self, found: Configuration, out: tuple[int, ...], new: Configuration
    ) -> Configuration:
        """Return outlines with some put in the place of others, brought to their top."""
        keep = [k for k in range(found.count) if k not in out]
        rest = Configuration(found.kinds[keep], found.corners[keep], found.points[keep], 0.0)
        both = joined([rest, new])
        made = self.weighed(both.outlines)
        if made.log_evidence < found.log_evidence - NEARLY:
            return made
        made = self.corrected(self.maximised(made, enough=0.3))
        self.note(made)
        return made

    def note(self, found: Configuration) -> None:
        """Keep the outlines with the most evidence of each number of them."""
        best = self.best.get(found.count)
        if best is None or found.log_evidence > best.log_evidence:
            self.best[found.count] = found

    def owners(self, found: Configuration) -> Places:
        """Return which outline, from 0, each touched element belongs to; -1 where untouched."""
        loads = np.zeros((found.count, *self.on.shape))
        spare = np.zeros(self.on.shape)
        for k in range(found.count):
            bare = self.problem._replace(load=loads[k], share=spare)
            add_outline.call(bare, found.outlines, k)
        own = loads.argmax(axis=0)
        none = (loads.max(axis=0) <= 0.0) & self.on
        for i, j in zip(*np.nonzero(none), strict=True):
            y, x = np.nonzero((loads.max(axis=0) > 0.0) & self.on)
            if len(y):
                off = np.maximum(abs(y - i), abs(x - j))
                at = np.argmin(off)
                own[i, j] = own[y[at], x[at]] if off[at] <= 2 else -1
        return np.where(self.on, own, -1)


def dilated(mask: Places, reach: int) -> States:
    """Return where a mask is, or is no more than some cells away."""
    wide = np.pad(mask == 1, reach)
    rows, cols = mask.shape
    out = np.zeros(mask.shape, bool)
    for i in range(2 * reach + 1):
        for j in range(2 * reach + 1):
            out |= wide[i : i + rows, j : j + cols]
    return out
