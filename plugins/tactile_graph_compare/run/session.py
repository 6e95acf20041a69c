"""Run the merged graph frame by frame, and note what each variant alone would have given."""

from __future__ import annotations

import math
import time
from collections.abc import Sequence
from typing import Any

import numpy as np

from tactile_graph.api.result import Result
from tactile_graph.engine.outcome import NO_VALUE, Failed, Skipped
from tactile_graph.engine.runner import Runner, check_frame
from tactile_graph.wires.frame import Frame
from tactile_graph_compare.run.frame_choice import Keeper
from tactile_graph_compare.run.run_orders import orders
from tactile_graph_compare.run.variant_result import OwnResult
from tactile_graph_compare.score.answers import answers_of
from tactile_graph_compare.score.scoring import Scorer
from tactile_graph_compare.variants.merge import Member, merge
from tactile_graph_compare.variants.variants import Prepared

WARM_FRAMES = 8
WARM_S = 1.0
MOST_TURNS = 8
"""Orders in which the variants run, at most."""


class VariantLog:
    """What one variant came to so far.

    Attributes
    ----------
    nodes : tuple of str
        Those its outputs need, in the order of its file.
    states : list of bytes
        For each frame, a code for each node, as `graph_records.STATES`.
    times_us : list of float
        Time of each frame; NaN where it was reused.
    """

    def __init__(self, prepared: Prepared, member: Member) -> None:
        self.prepared = prepared
        self.member = member
        self.nodes = tuple(i.name for i in member.plan.nodes)
        self.scorer = Scorer(answers_of(prepared.pipeline, prepared.asked))
        self.states: list[bytes] = []
        self.times_us: list[float] = []
        self.n_ok = self.n_skipped = self.n_failed = 0
        self.reasons: dict[tuple[str, str, str], list[Any]] = {}
        self._merged = [member.names[n] for n in self.nodes]

    def add(self, position: int, result: Result, times_us: dict[str, float]) -> dict[str, float]:
        """Note a frame; return its worst error of each quantity."""
        own = OwnResult(result, self.member)
        codes = own.states()
        self.states.append(bytes([codes.get(n, 0) for n in self.nodes]))
        spent = sum(
            times_us[m] for n, m in zip(self.nodes, self._merged, strict=True) if n in codes
        )
        self.times_us.append(math.nan if result.reused else spent)
        self._count(own)
        return self.scorer.add(position, result.frame, own.merged_outcome)

    def _count(self, own: OwnResult) -> None:
        refs = self.member.asked
        kinds = {own.merged_outcome(r).__class__ for r in refs}
        self.n_failed += Failed in kinds
        self.n_skipped += Skipped in kinds and Failed not in kinds
        self.n_ok += not kinds & NO_VALUE
        if not kinds & NO_VALUE:
            return
        for name, ref in zip(self.prepared.asked, refs, strict=True):
            outcome = own.outcome_at(ref)
            if isinstance(outcome, Skipped | Failed):
                word = "failed" if outcome.__class__ is Failed else "skipped"
                first = [outcome.reason.partition("\n")[0], 0]
                self.reasons.setdefault((word, name, outcome.origin), first)[1] += 1


