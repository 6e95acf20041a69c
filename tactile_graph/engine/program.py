"""Turn a plan into plain functions over one list: the part that runs for every frame.

The list holds each slot's outcome (None while unsettled) and, behind them, each slot's time in
nanoseconds. An operation settles one slot; nothing here walks a graph or looks up a name.
"""

from __future__ import annotations

from collections.abc import Callable
from time import perf_counter_ns as clock
from typing import Any

from tactile_graph.engine.freeze import FROZEN, freeze
from tactile_graph.engine.outcome import (
    DONE,
    NO_VALUE,
    Failed,
    Skipped,
    describe_inputs,
    raised_at,
)
from tactile_graph.engine.plan import Input, Item, Plan
from tactile_graph.pipeline.conditions import Guard
from tactile_graph.pipeline.node import Node, NodeKind

State = list[Any]
Operation = Callable[[State], None]
Block = tuple[tuple[int, Operation], ...]
"""What runs only when an item needs it: slots and the operations that settle them."""
Call = Callable[..., Any]


def make_program(plan: Plan, call_of: Callable[[Node], Call], blank: State) -> list[Operation]:
    """Return the operations of a plan's main part.

    Parameters
    ----------
    plan : Plan
    call_of : callable
        Gives each step node's callable of its ports; stateful ones get their instance here.
    blank : list
        The state every frame starts from; outcomes that depend on no frame are kept in it.
    """
    operations: list[Operation] = [_nothing] * plan.n_slots
    for item in plan.items[1:]:
        operations[item.slot] = _operation(item, plan, call_of, operations, blank)
    return [operations[slot] for slot in plan.main]


def _nothing(state: State) -> None:
    return None


def _operation(
    item: Item,
    plan: Plan,
    call_of: Callable[[Node], Call],
    operations: list[Operation],
    blank: State,
) -> Operation:
    if item.view is not None:
        return _view(item)
    node = item.node
    assert node is not None
    blocks = [tuple((s, operations[s]) for s in port.lazy) for port in item.inputs]
    time = plan.n_slots + item.slot
    if node.kind is NodeKind.FIRST_OF:
        body = _first_of(item, blocks)
    elif node.kind is NodeKind.PASS:
        body = _pass(item, blocks)
    else:
        body = _call(item, node, call_of(node), time, blocks)
    if node.guard is not None:
        body = _guarded(item, node.guard, body)
    if item.constant:
        return _once(item.slot, time, body, blank)
    return body


def _once(slot: int, time: int, body: Operation, blank: State) -> Operation:
    """Settle a slot that depends on no frame, and keep it for all frames to come."""

    def operation(state: State) -> None:
        if state[slot] is None:
            body(state)
            blank[slot] = state[slot]

    return operation


def _view(item: Item) -> Operation:
    assert item.view is not None
    get, source, slot = item.view.getter, item.source, item.slot
    assert get is not None

    def operation(state: State) -> None:
        value = state[source]
        if value.__class__ in NO_VALUE:
            state[slot] = value
            return
        try:
            field = get(value)
        except Exception as error:
            state[slot] = failure(item.name, error, (value,), "")
            return
        if field is None:
            field = Skipped(item.name, f"{item.name} is not known")
        elif field.__class__ not in FROZEN:
            field = freeze(field)  # a property may make its array anew
        state[slot] = field

    return operation


def _guarded(item: Item, guard: Guard, body: Operation) -> Operation:
    slots, slot, name, holds = item.guard, item.slot, item.name, guard.function
    reason = guard.reason
    if len(slots) == 1:
        only = slots[0]

        def operation_of_one(state: State) -> None:
            value = state[only]
            if value.__class__ in NO_VALUE:
                state[slot] = value
                return
            try:
                if holds(value):
                    body(state)
                else:
                    state[slot] = Skipped(name, reason, (value,))
            except Exception as error:
                state[slot] = failure(name, error, (value,), f"when {guard.text}")

        return operation_of_one

    def operation(state: State) -> None:
        values = tuple([state[s] for s in slots])
        for value in values:
            if value.__class__ in NO_VALUE:
                state[slot] = value
                return
        try:
            if holds(*values):
                body(state)
            else:
                state[slot] = Skipped(name, reason, values)
        except Exception as error:
            state[slot] = failure(name, error, values, f"when {guard.text}")

    return operation


def _first_of(item: Item, blocks: list[Block]) -> Operation:
    slot = item.slot
    choices = [(port.slots[0], block) for port, block in zip(item.inputs, blocks, strict=True)]

    def operation(state: State) -> None:
        failed = value = None
        for source, block in choices:
            for lazy, settle in block:
                if state[lazy] is None:
                    settle(state)
            value = state[source]
            if value.__class__ not in NO_VALUE:
                state[slot] = value
                return
            if failed is None and value.__class__ is Failed:
                failed = value
        state[slot] = value if failed is None else failed

    return operation


def _pass(item: Item, blocks: list[Block]) -> Operation:
    slot, source, block = item.slot, item.inputs[0].slots[0], blocks[0]

    def operation(state: State) -> None:
        for lazy, settle in block:
            if state[lazy] is None:
                settle(state)
        state[slot] = state[source]

    return operation


