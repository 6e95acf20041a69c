"""``Parts``: how the touched elements of a part of a pad come apart into pieces of one outline."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import product
from typing import Any, NamedTuple, TypeAlias

import numpy as np

from tactile_graph_likelihood.geometry.outlines import DISC, ELLIPSE, RECTANGLE, Values
from tactile_graph_likelihood.several.cuts import ANGLES, components, cuts
from tactile_graph_likelihood.several.joint_posterior import JointProblem
from tactile_graph_likelihood.several.maximise_jointly import piece_states
from tactile_graph_likelihood.several.scene import Configuration, Scene, joined, like
from tactile_graph_likelihood.single.element_terms import States
from tactile_graph_likelihood.single.problem import Places

LEAST_PIECE = 4
"""Elements of a piece; fewer join the nearest piece."""

CUTS, FEW = 4, 3
"""Cuts of a piece that are tried, and that are looked at closely."""

NO_GAIN = 20.0
"""How much worse than no cut a cut that is tried may be, by the outlines of the halves' moments."""

ROUND_FROM = 0.75
"""Ratio of a half's axes from which on it is taken to be a disc."""

WORSE = 25.0
"""How much worse than the best cut another one that is tried may be."""

FIRST, SOFT, ROUNDS = 4, 5, 8
"""Rounds in which outlines of moments are brought to their mode: at first, and of those that come
near, in the soft search and after it."""

NEAR, CLOSE = 30.0, 12.0
"""How much less evidence they may have then than what they replace, to be looked at closely, and
for other kinds to be tried."""

SLACK = 0.6
"""How much less evidence for each element two halves may have than the whole, for their own halves
to be tried."""


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


class Halves(NamedTuple):
    """A cut of a piece: the masks of both sides, and outlines of their moments."""

    one: Places
    other: Places
    outlines: Configuration


Divisions: TypeAlias = dict[int, Pieces]
"""By how many pieces there are, those of the most evidence."""


class Parts(Scene):
    """A part of a pad, cut into pieces again and again."""

    def __init__(self, *args: Any) -> None:
        super().__init__(*args)
        rough = [k for k in self.kinds if k[0] in (RECTANGLE, DISC)]
        self.rough = [(RECTANGLE, 0), (DISC, 0)] if len(rough) == 2 else self.kinds
        self.finer = [k for k in self.kinds if k not in self.rough]
        self.known: tuple[dict[bytes, Configuration], ...] = ({}, {})

    def labelled(self, mask: Places) -> States:
        """Return states in which only a mask's elements are on; others unknown nearby, else off."""
        around = np.empty_like(self.problem.states)
        piece_states.call(self.problem.states, mask, 1, around)
        return around

    def single(self, mask: Places, every: bool = False) -> Configuration:
        """Return the outline that explains a mask's elements best by itself, of the rough kinds.

        Or of ``every`` kind.
        """
        known, key = self.known[every], mask.tobytes()
        if key not in known:
            around = self.labelled(mask)
            alone = self.problem._replace(states=around)
            best = self.single(mask) if every else None
            for kind in self.finer if every else self.rough:
                here = self.fitted(kind, around, alone, best)
                if best is None or here.log_evidence > best.log_evidence:
                    best = here
            assert best is not None
            known[key] = best
        return known[key]

    def halves(self, mask: Places, most: int = CUTS) -> list[Halves]:
        """Return the best straight cuts of a piece."""
        if np.count_nonzero(mask) < 2 * LEAST_PIECE:
            return []
        piece = self.problem._replace(states=self.labelled(mask))
        sides = np.zeros((2 * ANGLES, *mask.shape), np.uint8)
        good, whole, points = cuts(piece, LEAST_PIECE, sides)
        out: list[Halves] = []
        least = max(good.max() - WORSE * self.shared, whole - NO_GAIN * self.shared)
        for t in np.argsort(-good, kind="stable"):
            if len(out) == most or good[t] < least:
                break
            a, b = (sides[t] == 1).astype(np.int64), (sides[t] == 2).astype(np.int64)
            if all(min((a != x).sum(), (a != y).sum()) > 2 for x, y, _ in out):
                out.append(Halves(a, b, joined([self.guessed(p) for p in points[t]])))
        return out

    def guessed(self, ellipse: Values) -> Configuration:
        """Return the outline of a likely kind that has an ellipse's moments."""
        its = Configuration(np.array([ELLIPSE]), np.array([0]), ellipse[None], 0.0)
        kind = self.rough[
            int(len(self.rough) == 2 and min(ellipse[2:4]) > ROUND_FROM * max(ellipse[2:4]))
        ]
        return Configuration(np.array([kind[0]]), np.array([kind[1]]), like(kind[0], its), 0.0)

    def best_cut(self, mask: Places, beside: JointProblem, worth: float) -> Halves | None:
        """Return the cut of a mask whose two outlines explain most beside others.

        They are looked at closely only where they come near a worth.
        """
        rough = [
            cut._replace(outlines=self.settled(cut.outlines, beside, FIRST)[0])
            for cut in self.halves(mask)
        ]
        rough.sort(key=lambda cut: -cut.outlines.log_evidence)
        if not rough or self.worth(rough[0].outlines) < worth - NEAR:
            return rough[0] if rough else None
        close = [
            cut._replace(outlines=self.settled(cut.outlines, beside, ROUNDS, SOFT)[0])
            for cut in rough[:FEW]
        ]
        best = max(close, key=lambda cut: cut.outlines.log_evidence)
        if self.worth(best.outlines) < worth - CLOSE:
            return best
        return best._replace(outlines=self.refined(best.outlines, beside))

    def refined(self, found: Configuration, beside: JointProblem) -> Configuration:
        """Return outlines beside others, each of the kind that explains most beside the rest."""
        made = found
        for k in range(found.count):
            rest = self.beside(made, k, before=beside)
            own = self.settled(made.only(k), rest, 0)[0]
            for kind in self.kinds:
                points = like(kind[0], own)
                if kind == (own.kinds[0], own.corners[0]) or not points.any():
                    continue
                other = Configuration(np.array([kind[0]]), np.array([kind[1]]), points, 0.0)
                other = self.settled(other, rest, ROUNDS)[0]
                if other.log_evidence > own.log_evidence:
                    own = other
            made = made.with_one(k, own)
        made = self.settled(made, beside, ROUNDS)[0]
        return made if made.log_evidence > found.log_evidence else found

    def divided(self, mask: Places, room: int) -> Divisions:
        """Return a mask's elements as one piece, and cut in two again and again."""
        alone = self.single(mask)
        found = {1: Pieces([alone], self.worth(alone))}
        if room < 2:
            return found
        here = self.problem._replace(states=self.labelled(mask))
        best = self.best_cut(mask, here, self.worth(alone))
        if best is None:
            return found
        a, b, pair = best
        if self.worth(pair) > self.worth(alone) - CLOSE:
            alone = self.single(mask, every=True)
            found[1] = Pieces([alone], self.worth(alone))
        found[2] = Pieces([pair.only(0), pair.only(1)], self.worth(pair))
        if found[2].worth < found[1].worth - SLACK * np.count_nonzero(mask):
            return found
        one, other = self.single(a), self.single(b)
        fitted = self.settled(joined([one, other]), here, ROUNDS)[0]
        if fitted.log_evidence > pair.log_evidence:
            found[2] = Pieces([fitted.only(0), fitted.only(1)], self.worth(fitted))
        loss = found[2].worth - self.worth(one) - self.worth(other)
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
