"""The operations of nodes that call a step: what it takes is read, what it gives is written."""

from __future__ import annotations

from collections.abc import Callable
from time import perf_counter_ns as clock
from typing import Any

from tactile_graph.engine.operations.freeze import FROZEN, freeze
from tactile_graph.engine.outcomes.outcome import (
    DONE,
    NO_VALUE,
    Failed,
    Skipped,
    nothing_returned,
    raised,
)
from tactile_graph.engine.plan import Input, Item
from tactile_graph.pipeline.graph import Node

State = list[Any]
Operation = Callable[[State], Any]
Block = tuple[Operation, ...]
"""What runs only when an item needs it."""
Call = Callable[..., Any]


def step_operation(item: Item, node: Node, call: Call, time: int, blocks: list[Block]) -> Operation:
    """Return the operation that reads a node's ports, calls its step, and writes what it gives.

    Parameters
    ----------
    item : Item
    node : Node
    call : callable
        The step, of its ports.
    time : int
        Where in the list the time of the call goes.
    blocks : list of Block
        For each input what must run before it is read.
    """
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
        for settle in block:
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
            state[slot] = raised(name, error, (value,), what)
            return
        state[time] = clock() - start
        if result.__class__ not in FROZEN:
            result = settled(result, name, what)
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
            state[slot] = raised(name, error, (first, second), what)
            return
        state[time] = clock() - start
        if result.__class__ not in FROZEN:
            result = settled(result, name, what)
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
            for settle in block:
                settle(state)
            value = _collected(state, port, name) if port.collects else state[port.slots[0]]
            if value.__class__ in NO_VALUE:
                if value.__class__ is Failed:
                    # It stops its dependants only: what else is asked for still runs (and keeps
                    # its state in step), whether it stands before this block or in it.
                    lacking = lacking or value
                elif port.required:
                    lacking = lacking or value
                    if not value.unforeseen:  # type: ignore[attr-defined]
                        break
                if not port.iterates:  # else each item takes it
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
            state[slot] = raised(name, error, tuple(arguments.values()), what)
            return
        state[time] = clock() - start
        if result.__class__ not in FROZEN and result.__class__ not in NO_VALUE:
            result = DONE if result is None and sink else settled(result, name, what)
        state[slot] = result

    return operation


def settled(value: Any, name: str, what: str) -> Any:
    """Return what a step returned as its node's outcome."""
    return nothing_returned(name, what) if value is None else frozen(value, name, what)


def frozen(value: Any, name: str, what: str = "") -> Any:
    """Return a value frozen; a failure of the node where that cannot be."""
    try:
        return freeze(value)
    except Exception as error:  # no line of a plugin's is to blame: what it returned is
        return Failed(name, error.with_traceback(None), step=what)


def _collected(state: State, port: Input, name: str) -> Any:
    """Return the items of a list port without those skipped; a failed one fails the list."""
    values = [state[s] for s in port.slots]
    for value in values:
        if value.__class__ is Failed:
            return value
    kept = tuple([v for v in values if v.__class__ is not Skipped])
    if kept:
        return kept
    first, reason = values[0], f"every item of {port.name!r} was skipped"
    unforeseen = first.unforeseen and all(v.unforeseen for v in values)
    return Skipped(first.origin, reason, unforeseen=unforeseen)


def step_label(node: Node) -> str:
    """Return how errors name a node's step: its name and the module it comes from."""
    if node.signature is None:
        return node.what
    return f"step {node.signature.name} of {node.signature.target.__module__}"
