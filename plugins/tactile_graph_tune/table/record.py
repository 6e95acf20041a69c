"""Run everything on every frame, and keep of it what choosing needs."""

from __future__ import annotations

import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import partial
from typing import Any, NamedTuple

import numpy as np

from tactile_graph import Pipeline, Result
from tactile_graph.compiled import once_made, warm_up
from tactile_graph.errors import UsageError
from tactile_graph.inspect import NO_VALUE, Failed, NodeKind, Ref, Runner, Skipped
from tactile_graph.many import Place, Portion, Sharing
from tactile_graph.wires.frame import Frame
from tactile_graph_compare.run.session import balanced_orders
from tactile_graph_compare.variants.merge import Member, merge
from tactile_graph_tune.choices.comparisons import alternatives, node_of
from tactile_graph_tune.table.columns import FieldColumn, NodeColumn, Table, joined
from tactile_graph_tune.table.fields import guard_fields, value_at
from tactile_graph_tune.table.kinds import Reals, Truths
from tactile_graph_tune.table.losses import LossOf

WARM_FRAMES = 8
Told = Callable[[int, int], None]
"""Is told how many frames of how many are done."""


class Judged(NamedTuple):
    """By what an answer is judged."""

    answer: str
    quantity: str
    unit: str
    price: float


class Rounds(NamedTuple):
    """How often everything runs, times being medians; the seed; who is told how far it is; where.

    Without a place everything runs in this process.
    """

    n: int
    seed: int
    told: Told
    place: Place | None = None


def record(
    pipelines: Sequence[Pipeline],
    also: Sequence[str],
    frames: Sequence[Frame],
    judged: Judged,
    rounds: Rounds,
) -> list[Table]:
    """Return the table of each pipeline; nodes they have in common run once.

    Parameters
    ----------
    pipelines : sequence of Pipeline
        Without the guards that are to be chosen.
    also : sequence of str
        Fields that are asked already, whatever they say.
    frames : sequence of Frame
    judged : Judged
    rounds : Rounds

    Raises
    ------
    UsageError
        If a step keeps state or writes: what it does then hangs on what was skipped before.
    """
    for pipeline in pipelines:
        _check(pipeline)
    given = _Given(pipelines, also, judged, rounds.n, rounds.seed)
    if rounds.place is None:
        return _Recorder(given).tables(frames, rounds.told)
    parts: list[list[Table]] = []
    with Sharing(rounds.place, _Recorder, given) as workers:
        for tables in workers.over_frames(iter(frames)):
            parts.append(tables)
            rounds.told(rounds.n * sum(t[0].n for t in parts), rounds.n * len(frames))
        if workers.left_out:
            raise UsageError(f"frame {workers.left_out[0]}: workers died of it each time")
    return [joined(of_one) for of_one in zip(*parts, strict=True)]


class _Given(NamedTuple):
    """What is recorded of frames."""

    pipelines: Sequence[Pipeline]
    also: Sequence[str]
    judged: Judged
    n_rounds: int
    seed: int


class _Recorder:
    """Runs everything on frames, in this process or in a worker."""

    def __init__(self, given: _Given) -> None:
        warm_up()  # what answers as plain code meanwhile would be timed as such
        self._given = given
        asked = [tuple(p.nodes) for p in given.pipelines]
        self._merged = merge(given.pipelines, asked)
        # Who comes first finds the processor's caches cold, so that no pipeline may always do so.
        orders = balanced_orders(len(given.pipelines), 2 * len(given.pipelines))
        pipelines = [self._merged.in_order(order) for order in orders]
        self._runners = [p.runner(seed=given.seed).each_alone() for p in pipelines]
        self._order_rng = np.random.default_rng([given.seed, 8])
        self._warm = False

    def __call__(self, portion: Portion) -> list[Table]:
        """Return the tables of a portion: what a worker does."""
        return self.tables(portion.frames()[1], lambda n, of: None)

    def tables(self, frames: Sequence[Frame], told: Told) -> list[Table]:
        """Return the table of each pipeline."""
        given, runners = self._given, self._runners
        repeatable = runners[0].plan.repeatable  # what draws at random must not draw more often
        for frame in [] if self._warm else frames[:WARM_FRAMES]:
            runners[0](frame)
        for runner in [] if self._warm else runners[1:]:
            runner(frames[0])
        self._warm = True
        members = zip(given.pipelines, self._merged.members, strict=True)
        rows = [_Rows(p, m, given.also, given.judged) for p, m in members]
        for k in range(given.n_rounds):
            for i, frame in enumerate(frames):
                runner = runners[int(self._order_rng.integers(len(runners)))]
                run = partial(_anew, runner, frame)
                result = once_made(run) if repeatable else run()
                for its in rows:
                    its.add(result, first=k == 0)
                told(k * len(frames) + i + 1, given.n_rounds * len(frames))
        return [its.table(len(frames)) for its in rows]


