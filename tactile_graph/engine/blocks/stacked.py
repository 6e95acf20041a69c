"""How a block of frames answers what a plan's program asks of one frame.

The program that settles a frame's slots settles those of several frames as well: its values are
then stacks. Here is what makes this so: calls and fields that take stacks, and guards that hold for
all frames of a group or let them part ways. No rule of skipping stands here.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, replace
from itertools import repeat
from time import perf_counter_ns as clock
from typing import Any

import numpy as np

from tactile_graph.engine.operations.freeze import freeze
from tactile_graph.engine.outcomes.outcome import NO_VALUE, Skipped
from tactile_graph.errors import PluginError
from tactile_graph.pipeline.conditions.conditions import Guard
from tactile_graph.pipeline.graph import Node, NodeKind
from tactile_graph.steps.signature import Signature
from tactile_graph.steps.stacked import STACKED, stacked_kinds
from tactile_graph.wires.stacks import Answered, Column, Listed, Rows, Stack, field_of

Call = Callable[..., Any]


class Parted(BaseException):  # no error: what catches those must let it pass
    """The frames of a group part ways at a slot.

    Attributes
    ----------
    together : list of Rows
        Frames that go on as groups.
    alone : Rows
        Frames that go on one by one, from what is settled.
    slot, value, time_ns
        What was settled for those that go on as groups, if anything was, and how long it took.
    """

    def __init__(
        self, together: Iterable[Rows], alone: Rows, slot: int = -1, value: Any = None,
        time_ns: int = 0,
    ) -> None:  # fmt: skip
        self.together = [rows for rows in together if len(rows)]
        self.alone = alone
        self.slot, self.value, self.time_ns = slot, value, time_ns


NOBODY = np.empty(0, np.intp)


def all_alone(n: int) -> Parted:
    """Return what lets each of n frames go on alone."""
    return Parted([], np.arange(n))


# -- calls -----------------------------------------------------------------------------------


@dataclass(frozen=True)
class StackedForm:
    """A step's form for stacks, and which stack each port takes."""

    answer: Call
    kinds: Mapping[str, Any]

    def takes(self, values: Mapping[str, Any]) -> bool:
        """Return whether the values are of the kinds it takes."""
        return all(name in self.kinds and isinstance(v, self.kinds[name])
                   for name, v in values.items())  # fmt: skip


def stacked_form(node: Node) -> StackedForm | None:
    """Return a node's form for stacks of frames; None where its step offers none.

    Raises
    ------
    PluginError
        If the form is not annotated.
    """
    signature = node.signature
    if node.kind is not NodeKind.STEP or signature is None or in_order(node) or signature.rng:
        return None
    if node.isolation is not None:  # a limit is about one frame
        return None
    return form_of(signature, node.settings, node.bound)


def form_of(
    signature: Signature, settings: Mapping[str, Any], made: Callable[[], Any]
) -> StackedForm | None:
    """Return a step's form for stacks of frames; None where it offers none.

    Parameters
    ----------
    signature : Signature
    settings : mapping
        Every setting of the step.
    made : callable
        Gives the step with its settings, where it is a class.

    Raises
    ------
    PluginError
        If the form is not annotated.
    """
    kinds = stacked_kinds(signature)
    if kinds is None:
        return None
    return StackedForm(signature.form(STACKED, settings, made), kinds)


def in_order(node: Node) -> bool:
    """Return whether a node must see one frame after the other, or does more than give a value."""
    of_items = node.each or node.kind is NodeKind.MAP
    return of_items or node.stateful or node.is_sink or bool(
        node.signature is not None and (node.signature.rng_at_init or node.signature.gap)
    )  # fmt: skip


def stacked_call(
    node: Node, slot: int, call: Call, frames: Callable[[], Stack], show: Call
) -> Call:
    """Return a node's call of its ports' stacks.

    Parameters
    ----------
    node : Node
    slot : int
        Of the node.
    call : callable
        The step, for one frame.
    frames : callable
        Gives the frames of the group under way.
    show : callable
        Takes a frame that the step is about to be called for.
    """
    if in_order(node):
        return lambda *_, **__: _raise(all_alone(len(frames())))
    form = stacked_form(node)
    assert node.signature is not None
    order = [port.name for port in node.signature.ports]

    def answer(*args: Any, **kwargs: Any) -> Any:
        values = {**dict(zip(order, args, strict=False)), **kwargs}
        start = clock()
        if form is not None and form.takes(values):
            found = _by_form(node, form, values, len(frames()))
            if isinstance(found, Stack):
                return found
            if found is not None:
                _part(found.values, found.done, slot, start)
        group = frames()
        outcomes: list[Any] = [None] * len(group)
        done = np.zeros(len(group), np.bool_)
        for i, frame in enumerate(group):
            show(frame)
            try:
                value = freeze(call(**{name: at(v, i) for name, v in values.items()}))
            except Exception:  # told when the frame goes on alone
                continue
            if value is not None and value.__class__ not in NO_VALUE:
                outcomes[i], done[i] = value, True
        if not done.all():
            _part(Listed(outcomes), done, slot, start)
        return Listed(outcomes)

    return answer