def _call(item: Item, node: Node, call: Call, time: int, blocks: list[Block]) -> Operation:
    plain = not node.each and not node.is_sink
    if plain and all(p.required and not p.collects for p in item.inputs):
        if len(item.inputs) == 1:
            return _after(blocks[0], _call_of_one(item, node, call, time))
        if len(item.inputs) == 2 and not any(blocks):
            return _call_of_two(item, node, call, time)
    return _call_of_any(item, node, call, time, blocks)


def _after(block: Block, body: Operation) -> Operation:
    if not block:
        return body

    def operation(state: State) -> None:
        for lazy, settle in block:
            if state[lazy] is None:
                settle(state)
        body(state)

    return operation


def _call_of_one(item: Item, node: Node, call: Call, time: int) -> Operation:
    slot, source, name = item.slot, item.inputs[0].slots[0], item.name
    what = step_label(node)

    def operation(state: State) -> None:
        value = state[source]
        if value.__class__ in NO_VALUE:
            state[slot] = value
            return
        start = clock()
        try:
            result = call(value)
        except Exception as error:
            state[time] = clock() - start
            state[slot] = failure(name, error, (value,), what)
            return
        state[time] = clock() - start
        if result.__class__ not in FROZEN:
            result = freeze(result) if result is not None else nothing_returned(name, what)
        state[slot] = result

    return operation


def _call_of_two(item: Item, node: Node, call: Call, time: int) -> Operation:
    slot, name = item.slot, item.name
    first_source, second_source = (p.slots[0] for p in item.inputs)
    first_name, second_name = (p.name for p in item.inputs)
    assert node.signature is not None
    what = step_label(node)
    by_name = [p.name for p in node.signature.ports[:2]] != [first_name, second_name]
    if by_name:
        inner = call
        call = lambda a, b: inner(**{first_name: a, second_name: b})  # noqa: E731

    def operation(state: State) -> None:
        first = state[first_source]
        if first.__class__ in NO_VALUE:
            state[slot] = first
            return
        second = state[second_source]
        if second.__class__ in NO_VALUE:
            state[slot] = second
            return
        start = clock()
        try:
            result = call(first, second)
        except Exception as error:
            state[time] = clock() - start
            state[slot] = failure(name, error, (first, second), what)
            return
        state[time] = clock() - start
        if result.__class__ not in FROZEN:
            result = freeze(result) if result is not None else nothing_returned(name, what)
        state[slot] = result

    return operation


def _call_of_any(item: Item, node: Node, call: Call, time: int, blocks: list[Block]) -> Operation:
    """Any number of ports, optional ones, lists, sinks, and lazy inputs settled in turn."""
    slot, name, what = item.slot, item.name, step_label(node)
    ports = list(zip(item.inputs, blocks, strict=True))
    sink = node.is_sink

    def operation(state: State) -> None:
        arguments: dict[str, Any] = {}
        lacking: Any = None
        for port, block in ports:
            for lazy, settle in block:
                if state[lazy] is None:
                    settle(state)
            value = _collected(state, port, name) if port.collects else state[port.slots[0]]
            if value.__class__ in NO_VALUE:
                if value.__class__ is Failed:
                    # It stops its dependants only: what else is asked for still runs (and keeps
                    # its state in step), whether it stands before this block or in it.
                    lacking = lacking or value
                elif port.required:
                    lacking = lacking or value
                    break
                value = port.default
            arguments[port.name] = value
        if lacking is not None:
            state[slot] = lacking
            return
        start = clock()
        try:
            result = call(**arguments)
        except Exception as error:
            state[time] = clock() - start
            state[slot] = failure(name, error, tuple(arguments.values()), what)
            return
        state[time] = clock() - start
        if result.__class__ not in FROZEN and result.__class__ not in NO_VALUE:
            result = freeze(result) if result is not None else None
            if result is None:
                result = DONE if sink else nothing_returned(name, what)
        state[slot] = result

    return operation


def _collected(state: State, port: Input, name: str) -> Any:
    """Return the items of a list port without those skipped; a failed one fails the list."""
    values = [state[s] for s in port.slots]
    for value in values:
        if value.__class__ is Failed:
            return value
    kept = tuple([v for v in values if v.__class__ is not Skipped])
    return kept or Skipped(values[0].origin, f"every item of {port.name!r} was skipped")


def failure(name: str, error: Exception, values: tuple[Any, ...], what: str) -> Failed:
    """Return the outcome of a failed node; the traceback is dropped, its place kept."""
    where = raised_at(error)
    return Failed(name, error.with_traceback(None), where, describe_inputs(values), what)


def nothing_returned(name: str, what: str) -> Failed:
    """Return the outcome of a step that returned None though it promises a value."""
    return Failed(name, TypeError("the step returned None though it promises a value"), step=what)


def step_label(node: Node) -> str:
    """Return how errors name a node's step: its name and the module it comes from."""
    if node.signature is None:
        return node.what
    return f"step {node.signature.name} of {node.signature.target.__module__}"