class Session:
    """A comparison under way: add frames, then let `close.close` make the `Comparison`.

    Parameters
    ----------
    prepared : sequence of Prepared
    seed : int
        Seed of the steps that take randomness.
    keeper : Keeper, optional
        Chooses the frames that are kept whole.
    """

    def __init__(
        self, prepared: Sequence[Prepared], seed: int = 0, keeper: Keeper | None = None
    ) -> None:
        self.prepared = tuple(prepared)
        self.seed = seed
        self.merged = merge([p.pipeline for p in prepared], [p.asked for p in prepared])
        first = self.merged.pipeline.runner(seed=seed)
        self.plan = first.plan
        self.stateful = first.stateful
        self.runners = self._runners(first)
        self._runner: Runner[Result] | None = None
        self.promises = self.merged.pipeline.promises
        self._turns = np.random.default_rng(seed)
        self.logs = [
            VariantLog(p, m) for p, m in zip(self.prepared, self.merged.members, strict=True)
        ]
        self.keeper = keeper or Keeper()
        self.merged_nodes = tuple(i.name for i in self.plan.nodes)
        self.node_times_us: list[list[float]] = []
        self.merged_states: list[bytes] = []
        self.fixed_us: list[float] = []
        self.indices: list[int] = []
        self.times_s: list[float] = []
        self.labels: list[str] = []
        self.n_true: list[int] = []
        self.reused: list[bool] = []
        self.started = time.perf_counter()
        self.last = self.started

    def _runners(self, first: Runner[Result]) -> list[Runner[Result]]:
        """Return runners that take the variants in different orders.

        Whoever comes first finds the caches of the processor cold: in one fixed order the first
        of three equal variants of circle-3 took 2.4 times as long as the others. So does, a
        little, whoever comes behind a variant that computes much. Steps that keep state have to
        stay in one runner, and so in one order.
        """
        if first.stateful:
            return [first]
        turns = orders(len(self.prepared), MOST_TURNS)
        return [self.merged.in_order(turn).runner(seed=self.seed) for turn in turns]

    @property
    def n(self) -> int:
        """Frames so far."""
        return len(self.indices)

    def warm_up(self, frames: Sequence[Frame]) -> None:
        """Run some frames through a copy, so that what is compiled or made once is not timed.

        Sinks would write twice: with one among the nodes, nothing is run.
        """
        from tactile_graph.compiled import warm_up

        warm_up()
        if any(i.node is not None and i.node.is_sink for i in self.plan.nodes):
            return
        copy = self.merged.pipeline.runner(seed=self.seed)
        until = time.perf_counter() + WARM_S
        for frame in frames[:WARM_FRAMES]:
            self._check(frame)
            copy(frame)
            if time.perf_counter() > until:
                break

    def _check(self, frame: Frame) -> None:
        """Check the rules that only a frame can settle, each variant's in its own name."""
        for member in self.merged.members:
            check_frame(frame.image, member.plan)

    def add(self, frame: Frame) -> Result:
        """Run a frame, note what each variant came to, and return the merged result.

        Raises
        ------
        RuleError
            If the frame's quantity, shape or pitch breaks a rule of some variant's step.
        """
        self._check(frame)
        runner = self._runner_for(frame)
        start = time.perf_counter()
        result = runner(frame)
        whole_us = 1e6 * (time.perf_counter() - start)
        if self.promises.waiting:
            self.promises.check(result)
        times_us = result.times_us
        position = self.n
        worst = {log.prepared.label: log.add(position, result, times_us) for log in self.logs}
        self.keeper.add(position, result, worst)
        self._note(frame, result, whole_us, times_us)
        self.last = time.perf_counter()
        return result

    def _runner_for(self, frame: Frame) -> Runner[Result]:
        """Return the one that ran last if it need not run again, else one drawn at random.

        Drawn, not in turn: what lies on the pad may come in turn, too.
        """
        last = self._runner
        if last is None or not last.repeats(frame):
            self._runner = self.runners[int(self._turns.integers(len(self.runners)))]
            self._runner.forget()  # what it saw last was not the frame before
        assert self._runner is not None
        return self._runner

    def _note(
        self, frame: Frame, result: Result, whole_us: float, times_us: dict[str, float]
    ) -> None:
        times = [times_us[n] for n in self.merged_nodes]
        self.node_times_us.append(times)
        self.merged_states.append(bytes([_code(result.outcome(n)) for n in self.merged_nodes]))
        self.fixed_us.append(math.nan if result.reused else whole_us - sum(times))
        self.indices.append(frame.index)
        self.times_s.append(math.nan if frame.time_s is None else frame.time_s)
        self.labels.append(frame.label)
        self.n_true.append(-1 if frame.truth is None else len(frame.truth))
        self.reused.append(result.reused)

    def times_by_node(self) -> np.ndarray[Any, np.dtype[np.float64]]:
        """Return microseconds, shape (n_frames, n_merged_nodes)."""
        return np.array(self.node_times_us).reshape(self.n, len(self.merged_nodes))


def _code(outcome: Any) -> int:
    from tactile_graph.engine.outcome import NOT_ASKED

    if outcome is NOT_ASKED:
        return 0
    return {Skipped: 2, Failed: 3}.get(outcome.__class__, 1)
