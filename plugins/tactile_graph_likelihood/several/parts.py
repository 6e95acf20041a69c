"""``Parts``: how the touched elements of a part of a pad come apart into pieces of one outline."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import product
from typing import Any, TypeAlias

import numpy as np

from tactile_graph_likelihood.geometry.outlines import DISC, RECTANGLE
from tactile_graph_likelihood.several.cuts import ANGLES, components, cuts
from tactile_graph_likelihood.several.maximise_jointly import piece_states
from tactile_graph_likelihood.several.scene import Configuration, Scene, joined
from tactile_graph_likelihood.single.element_terms import States
from tactile_graph_likelihood.single.problem import Places

LEAST_PIECE = 4
"""Elements of a piece; fewer join the nearest piece."""

CUTS = 3
"""Cuts of a piece that are tried."""

NO_GAIN = 10.0
"""How much worse than no cut a cut that is tried may be, by the outlines of the halves' moments."""

WORSE = 12.0
"""How much worse than the best cut another one that is tried may be."""

PAIR_ROUNDS = 6
"""Rounds in which two halves are brought to their joint mode."""

SLACK = 8.0
"""How much less evidence two halves may have than the whole, for their own halves to be tried."""


@dataclass(frozen=True, eq=False)
class Pieces:
    """Touched elements in pieces that one outline each explains.

    Parameters
    ----------
    outlines : list of Configuration
        One for each piece.
    worth : float
        What they add to the log probability of the scene, by themselves.
    """

    outlines: list[Configuration]
    worth: float


Divisions: TypeAlias = dict[int, Pieces]
"""By how many pieces there are, those of the most evidence."""


class Parts(Scene):
    """A part of a pad, cut into pieces again and again."""

    def __init__(self, *args: Any) -> None:
        super().__init__(*args)
        rough = [k for k in self.kinds if k[0] in (RECTANGLE, DISC)]
        self.rough = rough[::-1] if len(rough) == 2 else self.kinds
        self.known: dict[bytes, Configuration] = {}

    def labelled(self, mask: Places) -> States:
        """Return states in which only a mask's elements are on; others unknown nearby, else off."""
        around = np.empty_like(self.problem.states)
        piece_states.call(self.problem.states, mask, 1, around)
        return around

    def single(self, mask: Places) -> Configuration:
        """Return the outline that explains a mask's elements best, by itself."""
        key = mask.tobytes()
        if key not in self.known:
            around = self.labelled(mask)
            alone = self.problem._replace(states=around)
            best = None
            for kind in self.rough:
                here = self.fitted(kind, around, alone, best)
                if best is None or here.log_evidence > best.log_evidence:
                    best = here
            assert best is not None
            self.known[key] = best
        return self.known[key]

    def halves(self, mask: Places, most: int = CUTS) -> list[tuple[Places, Places]]:
        """Return the best straight cuts of a piece, each as two masks."""
        if np.count_nonzero(mask) < 2 * LEAST_PIECE:
            return []
        piece = self.problem._replace(states=self.labelled(mask))
        sides = np.zeros((2 * ANGLES, *mask.shape), np.uint8)
        good, whole = cuts(piece, LEAST_PIECE, sides)
        out: list[tuple[Places, Places]] = []
        least = max(good.max() - WORSE * self.shared, whole - NO_GAIN * self.shared)
        for t in np.argsort(-good, kind="stable"):
            if len(out) == most or good[t] < least:
                break
            a, b = (sides[t] == 1).astype(np.int64), (sides[t] == 2).astype(np.int64)
            if all(min((a != x).sum(), (a != y).sum()) > 2 for x, y in out):
                out.append((a, b))
        return out

    def divided(self, mask: Places, room: int) -> Divisions:
        """Return a mask's elements as one piece, and cut in two again and again."""
        alone = self.single(mask)
        found = {1: Pieces([alone], self.worth(alone))}
        if room < 2:
            return found
        here, best = self.problem._replace(states=self.labelled(mask)), None
        for a, b in self.halves(mask):
            pair = self.settled(joined([self.single(a), self.single(b)]), here, PAIR_ROUNDS)[0]
            if best is None or pair.log_evidence > best[0].log_evidence:
                best = pair, a, b
        if best is None:
            return found
        pair, a, b = best
        found[2] = Pieces([pair.only(0), pair.only(1)], self.worth(pair))
        if found[2].worth < found[1].worth - SLACK:
            return found
        loss = found[2].worth - self.worth(self.single(a)) - self.worth(self.single(b))
        more = combined(self.divided(a, room - 1), self.divided(b, room - 1), room, min(loss, 0.0))
        return more | found

    def start(self, room: int) -> Divisions:
        """Return all touched elements in pieces: what nothing connects, and cut further."""
        labels = components.call(self.on, 1)
        sizes = np.bincount(labels.ravel())[1:]
        large = [k + 1 for k in np.argsort(-sizes, kind="stable") if sizes[k] >= LEAST_PIECE]
        large = large[:room] or [int(np.argmax(sizes)) + 1]
        for k in range(1, len(sizes) + 1):
            if k not in large:
                labels[labels == k] = nearest(labels, k, large)
        found = {0: Pieces([], 0.0)}
        for k in large:
            mask = (labels == k).astype(np.int64)
            found = combined(found, self.divided(mask, room - len(large) + 1), room)
        return found


def combined(one: Divisions, other: Divisions, most: int, loss: float = 0.0) -> Divisions:
    """Return the best divisions of two masks together, by their number of pieces.

    ``loss`` is what they add less together than each by itself.
    """
    found: Divisions = {}
    for (i, some), (k, more) in product(one.items(), other.items()):
        worth = some.worth + more.worth + loss
        if i + k <= most and (i + k not in found or worth > found[i + k].worth):
            found[i + k] = Pieces([*some.outlines, *more.outlines], worth)
    return found


def nearest(labels: Places, lost: int, large: list[int]) -> int:
    """Return the label, of some, whose elements lie nearest; 0 if none is within two cells."""
    here = np.argwhere(labels == lost)
    far, best = min(
        (int(abs(np.argwhere(labels == k)[:, None] - here[None]).max(-1).min()), k) for k in large
    )
    return best if far <= 2 else 0
