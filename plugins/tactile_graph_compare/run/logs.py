"""What is noted frame by frame: of each variant as if alone, and of the merged graph."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from tactile_graph import Result
from tactile_graph.inspect import NO_VALUE, Failed, Plan, Ref, Skipped, gaps, scalars
from tactile_graph.wires.frame import Frame
from tactile_graph_compare.records.comparison import FrameTable
from tactile_graph_compare.records.graph import state_of
from tactile_graph_compare.score.answers import answers_of
from tactile_graph_compare.score.scoring import QuantityErrors, Scorer
from tactile_graph_compare.score.statistics import frozen
from tactile_graph_compare.variants.merge import Member
from tactile_graph_compare.variants.prepare import PreparedVariant

MOST_PLACEMENTS = 16
"""Of a part of the frames, beyond which it matters no more how many there are."""


class Noted(NamedTuple):
    """What was noted of a variant, as it travels between processes."""

    states: list[bytes]
    times_us: list[float]
    n_by_state: tuple[int, int, int]
    reasons: dict[tuple[str, str, str], list[Any]]
    errors: dict[str, QuantityErrors]


class VariantLog:
    """What one variant came to so far.

    Attributes
    ----------
    nodes : tuple of str
        Those its outputs need, in the order of its file.
    states : list of bytes
        For each frame, a code for each node, as in `records.graph.STATES`.
    times_us : list of float
        Time of each frame; NaN where it was reused, or something was made that is made once.
    last : Result
        Of the last frame, as the variant alone would have given it.
    """

    def __init__(self, prepared: PreparedVariant, member: Member) -> None:
        self.prepared = prepared
        self.member = member
        self.nodes = tuple(i.name for i in member.plan.nodes)
        self._refs = [Ref(name) for name in self.nodes]
        self.last: Result
        self.scorer = Scorer(answers_of(prepared.pipeline, prepared.asked))
        self.states: list[bytes] = []
        self.times_us: list[float] = []
        self.n_ok = self.n_skipped = self.n_failed = 0
        self.reasons: dict[tuple[str, str, str], list[Any]] = {}

    def add(self, position: int, result: Result, timed: bool = True) -> dict[str, float]:
        """Note a frame, and its time if that is its own; return its worst errors by quantity."""
        alone = self.last = self.member.alone(result)
        self.states.append(bytes([state_of(alone.outcome_at(ref)) for ref in self._refs]))
        spent = sum(alone.times_us.values())
        self.times_us.append(math.nan if result.reused or not timed else spent)
        self._count(alone)
        return self.scorer.add(position, result.frame, alone.outcome_at)

    def noted(self) -> Noted:
        """Return what was noted so far."""
        n = (self.n_ok, self.n_skipped, self.n_failed)
        return Noted(self.states, self.times_us, n, self.reasons, dict(self.scorer.errors))

    def join(self, later: Noted) -> None:
        """Note what was noted elsewhere of the frames that come next."""
        self.scorer.join(later.errors, len(self.states))
        self.states += later.states
        self.times_us += later.times_us
        self.n_ok += later.n_by_state[0]
        self.n_skipped += later.n_by_state[1]
        self.n_failed += later.n_by_state[2]
        for key, (text, n) in later.reasons.items():
            self.reasons.setdefault(key, [text, 0])[1] += n

    def _count(self, alone: Result) -> None:
        refs = self.member.asked
        outcomes = {
            name: alone.outcome_at(r) for name, r in zip(self.prepared.asked, refs, strict=True)
        }
        lacking: dict[str, list[Skipped | Failed]] = {
            name: [outcome] if isinstance(outcome, Skipped | Failed) else gaps(outcome)
            for name, outcome in outcomes.items()
        }
        kinds = {outcome.__class__ for found in lacking.values() for outcome in found}
        self.n_failed += Failed in kinds
        self.n_skipped += Skipped in kinds and Failed not in kinds
        strange = [*self._strange(outcomes)]
        self.n_ok += not kinds and not strange
        for name, key, number in strange:
            told = [f"{number}, which is no answer", 0]
            self.reasons.setdefault(("strange", name, key), told)[1] += 1
        for name, found in lacking.items():
            # Several items of one frame that lack for one reason count as one.
            for outcome in {(o.__class__, o.origin): o for o in reversed(found)}.values():
                word = "failed" if outcome.__class__ is Failed else "skipped"
                first = [outcome.reason.partition("\n")[0], 0]
                self.reasons.setdefault((word, name, outcome.origin), first)[1] += 1

    def _strange(self, outcomes: Mapping[str, Any]) -> Iterator[tuple[str, str, float]]:
        """Yield each number of an output that is not finite: the output, its name, the number."""
        for name, outcome in outcomes.items():
            if outcome.__class__ in NO_VALUE:
                continue
            try:
                told = scalars(name, outcome)
            except Exception:  # a plugin's own code, of which nothing is compared
                continue
            for key, number in told.items():
                if isinstance(number, float) and not math.isfinite(number):
                    yield name, key, number


class MergedLog:
    """What the merged graph came to so far, and in which frames.

    Attributes
    ----------
    nodes : tuple of str
        The merged nodes, each after those it reads.
    fixed_us : list of float
        Time of each frame outside the nodes; NaN where it was reused, or is not its own.
    """

    def __init__(self, plan: Plan) -> None:
        self.nodes = tuple(item.name for item in plan.nodes)
        self.fixed_us: list[float] = []
        self._times_us: list[list[float]] = []
        self._states: list[bytes] = []
        self._frames: list[tuple[int, float, str, int, bool]] = []
        self._placements: list[str] = []
        self._seen: set[str] = set()

    @property
    def n(self) -> int:
        """Frames so far."""
        return len(self._frames)

    @property
    def n_placements(self) -> int:
        """How many ways in which objects truly lay there are different."""
        return len(set(self._placements))

    def add(self, frame: Frame, result: Result, whole_us: float) -> None:
        """Note a frame that took so long as a whole; NaN where that was not its own."""
        by_node, timed = result.times_us, not math.isnan(whole_us)
        times = [by_node[n] if timed else math.nan for n in self.nodes]
        self._times_us.append(times)
        self._states.append(bytes([state_of(result.outcome(n)) for n in self.nodes]))
        self.fixed_us.append(math.nan if result.reused else whole_us - sum(times))
        time_s = math.nan if frame.time_s is None else frame.time_s
        n_true = -1 if frame.truth is None else len(frame.truth)
        self._frames.append((frame.index, time_s, frame.label, n_true, result.reused))
        if frame.truth and len(self._seen) < MOST_PLACEMENTS:
            placement = repr(frame.truth)
            if placement not in self._seen:
                self._seen.add(placement)
                self._placements.append(placement)

    def noted(self) -> tuple[list[Any], ...]:
        """Return what was noted so far, as it travels between processes."""
        return self.fixed_us, self._times_us, self._states, self._frames, self._placements

    def join(self, later: tuple[list[Any], ...]) -> None:
        """Note what was noted elsewhere of the frames that come next."""
        for mine, its in zip(self.noted(), later, strict=True):
            mine += its

    def times_us(self) -> NDArray[np.float64]:
        """Return the time of each node in each frame, shape (n_frames, n_nodes); NaN as above."""
        return np.array(self._times_us).reshape(self.n, len(self.nodes))

    def states(self) -> NDArray[np.uint8]:
        """Return the code of each node in each frame, shape (n_frames, n_nodes)."""
        codes = np.frombuffer(b"".join(self._states), dtype=np.uint8)
        return codes.reshape(self.n, len(self.nodes))

    def frames(self) -> FrameTable:
        """Return the frames."""
        columns = zip(*self._frames, strict=True) if self._frames else [()] * 5
        indices, times_s, labels, n_true, reused = columns
        return FrameTable(
            frozen(indices, np.int64),
            frozen(times_s),
            labels,
            frozen(n_true, np.int64),
            frozen(reused, np.bool_),
        )
