"""Run the merged graph frame by frame, and note what each variant alone would have given."""

from __future__ import annotations

import math
import time
from collections.abc import Iterator, Sequence
from itertools import chain, islice
from typing import Any, NamedTuple

import numpy as np

from tactile_graph import Result
from tactile_graph.inspect import Runner, check_frame
from tactile_graph.plugins.registry import selected
from tactile_graph.wires.frame import Frame
from tactile_graph_compare.run.agreement_log import AgreementLog
from tactile_graph_compare.run.crowded import Waiting
from tactile_graph_compare.run.frame_choice import FrameChooser, Held, Seen, Told
from tactile_graph_compare.run.logs import MergedLog, Noted, VariantLog
from tactile_graph_compare.run.stories import as_sent, stories_of_all
from tactile_graph_compare.score.agreement import Differences
from tactile_graph_compare.variants.merge import merge
from tactile_graph_compare.variants.prepare import PreparedVariant

WARM_FRAMES = 8
WARM_S = 1.0
MOST_ORDERS = 8
"""Orders in which the variants run, at most."""


class Part(NamedTuple):
    """What a session noted of some frames, as it travels between processes."""

    first: int
    n: int
    logs: list[Noted]
    agreement: list[dict[str, Differences]]
    chooser: FrameChooser
    merged: tuple[list[Any], ...]


