"""``Parts``: outlines for the pieces of a footprint, cut in two again and again."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from tactile_graph_likelihood.geometry.outlines import ELLIPSE, RECTANGLE
from tactile_graph_likelihood.several.cuts import ANGLES, components, cuts
from tactile_graph_likelihood.several.joint_posterior import JointProblem
from tactile_graph_likelihood.several.maximise_jointly import piece_states
from tactile_graph_likelihood.several.scene import Configuration, Scene, joined
from tactile_graph_likelihood.single.element_terms import States
from tactile_graph_likelihood.single.problem import Places

LEAST_PIECE = 4
"""Elements of a piece; fewer join the nearest piece."""

SPARE = 1
"""Outlines that the search may use beyond the most that are allowed in the end."""

CUTS = 5
"""Cuts of a piece that are tried."""

NO_GAIN = 25.0
"""How much worse than no cut a cut that is tried may be."""

WORSE = 30.0
"""How much worse than the best cut another one that is tried may be."""

CLOSE = 15.0
"""How much less evidence two halves may have than the whole, to be looked at closely."""

SLACK = 25.0
"""How much less evidence two halves may have than the whole, for their own halves to be tried."""


class Parts(Scene):
    """A scene, and how its touched elements come apart into pieces of one outline each."""

    def __init__(self, *args: Any, **kwargs: Any) -> None:
        super().__init__(*args, **kwargs)
        two = [k for k in self.kinds if k[0] in (ELLIPSE, RECTANGLE)]
        self.rough = two if len(two) == 2 else self.kinds
        self.kept: dict[bytes, Configuration] = {}

    def labelled(self, mask: Places) -> States:
        """Return states in which only a mask's elements are on; others unknown nearby, else off."""
        around = np.empty_like(self.problem.states)
        piece_states.call(self.problem.states, mask, 1, around)
        return around

    def single(self, mask: Places) -> Configuration:
        """Return the outline with the most evidence that explains a piece by itself."""
        key = mask.tobytes()
        if key in self.kept:
            return self.kept[key]
        piece = self.labelled(mask)
        alone = self.problem._replace(states=piece)
        best = None
        for kind, corners in self.rough:
            here = self.one(kind, corners, piece, alone)
            if best is None or here.log_evidence > best.log_evidence:
                best = here
        assert best is not None
        self.kept[key] = best
        return best

    def halves(self, mask: Places, most: int = CUTS) -> list[tuple[Places, Places]]:
        """Return the best straight cuts of a piece, each as two masks."""
        if (mask == 1).sum() < 2 * LEAST_PIECE:
            return []
        piece = self.problem._replace(states=self.labelled(mask))
        sides = np.zeros((2 * ANGLES, *mask.shape), np.uint8)
        good, whole = cuts(piece, LEAST_PIECE, sides)
        out: list[tuple[Places, Places]] = []
        least = max(good.max() - WORSE, whole - NO_GAIN)
        for t in np.argsort(-good, kind="stable"):
            if len(out) == most or good[t] < least:
                break
            a, b = (sides[t] == 1).astype(np.int64), (sides[t] == 2).astype(np.int64)
            if all(min((a != x).sum(), (a != y).sum()) > 2 for x, y in out):
                out.append((a, b))
        return out

    def paired(
        self, mask: Places, beside: JointProblem, worth: float
    ) -> tuple[Configuration, Places, Places] | None:
        """Return the best two outlines, either side of a straight cut, that explain a piece.

        They are looked at closely only if their evidence comes near ``worth``.
        """
        tried = []
        for a, b in self.halves(mask):
            tried.append((self.settled(joined([self.single(a), self.single(b)]), beside), a, b))
        tried.sort(key=lambda t: -t[0].log_evidence)
        best = None
        for pair, a, b in tried[:2]:
            if pair.log_evidence < max(worth, tried[0][0].log_evidence) - CLOSE:
                continue
            refined = self.refined(pair, (a, b), beside)
            if best is None or refined.log_evidence > best[0].log_evidence:
                best = refined, a, b
        return best or (tried[0] if tried else None)

    def refined(
        self, pair: Configuration, masks: tuple[Places, Places], beside: JointProblem
    ) -> Configuration:
        """Return two outlines, each replaced by the best kind beside the other."""
        for k in (0, 1):
            beside_both = self.beside(pair, (k,), beside)
            piece = self.labelled(masks[k])
            for kind, corners in self.kinds:
                if kind == pair.kinds[k] and kind in (ELLIPSE, RECTANGLE):
                    continue
                other = self.one(kind, corners, piece, beside_both)
                if other.log_evidence == -math.inf:
                    continue
                two = [other, pair.only(1 - k)]
                made = self.settled(joined(two if k == 0 else two[::-1]), beside)
                if made.log_evidence > pair.log_evidence:
                    pair = made
        return pair

    def outlines_of(self, mask: Places, room: int) -> Configuration:
        """Return the outlines that explain a piece best, cut in two again and again."""
        alone = self.single(mask)
        if room < 2:
            return alone
        beside = self.problem._replace(states=self.labelled(mask))
        best = self.paired(mask, beside, alone.log_evidence)
        if best is None or best[0].log_evidence < alone.log_evidence - SLACK:
            return alone
        pair, a, b = best
        first = self.outlines_of(a, room - 1)
        second = self.outlines_of(b, room - first.count)
        if first.count + second.count > 2:
            more = self.settled(joined([first, second]), beside)
            if more.log_evidence > pair.log_evidence:
                pair = more
        return pair if pair.log_evidence > alone.log_evidence else alone

    def from_pieces(self, spare: int = SPARE) -> Configuration:
        """Return the outlines of all pieces that nothing connects, brought to their joint mode."""
        labels = components.call(self.on, 1)
        sizes = np.bincount(labels.ravel())[1:]
        large = [k + 1 for k in np.argsort(-sizes, kind="stable") if sizes[k] >= LEAST_PIECE]
        large = large[: self.most + spare] or [int(np.argmax(sizes)) + 1]
        for k in range(1, len(sizes) + 1):
            if k not in large:
                labels[labels == k] = nearest(labels, k, large)
        room = self.most + spare - len(large)
        parts = []
        for k in large:
            parts.append(self.outlines_of((labels == k).astype(np.int64), 1 + room))
            room -= parts[-1].count - 1
        return self.maximised(joined(parts))


def nearest(labels: Places, lost: int, large: list[int]) -> int:
    """Return the label, of some, whose elements lie nearest; 0 if none is within two cells."""
    here = np.argwhere(labels == lost)
    far, best = min(
        (int(abs(np.argwhere(labels == k)[:, None] - here[None]).max(-1).min()), k) for k in large
    )
    return best if far <= 2 else 0