def _by_form(
    node: Node, form: StackedForm, values: Mapping[str, Any], n: int
) -> Stack | Answered | None:
    """Return what a stacked form gives; None where it leaves all frames to the step itself."""
    try:
        found = form.answer(**values)
    except Exception:  # told by the step itself, frame by frame
        return None
    if found is NotImplemented:
        return None
    stack = found.values if isinstance(found, Answered) else found
    if not isinstance(stack, Stack) or len(stack) != n:
        got = f"{len(stack)} values" if isinstance(stack, Stack) else type(stack).__name__
        raise PluginError(f"node {node.name!r}: the stacked form of step {node.what!r} must give "
                          f"a stack of {n} values, got {got}")  # fmt: skip
    whole = found is stack or bool(found.done.all())
    return stack if whole else found


def _part(value: Stack, done: Any, slot: int, start: int) -> None:
    settled, alone = np.flatnonzero(done), np.flatnonzero(~done)
    raise Parted([settled], alone, slot, value, clock() - start)


def _raise(parted: Parted) -> None:
    raise parted


# -- fields and guards -----------------------------------------------------------------------


def stacked_field(path: tuple[str, ...], get: Call) -> Call:
    """Return what makes a field of a stack of a node's values, or of one value."""

    def field(value: Any) -> Any:
        if not isinstance(value, Stack):
            return get(value)
        try:
            found = field_of(value, path) if path else Listed([*map(get, value)])
            if isinstance(found, Listed):
                found = Listed([freeze(v) for v in found])
        except Exception:  # told when the frame goes on alone
            raise all_alone(len(value)) from None
        if isinstance(found, Listed):
            there = np.array([v is not None for v in found], np.bool_)
            if not there.all():
                _part_at(there)
        return found

    return field


def _part_at(there: Any) -> None:
    raise Parted([np.flatnonzero(there)], np.flatnonzero(~there))


def stacked_guard(guard: Guard, frames: Callable[[], Stack]) -> Guard:
    """Return a guard over stacks: it says what holds for all frames, or lets them part ways.

    Parameters
    ----------
    guard : Guard
    frames : callable
        Gives the frames of the group under way.
    """
    if guard.groups:  # what it reads may be the same for all frames: no stack
        alone = lambda *_: _raise(all_alone(len(frames())))  # noqa: E731
        return replace(guard, groups=(), function=alone)
    holds = guard.function

    def verdict(values: tuple[Any, ...]) -> bool | None:
        try:
            return bool(holds(*values))
        except Exception:  # told when the frame goes on alone
            return None

    def holds_for_all(*values: Any) -> Any:
        stacks = [v for v in values if isinstance(v, Stack)]
        if not stacks:
            return holds(*values)
        rows = zip(*[v if isinstance(v, Stack) else repeat(v) for v in values], strict=False)
        if all(isinstance(v, Column) for v in stacks) and len(stacks) == len(values):
            told = [*rows]
            known = {row: verdict(row) for row in set(told)}  # the same numbers come again
            if len(set(known.values())) == 1 and None not in known.values():
                return known[told[0]]
            verdicts = [known[row] for row in told]
        else:
            verdicts = [verdict(row) for row in rows]
        if None not in verdicts and len(set(verdicts)) == 1:
            return verdicts[0]
        said = np.array([-1 if v is None else int(v) for v in verdicts])
        together = [np.flatnonzero(said == v) for v in (1, 0)]
        raise Parted(together, np.flatnonzero(said < 0))

    return replace(guard, function=holds_for_all)


# -- one frame of a group, or some of them ---------------------------------------------------


def at(outcome: Any, i: int) -> Any:
    """Return what a group's outcome is for one of its frames."""
    if isinstance(outcome, Stack):
        return outcome[i]
    if outcome.__class__ is Skipped:
        return outcome.told_by(lambda value: at(value, i))
    if outcome.__class__ is tuple:  # what a port collects
        return tuple([at(value, i) for value in outcome])
    return outcome


def taken(outcome: Any, rows: Rows) -> Any:
    """Return what a group's outcome is for some of its frames."""
    if isinstance(outcome, Stack):
        return outcome.take(rows)
    if outcome.__class__ is Skipped:
        return outcome.told_by(lambda value: taken(value, rows))
    return outcome
