"""The rule of ``when``: a node whose guard does not hold, or cannot be told, is skipped."""

from __future__ import annotations

from typing import Any

from tactile_graph.engine.operations.freeze import IMMUTABLE
from tactile_graph.engine.operations.step_operation import Operation, State
from tactile_graph.engine.outcomes.outcome import NO_VALUE, Failed, Skipped, failure
from tactile_graph.engine.plan import Item
from tactile_graph.pipeline.conditions.conditions import Guard


def guarded(item: Item, guard: Guard, reads: list[Operation], body: Operation) -> Operation:
    """Run the body where the guard holds; ``reads`` give what it is about."""
    if guard.groups:
        return _guarded_over_items(item, guard, reads, body)
    if len(reads) == 1:
        return _guarded_by_one(item, guard, reads[0], body)
    slot, name, holds, reason = item.slot, item.name, guard.function, guard.reason

    def operation(state: State) -> None:
        values = tuple([read(state) for read in reads])
        for value in values:
            if value.__class__ in NO_VALUE:
                state[slot] = value
                return
        try:
            holds_now = holds(*values)
        except Exception as error:
            state[slot] = failure(name, error, values, f"when {guard.text}")
            return
        if holds_now:
            body(state)
        else:
            state[slot] = Skipped(name, reason, values)

    return operation


def _guarded_over_items(
    item: Item, guard: Guard, reads: list[Operation], body: Operation
) -> Operation:
    """Run the body where a guard over the items of lists holds, of those that have a value."""
    slot, name, holds, reason = item.slot, item.name, guard.function, guard.reason

    def operation(state: State) -> None:
        values = [read(state) for read in reads]
        lacking = next((v for v in values if v.__class__ in NO_VALUE), None)
        for group in guard.groups if lacking is None else ():
            rows = [*zip(*(values[i] for i in group), strict=True)]
            failed = (v for row in rows for v in row if v.__class__ is Failed)
            lacking = next(failed, lacking)
            kept = [row for row in rows if not any(v.__class__ in NO_VALUE for v in row)]
            for k, i in enumerate(group):
                values[i] = tuple([row[k] for row in kept])
        if lacking is not None:
            state[slot] = lacking
            return
        try:
            holds_now = holds(*values)
        except Exception as error:
            state[slot] = failure(name, error, tuple(values), f"when {guard.text}")
            return
        if holds_now:
            body(state)
        else:
            state[slot] = Skipped(name, reason, tuple(values))

    return operation


def _guarded_by_one(item: Item, guard: Guard, read: Operation, body: Operation) -> Operation:
    """Run the body where a guard about one value holds.

    Frame after frame nothing lies on the pad: the verdict on the very number of the last frame
    is kept.
    """
    slot, name, holds, reason = item.slot, item.name, guard.function, guard.reason
    known: Any = body  # no value is it
    verdict: Skipped | None = None

    def operation(state: State) -> None:
        nonlocal known, verdict
        value = read(state)
        if value is known:
            if verdict is None:
                body(state)
            else:
                state[slot] = verdict
            return
        if value.__class__ in NO_VALUE:
            state[slot] = value
            return
        try:
            skipped = None if holds(value) else Skipped(name, reason, (value,))
        except Exception as error:
            state[slot] = failure(name, error, (value,), f"when {guard.text}")
            return
        if value.__class__ in IMMUTABLE:
            known, verdict = value, skipped
        if skipped is None:
            body(state)
        else:
            state[slot] = skipped

    return operation
