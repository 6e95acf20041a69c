"""Which variants are held against which, and what came of it frame by frame."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from itertools import combinations

from tactile_graph.wires.frame import Frame
from tactile_graph_compare.records.scores import Agreement
from tactile_graph_compare.run.logs import VariantLog
from tactile_graph_compare.score.agreement import Agreeing, Differences, found_in
from tactile_graph_compare.score.quantities import in_order

MOST_CROSSED = 4
"""Variants up to which each is held against each; beyond, all against the first."""


class AgreementLog:
    """How far the variants lie from one another so far.

    Parameters
    ----------
    logs : sequence of VariantLog
    reference : str
        Label of the variant that all others are held against, in every frame. Without it each is
        held against each (against the first, where there are more than `MOST_CROSSED`), in the
        frames of which nobody knows what lay there.
    """

    def __init__(self, logs: Sequence[VariantLog], reference: str = "") -> None:
        self._logs = {log.prepared.label: log for log in logs}
        self._every_frame = bool(reference)
        self._pairs = [self._pair(*pair) for pair in _pairs([*self._logs], reference)]

    def _pair(self, variant: str, reference: str) -> Agreeing:
        mine, theirs = (self._logs[x].scorer.answers for x in (variant, reference))
        both = in_order(q for q in mine.quantities if q in theirs.quantities)
        return Agreeing(variant, reference, {q: mine.units[q] for q in both})

    def add(self, position: int, frame: Frame) -> dict[tuple[str, str], dict[str, float]]:
        """Note a frame; return by pair and quantity how far they lie apart in it, at most."""
        if frame.truth is not None and not self._every_frame:
            return {}
        found = {
            label: found_in(log.scorer.answers, log.last.outcome_at)
            for label, log in self._logs.items()
        }
        return {
            (pair.variant, pair.reference): pair.add(
                position, found[pair.variant], found[pair.reference]
            )
            for pair in self._pairs
        }

    def noted(self) -> list[dict[str, Differences]]:
        """Return for each pair what was noted so far, as it travels between processes."""
        return [pair.differences for pair in self._pairs]

    def join(self, later: Sequence[Mapping[str, Differences]], start: int) -> None:
        """Note what was noted elsewhere of later frames, positions counted from ``start``."""
        for pair, its in zip(self._pairs, later, strict=True):
            for quantity, differences in its.items():
                pair.differences[quantity].join(differences, start)

    def agreements(self) -> tuple[Agreement, ...]:
        """Return what was found out, a record for each pair and quantity."""
        return tuple(a for pair in self._pairs for a in pair.agreements())


def _pairs(labels: Sequence[str], reference: str) -> Iterator[tuple[str, str]]:
    """Yield (variant, reference)."""
    if not reference and len(labels) <= MOST_CROSSED:
        yield from ((b, a) for a, b in combinations(labels, 2))
        return
    first = reference or labels[0]
    yield from ((label, first) for label in labels if label != first)