def _anew(runner: Runner[Result], frame: Frame) -> Result:
    runner.forget()
    return runner(frame)


def _check(pipeline: Pipeline) -> None:
    for name, node in pipeline.nodes.items():
        if node.stateful:
            raise UsageError(
                f"pipeline {pipeline.name!r}: node {name!r} keeps state from frame to frame: what "
                "it gives hangs on which frames it saw, and no table of single frames can tell"
            )
        if node.is_sink:
            raise UsageError(
                f"pipeline {pipeline.name!r}: node {name!r} writes; tune it without that node"
            )


@dataclass
class _Field:
    """A field of a node, or several that are joined by ``or``, and its values so far."""

    name: str
    values: list[float]
    spent_s: float = 0.0

    def __post_init__(self) -> None:
        self.node = node_of(self.name)
        self._joined = [(c, _path(c.field)) for c in alternatives(self.name)]
        self._path = _path(self.name)

    def add(self, value: Any) -> None:
        """Enter what a node came to in a frame."""
        start = time.perf_counter()
        number = np.nan if value.__class__ in NO_VALUE else self._of(value)
        self.spent_s += time.perf_counter() - start
        self.values.append(number)

    def _of(self, value: Any) -> float:
        if not self._joined:
            return value_at(value, self._path)
        numbers = [(c, value_at(value, path)) for c, path in self._joined]
        if any(np.isnan(number) for _, number in numbers):
            return np.nan
        return float(any(c.of(np.array(number)) for c, number in numbers))


def _path(field: str) -> tuple[str, ...]:
    return tuple(field.split(".")[1:])


class _Rows:
    """What was recorded so far of one pipeline."""

    def __init__(
        self, pipeline: Pipeline, member: Member, also: Sequence[str], judged: Judged
    ) -> None:
        self._pipeline, self._member, self._judged = pipeline, member, judged
        self._states: dict[str, list[tuple[bool, bool, bool]]] = {n: [] for n in pipeline.nodes}
        self._times: list[list[float]] = []
        names = dict.fromkeys([*guard_fields(pipeline), *also])
        self._fields = [_Field(name, []) for name in names]
        leaves = leaves_of(pipeline, pipeline.outputs[judged.answer])
        self._losses = {
            str(leaf): LossOf(pipeline, str(leaf), judged.quantity, judged.price) for leaf in leaves
        }
        self._lost: dict[str, list[float]] = {name: [] for name in self._losses}
        self._truths: list[int] = []

    def add(self, result: Result, first: bool) -> None:
        """Enter a frame; all but its times the first time only."""
        times, names = result.times_us, self._member.names
        self._times.append([times[names[n]] for n in self._pipeline.nodes])
        if not first:
            return
        values = {n: result.outcome(names[n]) for n in self._pipeline.nodes}
        for name, value in values.items():
            own = value.__class__ is Skipped and value.origin == names[name]
            closed = own and times[names[name]] == 0.0
            ok = value.__class__ not in NO_VALUE
            self._states[name].append((ok, value.__class__ is Failed, not closed))
        for field in self._fields:
            field.add(values[field.node])
        for name, loss in self._losses.items():
            lost = loss(result.frame, lambda ref: result.outcome_at(self._member.ref(ref)))
            self._lost[name].append(lost)
        truth = result.frame.truth
        self._truths.append(-1 if truth is None else len(truth))

    def table(self, n: int) -> Table:
        """Return the columns."""
        times = np.array(self._times).reshape(-1, n, len(self._states))
        median = np.median(times, axis=0)
        truths, price = np.array(self._truths), self._judged.price
        lost = {k: np.array(v) for k, v in self._lost.items()}
        known = np.any([~np.isnan(v) for v in lost.values()], axis=0)
        return Table(
            {
                name: _node_column(rows, median[:, k])
                for k, (name, rows) in enumerate(self._states.items())
            },
            {f.name: _column(f) for f in self._fields},
            {k: np.where(np.isnan(v), price, v) for k, v in lost.items()},
            Truths(truths > 0, price, np.ones(len(truths))),
            (truths >= 0) & known,
        )


def _node_column(rows: list[tuple[bool, bool, bool]], time_us: Reals) -> NodeColumn:
    ok, failed, opened = np.array(rows, dtype=np.bool_).T
    return NodeColumn(ok, failed, opened, time_us)


def _column(field: _Field) -> FieldColumn:
    values = np.array(field.values)
    return FieldColumn(values, 1e6 * field.spent_s / max(1, int((~np.isnan(values)).sum())))


def leaves_of(pipeline: Pipeline, ref: Ref) -> list[Ref]:
    """Return what may answer in the end at a reference: all that a ladder of ladders holds."""
    node = pipeline.nodes.get(ref.node)
    if node is None or node.kind is not NodeKind.FIRST_OF or not ref.whole:
        return [ref]
    found = [leaf for choice in node.choices for leaf in leaves_of(pipeline, choice)]
    return list(dict.fromkeys(found))