class Session:
    """A comparison under way: add frames, then let `summarise` make the `Comparison`.

    Parameters
    ----------
    prepared : sequence of PreparedVariant
    seed : int
        Seed of the steps that take randomness.
    chooser : FrameChooser, optional
        Chooses the frames that are kept whole.
    reference : str
        Label of the variant that all others are held against; see `AgreementLog`.
    """

    def __init__(
        self,
        prepared: Sequence[PreparedVariant],
        seed: int = 0,
        chooser: FrameChooser | None = None,
        reference: str = "",
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
        self._order_rng = np.random.default_rng(seed)
        self.reference = reference
        self.chooser = chooser or FrameChooser()
        self.begin()
        self.waiting: Waiting | None = Waiting()
        self.started = time.perf_counter()
        self.last = self.started

    def begin(self, first: int = 0) -> None:
        """Note anew, from the frame on that is so many behind the first of all."""
        self.first = first
        self.logs = [
            VariantLog(p, m) for p, m in zip(self.prepared, self.merged.members, strict=True)
        ]
        self.agreement = AgreementLog(self.logs, self.reference)
        self.chooser = self.chooser.anew()
        self.merged_log = MergedLog(self.plan)

    def _runners(self, first: Runner[Result]) -> list[Runner[Result]]:
        """Return runners that take the variants in different orders.

        Whoever comes first finds the caches of the processor cold: in one fixed order the first
        of three equal variants of circle-3 took 2.4 times as long as the others. So does, a
        little, whoever comes behind a variant that computes much. Steps that keep state have to
        stay in one runner, and so in one order.
        """
        first.each_alone()  # what variants share would tell whose nodes are quick else
        if first.stateful:
            return [first]
        found = balanced_orders(len(self.prepared), MOST_ORDERS)
        return [self.merged.in_order(order).runner(seed=self.seed).each_alone() for order in found]

    @property
    def n(self) -> int:
        """Frames so far."""
        return self.merged_log.n

    def warm_up(self, frames: Sequence[Frame]) -> None:
        """Run some frames through a copy, so that what is compiled or made once is not timed.

        While the first kernels are compiled, another process compiles others. Sinks would
        write twice: with one among the nodes, nothing is run.
        """
        from tactile_graph.compiled import Work, prepared_beside, warm_up

        warm_up()
        if any(i.node is not None and i.node.is_sink for i in self.plan.nodes):
            return
        copy = self.merged.pipeline.runner(seed=self.seed).each_alone()
        files = tuple(dict.fromkeys(p.pipeline.file for p in self.prepared))
        until = time.perf_counter() + WARM_S
        with prepared_beside(Work(files, plugins=selected())):
            for frame in frames[:WARM_FRAMES]:
                self._check(frame)
                copy(frame)
                if time.perf_counter() > until:
                    break

    def warmed(self, frames: Iterator[Frame]) -> Iterator[Frame]:
        """Yield the frames, having warmed up with the first of them."""
        first = list(islice(frames, WARM_FRAMES))
        self.warm_up(first)
        return chain(first, frames)

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
        result, whole_us = self._timed(frame)
        timed = not math.isnan(whole_us)
        if self.promises.waiting:
            self.promises.check(result)
        position = self.n
        worst = {log.prepared.label: log.add(position, result, timed) for log in self.logs}
        self.chooser.add(self.first + position, result, worst, self.agreement.add(position, frame))
        self.merged_log.add(frame, result, whole_us)
        self.last = time.perf_counter()
        return result

    def _timed(self, frame: Frame) -> tuple[Result, float]:
        """Run a frame; return its result and time, without that of what is made or loaded once.

        Where machine code came with the frame, the frame is run again, and the second time counts;
        NaN where steps keep state, draw at random or write, so that it can be run once only.
        """
        from tactile_graph.compiled import made_so_far, once_made

        runner = self._runner_for(frame)

        def run() -> tuple[Result, float]:
            start = time.perf_counter()
            result = runner(frame)
            return result, 1e6 * (time.perf_counter() - start)

        def run_again() -> tuple[Result, float]:
            runner.forget()
            return run()

        before = made_so_far()
        result, whole_us = run()
        if made_so_far() == before:
            return result, whole_us
        return once_made(run_again) if self.plan.repeatable else (result, math.nan)

    def without_state(self) -> Runner[Result]:
        """Forget what steps keep, and return what runs frames that are not noted."""
        self.runners = self._runners(self.merged.pipeline.runner(seed=self.seed))
        self._runner = None
        return self.runners[0]

    def pass_over(self, frame: Frame) -> None:
        """Run a frame and note nothing of it: the next may be equal to it."""
        self._runner_for(frame)(frame)

    # -- parts of it, noted by several processes -------------------------------------------------

    def part(self) -> Part:
        """Return what was noted since `begin`, as it travels between processes."""
        return Part(
            self.first,
            self.n,
            [log.noted() for log in self.logs],
            self.agreement.noted(),
            self.chooser.as_sent(self._told_for_the_way if self.stateful else None),
            self.merged_log.noted(),
        )

    def join(self, part: Part) -> None:
        """Note what was noted elsewhere of the frames that come next."""
        start = self.n
        self.waiting = None  # they were timed elsewhere
        for log, noted in zip(self.logs, part.logs, strict=True):
            log.join(noted)
        self.agreement.join(part.agreement, start)
        self.chooser.join(part.chooser, start - part.first)
        self.merged_log.join(part.merged)
        self.last = time.perf_counter()

    def told(self, held: Held) -> Told:
        """Return a frame that is kept, spelled out."""
        if isinstance(held, Told):
            return held
        result = self._run_again(held) if isinstance(held, Seen) else held
        return Told(result.frame, stories_of_all(result, self.logs))

    def _told_for_the_way(self, result: Result) -> Told:
        """Return a result spelled out: where it was run alone knows what was before it."""
        return Told(result.frame, as_sent(stories_of_all(result, self.logs)))

    def _run_again(self, held: Seen) -> Result:
        from tactile_graph.compiled import once_made, warm_up

        warm_up()  # where workers noted the frames, nothing has done so in this process
        runner = self.runners[0]

        def run() -> Result:
            runner.forget()
            return runner(held.frame)

        result = once_made(run) if self.plan.repeatable else run()
        return result.again(held.frame) if held.reused else result

    # -- which order ---------------------------------------------------------------------------

    def _runner_for(self, frame: Frame) -> Runner[Result]:
        """Return the one that ran last if it need not run again, else one drawn at random.

        Drawn, not in turn: what lies on the pad may come in turn, too.
        """
        last = self._runner
        if last is None or not last.repeats(frame):
            self._runner = self.runners[int(self._order_rng.integers(len(self.runners)))]
            self._runner.forget()  # what it saw last was not the frame before
        assert self._runner is not None
        return self._runner


def balanced_orders(n: int, most: int) -> list[tuple[int, ...]]:
    """Return orders of ``n`` variants in which none is favoured.

    Parameters
    ----------
    n : int
    most : int
        So many orders at most.

    Returns
    -------
    list of tuples of int
        Each comes at each place, and behind each other, equally often: a Latin square for an even
        number, two for an odd one (Williams 1949). Beyond ``most`` some of them, evenly taken.
    """
    zigzag = [0, *(k for pair in zip(range(1, n), range(n - 1, 0, -1), strict=True) for k in pair)]
    rows = [tuple((z + k) % n for z in zigzag[:n]) for k in range(n)]
    if n % 2 and n > 1:
        rows += [row[::-1] for row in rows]
    return [rows[round(i * len(rows) / most)] for i in range(most)] if len(rows) > most else rows
