"""What a choice of guards and order would come to, from the table of what everything came to.

The rules of skipping in plain columns: a guard is settled before its node, ports in their order, a
later rung only where the earlier ones have no value. Choices may be weighed many at a time: a
comparison then holds or not in an array of shape (n_choices, n_frames). What the columns say is
held against the engine itself: the last few choices are run.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from tactile_graph import Pipeline
from tactile_graph.inspect import FRAME, Node, NodeKind, Ref
from tactile_graph_tune.choices.comparisons import Comparison
from tactile_graph_tune.choices.declared import Chosen, Declared
from tactile_graph_tune.table.columns import Table
from tactile_graph_tune.table.kinds import Flags, Means, Reals, Truths

YES = np.True_


class Asked(NamedTuple):
    """A comparison, or several of one field side by side, as columns.

    Parameters
    ----------
    field : str
    node : str
    holds : ndarray of bool, shape (n_frames,) or (n_choices, n_frames)
    time_us : float
        Of reading the field.
    """

    field: str
    node: str
    holds: Flags
    time_us: float

    @classmethod
    def of(cls, comparison: Comparison, table: Table) -> Asked:
        """Return a comparison as a column."""
        column = table.column(comparison.field)
        return cls(comparison.field, comparison.node, comparison.of(column.values), column.time_us)


class Predicted(NamedTuple):
    """What a choice comes to in each frame, shapes (n_frames,) or (n_choices, n_frames)."""

    time_us: Reals
    loss: Reals
    answered: Flags
    failed: Flags

    def spread(self, shape: tuple[int, ...]) -> Predicted:
        """Return it with every column in one shape."""
        columns: list[Any] = [np.broadcast_to(column, shape) for column in self]
        return Predicted(*columns)

    def means(self, truths: Truths) -> Means:
        """Return the means of each choice over the frames."""
        return truths.means(self.time_us, self.loss, self.failed)

    def taken(self, frames: NDArray[np.int64]) -> Predicted:
        """Return some frames of one choice."""
        columns: list[Any] = [column[frames] for column in self]
        return Predicted(*columns)


Order = tuple[str, ...]
Questions = Mapping[str, Sequence[Asked]]


class Cascade:
    """Weighs choices by a table.

    Parameters
    ----------
    pipeline : Pipeline
        Without any of the guards to be chosen, as the table was made of it.
    declared : Declared
    answer : Ref
        Whose error counts.
    """

    def __init__(self, pipeline: Pipeline, declared: Declared, answer: Ref) -> None:
        self.pipeline = pipeline
        self.answer = answer
        self.ladder = declared.ladder
        self.places_at = {n: declared.places_of(n) for n in pipeline.nodes}
        self.outputs = tuple(pipeline.outputs.values())

    def predicted(self, table: Table, order: Order, chosen: Chosen) -> Predicted:
        """Return what one choice comes to in every frame of a table."""
        asked = {
            place: [Asked.of(c, table) for c in comparisons]
            for place, comparisons in chosen.items()
        }
        return self(table, order, asked).spread((table.n,))

    def __call__(self, table: Table, order: Order, asked: Questions) -> Predicted:
        """Return what choices come to, many at a time where a comparison is many."""
        return _Weighing(self, table, order, asked).predicted()


class _Weighing:
    def __init__(self, cascade: Cascade, table: Table, order: Order, asked: Questions) -> None:
        self.cascade, self.table, self.order, self.asked = cascade, table, order, asked
        self.nodes = cascade.pipeline.nodes
        self.settled: dict[str, tuple[Any, Any]] = {}
        """Node -> where it has a value, and where it failed; each after what it reads."""
        self.passed: dict[str, Any] = {FRAME: YES}
        self.none = table.truths.none

    def predicted(self) -> Predicted:
        for ref in self.cascade.outputs:
            self._state(ref.node)
        ok, _ = self._state(self.cascade.answer.node)
        time_us, failed = self._run()
        return Predicted(time_us, self._loss(self.cascade.answer), ok, failed)

    # -- what has a value ----------------------------------------------------------------------

    def _state(self, name: str) -> tuple[Any, Any]:
        if name == FRAME:
            return YES, np.False_
        if name not in self.settled:
            self.passed[name] = self._guard(name)
            self.settled[name] = self._outcome(self.nodes[name])
        return self.settled[name]

    def _guard(self, name: str) -> Any:
        """Return where all that guards a node holds."""
        node = self.nodes[name]
        for ref in node.guard.refs if node.guard is not None else ():
            self._state(ref.node)
        holds: Any = self.table.nodes[name].opened
        for question in self._asked_at(name):
            holds = holds & question.holds & self._state(question.node)[0]
        return holds

    def _asked_at(self, name: str) -> list[Asked]:
        places = self.cascade.places_at[name]
        return [question for place in places for question in self.asked.get(place, ())]

    def _outcome(self, node: Node) -> tuple[Any, Any]:
        column, passed = self.table.nodes[node.name], self.passed[node.name]
        if node.kind is NodeKind.FIRST_OF:
            states = [self._state(ref.node) for ref in self._choices(node)]
            ok = np.logical_or.reduce(np.broadcast_arrays(*(s[0] for s in states)))
            bad = np.logical_or.reduce(np.broadcast_arrays(*(s[1] for s in states)))
            return passed & ok, passed & bad & ~ok
        ready, bad = passed, np.False_
        for ref, _ in _wired(node):
            its, failed = self._state(ref.node)
            bad = bad | (ready & failed)
            ready = ready & its
        return ready & column.ok, bad | (ready & column.failed)

    def _choices(self, node: Node) -> list[Ref]:
        if node.name == self.cascade.ladder:
            return [Ref(name) for name in self.order]
        return list(node.choices)

    # -- what runs -----------------------------------------------------------------------------

    def _run(self) -> tuple[Reals, Flags]:
        """Return what runs takes, and where a step of it fails."""
        needed: dict[str, Any] = {}

        def need(name: str, where: Any) -> None:
            if name != FRAME:
                needed[name] = needed[name] | where if name in needed else where

        for ref in self.cascade.outputs:
            need(ref.node, YES)
        total: Any = np.zeros(self.table.n)
        failing: Any = np.zeros(self.table.n, np.bool_)
        for name in reversed(self.settled):
            where = needed.get(name)
            if where is None:
                continue
            node = self.nodes[name]
            for question in self._asked_at(name):
                need(question.node, where)
                total = total + question.time_us * (where & self._state(question.node)[0])
            for ref in node.guard.refs if node.guard is not None else ():
                need(ref.node, where)
            where = where & self.passed[name]
            if node.kind is NodeKind.FIRST_OF:
                for ref in self._choices(node):
                    need(ref.node, where)
                    where = where & ~self._state(ref.node)[0]
                continue
            ran = where
            for ref, required in _wired(node):
                need(ref.node, where)
                ok, bad = self._state(ref.node)
                ran = ran & ok
                where = where & (ok | bad) if required else where
            column = self.table.nodes[name]
            total = total + ran * column.time_us
            if column.failed.any():
                failing = failing | (ran & column.failed)
        return total, failing

    def _loss(self, ref: Ref) -> Any:
        """Return the error of what answers at a reference."""
        node = self.nodes.get(ref.node)
        if node is None or node.kind is not NodeKind.FIRST_OF or not ref.whole:
            ok, _ = self._state(ref.node)
            return np.where(ok, self.table.losses[str(ref)], self.none)
        found: Any = self.none
        passed = self.passed[ref.node]
        for choice in reversed(self._choices(node)):
            ok, _ = self._state(choice.node)
            found = np.where(passed & ok, self._loss(choice), found)
        return found


def _wired(node: Node) -> list[tuple[Ref, bool]]:
    """Return what a node reads, port by port, and whether it needs it."""
    wired = [(ref, b.port.required) for b in node.inputs for ref in b.refs]
    return wired + [(ref, True) for ref in node.choices]


def bound(pipeline: Pipeline, table: Table) -> set[str]:
    """Return the nodes that no guard may keep from running, or what reads them is not in the table.

    A port that may stay empty, or takes a list of what there is, gives something else then; so does
    a ``first_of`` that a step reads, where several of its choices have a value.
    """
    found: set[str] = set()
    for node in pipeline.nodes.values():
        for binding in node.inputs:
            if (binding.collects and len(binding.refs) > 1) or not binding.port.required:
                found |= _behind(pipeline, (r.node for r in binding.refs))
            for ref in binding.refs:
                inner = pipeline.nodes.get(ref.node)
                if inner is not None and _ambiguous(inner, table):
                    found |= _behind(pipeline, [ref.node])
    return found


def _ambiguous(node: Node, table: Table) -> bool:
    """Return whether guards decide which of several values a node hands on."""
    if node.kind is not NodeKind.FIRST_OF:
        return False
    oks = [table.nodes[r.node].ok for r in node.choices if r.node != FRAME]
    n_frame = sum(r.node == FRAME for r in node.choices)
    return bool((np.sum(oks, axis=0) + n_frame > 1).any())


def _behind(pipeline: Pipeline, names: Any) -> set[str]:
    found: set[str] = set()
    waiting = [n for n in names if n != FRAME]
    while waiting:
        name = waiting.pop()
        if name not in found:
            found.add(name)
            waiting += [r.node for r in pipeline.nodes[name].wires() if r.node != FRAME]
    return found
